"""Where in the user's script a call was made."""

from __future__ import annotations

import sys
from pathlib import Path

_PACKAGE = Path(__file__).parent


def caller() -> tuple[str, int]:
    """Return file and line (from 1) of the nearest frame outside this package."""
    frame = sys._getframe(1)
    while frame.f_back is not None and _is_ours(frame.f_code.co_filename):
        frame = frame.f_back
    return frame.f_code.co_filename, frame.f_lineno


def _is_ours(file: str) -> bool:
    return Path(file).is_relative_to(_PACKAGE)
