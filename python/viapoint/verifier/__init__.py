"""Verifies motion files, and shares nothing with what plans motions but the format of the file.

Only numpy and Python's own library are used, so that the folder also works alone:
``python -m verifier move.json``.
"""

from ._file_parts import TOOL_RATES
from ._findings import Finding, Proof, Verdict
from ._motion_file import FORMAT, VERSION, MotionFile, read
from ._samples import deviations
from ._speed_checks import scales_of
from ._strict_json import MotionFileError, seal
from ._verify import verify, verify_bytes

__all__ = [
    "FORMAT",
    "TOOL_RATES",
    "VERSION",
    "Finding",
    "MotionFile",
    "MotionFileError",
    "Proof",
    "Verdict",
    "deviations",
    "read",
    "scales_of",
    "seal",
    "verify",
    "verify_bytes",
]
