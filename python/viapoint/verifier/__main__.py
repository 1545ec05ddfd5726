"""``python -m verifier FILE…``: verifies motion files with nothing but Python and numpy."""

import sys

from ._strict_json import MotionFileError
from ._verify import verify


def main(paths: list[str]) -> int:
    """Verify each file; 1 when something is wrong with one of them."""
    wrong = not paths
    for path in paths:
        try:
            verdict = verify(path)
        except (MotionFileError, OSError) as error:
            print(f"{path}: {error}")
            wrong = True
            continue
        print(f"{path}: {'holds' if verdict.holds else 'DOES NOT HOLD'}")
        for proof in verdict.proofs:
            mark = "ok " if proof.holds else "NO "
            print(f"  {mark} {proof.quantity}: {proof.worst} (allowed: {proof.allowed})")
        for finding in verdict.findings:
            print(f"  wrong: {finding}")
        wrong |= not verdict.holds
    return int(wrong)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
