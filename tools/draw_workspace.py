"""Draw docs/images/workspace.png: a SCARA from above and a PUMA 560 from the side."""

from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Circle

import viapoint as vp

PICTURE = Path(__file__).parents[1] / "docs" / "images" / "workspace.png"


def main() -> None:
    """Sample both arms and colour each point by the manipulability there."""
    figure, (above, side) = plt.subplots(
        1, 2, figsize=(9.6, 4.6), width_ratios=(1.75, 1.0), layout="constrained"
    )
    figure.suptitle("Where the tool gets, and how well", fontweight="bold")
    scara = vp.load_robot("scara")
    points, joints = scara.workspace(8000)
    measure = [scara.manipulability(q) for q in joints]
    drawn = above.scatter(points[:, 0], points[:, 1], c=measure, s=2)
    for radius in scara.reach([1.0, 0.0, 0.0], start=[0.0, 0.0, 0.25]).ravel():
        above.add_patch(Circle((0, 0), radius, fill=False, color="black", linewidth=0.8))
    above.set(title="SCARA from above", xlabel="x [m]", ylabel="y [m]", aspect="equal")
    figure.colorbar(drawn, ax=above, label="manipulability √det(JJᵀ)")

    puma = vp.load_robot("puma560")
    points, joints = puma.workspace(8000)
    measure = [puma.manipulability(q) for q in joints]
    drawn = side.scatter(np.hypot(points[:, 0], points[:, 1]), points[:, 2], c=measure, s=2)
    side.set(title="PUMA 560 from the side", xlabel="from axis 1 [m]", ylabel="z [m]")
    side.set_aspect("equal")
    figure.colorbar(drawn, ax=side, label="manipulability √det(JJᵀ)")
    figure.savefig(PICTURE, dpi=100)


if __name__ == "__main__":
    main()
