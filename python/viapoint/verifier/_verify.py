"""All checks of one motion file, one after the other."""

from __future__ import annotations

from pathlib import Path

from ._claim_checks import check_claims
from ._deviation_checks import check_deviation
from ._findings import Verdict
from ._joint_checks import check_joints
from ._merged_checks import check_merged
from ._motion_file import read
from ._speed_checks import check_tool_rates, scales_of
from ._structure_checks import check_structure
from ._zone_checks import check_zones


def verify(path: str | Path) -> Verdict:
    """Prove that a motion is what its file says, from the file alone.

    Parameters
    ----------
    path : str or path
        A motion file.

    Returns
    -------
    Verdict
        ``holds``, ``findings`` and ``proofs``.

    Raises
    ------
    MotionFileError
        The file is damaged or says what this does not know.
    OSError
        It cannot be read.
    """
    return verify_bytes(Path(path).read_bytes())


def verify_bytes(data: bytes) -> Verdict:
    """Verify the content of a motion file, as `verify` does."""
    motion = read(data)
    verdict = Verdict(motion.name, motion.robot, len(motion.durations), float(motion.starts[-1]))
    if not check_structure(motion, verdict):
        return verdict
    check_joints(motion, scales_of(motion), verdict)
    check_deviation(motion, verdict)
    check_zones(motion, verdict)
    check_merged(motion, verdict)
    check_tool_rates(motion, verdict)
    check_claims(motion, verdict)
    return verdict
