"""Figures written into the documents they belong to.

A document says where a table of ``tools/bench`` goes with a line ``<!-- bench: NAME -->`` and where
it ends with ``<!-- /bench -->``; what is between is written by the run, so that no figure is copied
by hand. The name is that of a table, or ``machine`` for what it was measured on.
"""

import re
from pathlib import Path

from benches.machine import ROOT
from benches.tables import Row, markdown

DOCUMENTS = (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")))
RESULTS = ROOT / "docs/results/bench.json"
"""Every figure of that run."""

BLOCK = re.compile(r"(<!-- bench: ([^>]+?) -->\n).*?(<!-- /bench -->)", re.DOTALL)


def sentence(about: dict[str, str]) -> str:
    """Say in a line what was measured on."""
    return "Measured on: " + "; ".join(f"{key} {value}" for key, value in about.items()) + "."


def blocks(about: dict[str, str], figures: list[Row]) -> dict[str, str]:
    """Return what goes into the block of each name."""
    texts = {"machine": sentence(about)}
    for name in dict.fromkeys(str(row["bench"]) for row in figures):
        texts[name] = markdown([row for row in figures if row["bench"] == name])
    return texts


def fill(text: str, texts: dict[str, str]) -> str:
    """Put texts into a document's blocks; a block of another name stays as it is."""

    def filled(found: re.Match[str]) -> str:
        begin, name, end = found.groups()
        return f"{begin}\n{texts[name]}\n\n{end}" if name in texts else found[0]

    return BLOCK.sub(filled, text)


def write(
    about: dict[str, str], figures: list[Row], documents: tuple[Path, ...] = DOCUMENTS
) -> list[Path]:
    """Write the figures into the documents that ask for them.

    Returns
    -------
    list of Path
        The documents that changed.
    """
    texts = blocks(about, figures)
    changed = []
    for document in documents:
        before = document.read_text(encoding="utf-8")
        after = fill(before, texts)
        if after != before:
            document.write_text(after, encoding="utf-8")
            changed.append(document)
    return changed
