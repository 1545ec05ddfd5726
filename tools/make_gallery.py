"""Run the code on docs/gallery.md, draw its pictures and write what it found below each block.

``--check`` draws nothing and fails when the page is not what its code makes.
"""

import argparse
import contextlib
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from unittest import mock

import viapoint as vp

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "gallery.md"
PICTURES = ROOT / "docs" / "images" / "gallery"

# A block of code, and what an earlier run has put below it.
BLOCK = re.compile(
    r"```python\n(?P<code>.*?)```\n(?:\n<!-- made -->\n.*?<!-- /made -->\n)?", re.DOTALL
)
ROWS = (("position", ""), ("velocity", "/s"), ("acceleration", "/s²"), ("jerk", "/s³"))


def made_page(text: str) -> str:
    """Return the page with every block of code run, in the current folder, and followed by that."""
    return BLOCK.sub(lambda block: _with_findings(block["code"]), text)


@contextlib.contextmanager
def without_files() -> Iterator[None]:
    """Draw, but write no picture: that takes nine tenths of the time."""
    with mock.patch("viapoint._law_plot.save_figure"):
        yield


def _with_findings(code: str) -> str:
    drawn: list[dict[str, Any]] = []

    def noted(kind: Any) -> Any:  # noqa: ANN401  # a context manager of mock's own
        save = kind.plot

        def plot(law: object, path: str, **options: object) -> None:
            save(law, path, **options)
            drawn.append({"law": law, "path": path, **options})

        return mock.patch.object(kind, "plot", plot)

    with noted(vp.profile.Law), noted(vp.profile.StateMotion):
        exec(compile(code, str(PAGE), "exec"), {"__name__": "gallery"})
    findings = "".join(_findings(picture) for picture in drawn)
    return f"```python\n{code}```\n" + (
        f"\n<!-- made -->\n{findings}<!-- /made -->\n" if findings else ""
    )


def _findings(picture: dict[str, Any]) -> str:
    law, unit = picture["law"], picture.get("unit", "rad")
    axes = law.shape[0] if law.shape else 1
    names = picture.get("names") or [f"axis {i}" for i in range(axes)]
    lines = [f"![{picture['title']}](images/gallery/{picture['path']})", ""]
    lines += ["| | least | at | greatest | at |", "|---|---|---|---|---|"]
    for axis in range(axes):
        for order, (quantity, per) in enumerate(ROWS):
            found = law.extremes(order)
            low, low_time, high, high_time = (
                float(value[axis]) if law.shape else float(value) for value in found
            )
            of_axis = f"{names[axis]}, {quantity}" if axes > 1 else quantity
            size = max(abs(low), abs(high))
            cells = [
                f"{of_axis} [{unit}{per}]",
                _written(low, size),
                f"{_written(low_time, law.end)} s",
                _written(high, size),
                f"{_written(high_time, law.end)} s",
            ]
            lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def _written(value: float, size: float) -> str:
    """Five digits; nothing of what is rounding beside `size`."""
    return f"{0.0 if abs(value) <= 1e-9 * size else value:.5g}"


def main(arguments: list[str]) -> int:
    """Write the page and its pictures, or compare the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="compare the text, draw nothing")
    options = parser.parse_args(arguments)
    text = PAGE.read_text(encoding="utf-8")
    if options.check:
        with without_files():
            made = made_page(text)
        if made != text:
            print("docs/gallery.md is not what its code makes: run ./tools/gallery")
        return int(made != text)
    PICTURES.mkdir(parents=True, exist_ok=True)
    with contextlib.chdir(PICTURES):
        PAGE.write_text(made_page(text), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
