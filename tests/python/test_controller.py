"""An exported program in viapoint-controller, with no Python, gives the same setpoints."""

import subprocess

import numpy as np
import pytest

import viapoint as vp
from viapoint import mm


def program_of(kind, puma, abc):
    program = vp.Program(puma, start=abc["A"], name=kind)
    if kind == "joints":
        return program.movej(abc["B"], zone=50 * mm).set_do(3, True).movej(abc["C"]).wait(0.05)
    if kind == "frames and tools":
        shift = np.eye(4)
        shift[:3, 3] = [0.3, -0.2, 0.1]
        table, tool = vp.frames.Frame(shift, "table"), vp.frames.Tool(shift, "gripper")
        program.set_frame(table).set_tool(tool)
        program.movej(table.from_base(puma.with_tool(tool).fk(abc["B"])), zone=50 * mm)
        return program.set_tool().movej(table.from_base(puma.fk(abc["C"])))
    program.movel(puma.fk(abc["B"]), orientation="wrist", zone=50 * mm)
    return program.movel(puma.fk(abc["C"]), orientation="wrist", scale=0.7)


@pytest.mark.parametrize("kind", ["joints", "lines", "frames and tools"])
def test_the_setpoints_are_the_same_to_the_last_bit(controller, puma, abc, kind, tmp_path):
    program = program_of(kind, puma, abc)
    path, log = tmp_path / "p.json", tmp_path / "log.csv"
    program.save(path)
    done = subprocess.run(
        [controller, "--robot", "puma560", "--program", str(path), "--log", str(log)],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    with vp.connect("sim://puma560", start=abc["A"]) as arm:
        here = arm.run(program).log
    here.save(tmp_path / "here.csv")
    columns = [f"{name}{i}" for name in ("q", "qd", "qdd", "qddd") for i in range(1, 7)]
    columns += ["cycle", "nominal_time", "rate", "move", "outputs"]
    there, ours = (_columns(file, columns) for file in (log, tmp_path / "here.csv"))
    assert len(there["cycle"]) == len(ours["cycle"])
    for name in columns:
        assert there[name] == ours[name], name  # as text: to the last bit
    np.testing.assert_array_equal([float(x) for x in there["q1"]], here.q[:, 0])


def _columns(path, names):
    header, *rows = [line.split(",") for line in path.read_text(encoding="ascii").splitlines()]
    return {name: [row[header.index(name)] for row in rows] for name in names}
