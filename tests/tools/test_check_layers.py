"""The layering check finds what is planted, and nothing where nothing is."""

from pathlib import Path

import check_layers

ROOT = Path(__file__).parents[2]


def problems_of(**files: str) -> list[str]:
    """Check files given as path → text."""
    return check_layers.check_includes({Path(path): text for path, text in files.items()})


def test_the_checkout_keeps_its_layers():
    assert check_layers.check(ROOT) == []


def test_a_folder_without_sources_is_an_error(tmp_path: Path):
    assert check_layers.check(tmp_path) == [f"{tmp_path}: no C++ sources found"]


def test_an_allowed_include_passes():
    assert problems_of(**{"cpp/src/path/a.cpp": '#include "viapoint/core/pose.hpp"\n'}) == []


def test_a_planted_breach_is_found_with_file_and_header():
    problems = problems_of(
        **{"cpp/include/viapoint/core/a.hpp": '#include "viapoint/path/joint_path.hpp"\n'}
    )
    assert problems == [
        "cpp/include/viapoint/core/a.hpp: core includes viapoint/path/joint_path.hpp of path; "
        "it may include nothing"
    ]


def test_a_private_header_of_another_module_is_a_breach():
    problems = problems_of(**{"cpp/src/drives/a.cpp": '#include "path/root_finder.hpp"\n'})
    assert len(problems) == 1
    assert "drives includes path/root_finder.hpp" in problems[0]


def test_an_include_in_a_comment_does_not_count():
    text = '// #include "viapoint/path/a.hpp"\n/*\n#include "viapoint/path/a.hpp"\n*/\n'
    assert problems_of(**{"cpp/src/core/a.cpp": text}) == []


def test_real_time_code_may_include_only_named_headers_of_planning_modules():
    path = "cpp/src/realtime/a.cpp"
    allowed = '#include "viapoint/trajectory/trajectory.hpp"\n'
    refused = '#include "viapoint/trajectory/time_parameterizer.hpp"\n'
    assert problems_of(**{path: allowed}) == []
    assert len(problems_of(**{path: refused})) == 1


def test_kdl_stays_in_one_file():
    text = "#include <kdl/chain.hpp>\n"
    assert problems_of(**{"cpp/src/kinematics/robot_model.cpp": text}) == []
    problems = problems_of(**{"cpp/src/kinematics/wrist.cpp": text, "cpp/bindings/a.cpp": text})
    assert len(problems) == 2


def test_a_planted_cycle_of_headers_is_found():
    problems = problems_of(
        **{
            "cpp/include/viapoint/core/a.hpp": '#include "viapoint/core/b.hpp"\n',
            "cpp/include/viapoint/core/b.hpp": '#include "viapoint/core/c.hpp"\n',
            "cpp/include/viapoint/core/c.hpp": '#include "viapoint/core/a.hpp"\n',
        }
    )
    assert problems == [
        "cycle of headers: viapoint/core/a.hpp -> viapoint/core/b.hpp -> viapoint/core/c.hpp -> "
        "viapoint/core/a.hpp"
    ]


def test_a_planted_cycle_of_modules_is_found():
    problems = problems_of(
        **{
            "cpp/src/path/a.cpp": '#include "viapoint/trajectory/trajectory.hpp"\n',
            "cpp/src/trajectory/b.cpp": '#include "viapoint/path/joint_path.hpp"\n',
        }
    )
    assert "cycle of modules: path -> trajectory -> path" in problems


def links(module: str, rest: str) -> list[str]:
    text = f"viapoint_module({module} {rest})\n"
    found = check_layers.check_links({Path(f"cpp/src/{module}/CMakeLists.txt"): text})
    return [problem for problem in found if not problem.startswith("no CMakeLists.txt")]


def test_links_that_mirror_the_table_pass():
    assert links("path", "DEPENDS core kinematics\n  profile PRIVATE yaml-cpp") == []


def test_a_link_too_many_and_a_missing_one_are_found():
    assert (
        "links ['core', 'kinematics', 'path', 'profile']"
        in links("path", "DEPENDS core kinematics profile path")[0]
    )
    assert len(links("path", "DEPENDS core")) == 1
    assert len(links("gripper", "DEPENDS core")) == 1
