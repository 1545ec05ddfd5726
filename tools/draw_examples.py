"""Draw docs/images/hand_guided.png and mujoco_plant.png from the examples of these names."""

import runpy
from pathlib import Path
from typing import Any

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

ROOT = Path(__file__).parents[1]
LINE, OTHER, LIMIT, GREY = "#1f5fa8", "#2e8b57", "#c0392b", "#8a8f98"


def run_example(name: str) -> dict[str, Any]:
    """Run an example and return its variables."""
    return runpy.run_path(str(ROOT / "python" / "examples" / f"{name}.py"))


def save(figure: Figure, title: str, name: str) -> None:
    """Write a picture beside the others."""
    figure.suptitle(title, fontweight="bold")
    for axes in figure.axes:
        axes.grid(visible=True, alpha=0.3)
    figure.savefig(ROOT / "docs" / "images" / f"{name}.png", dpi=110)


def draw_hand_guided() -> None:
    """Draw the samples, the path through them, what lies between, and its tempo."""
    made = run_example("hand_guided")
    robot, recording, wipe = made["robot"], made["recording"], made["wipe"]
    seen = 1e3 * robot.fk(recording.q)[:, :3, 3]
    path = 1e3 * robot.fk(wipe.path(4000))[:, :3, 3]
    figure, (whole, near, tempo) = plt.subplots(1, 3, figsize=(13, 4.4), layout="constrained")
    for axes in (whole, near):
        axes.plot(seen[:, 0], seen[:, 1], ".", color=LIMIT, markersize=3, label="samples")
        axes.plot(path[:, 0], path[:, 1], color=LINE, label="path")
        axes.set(xlabel="x [mm]", ylabel="y [mm]")
    whole.set(title=f"{len(recording)} samples, every one within {1e3 * wipe.deviation:.2f} mm")
    whole.set_aspect("equal", "datalim")
    whole.legend(loc="center")
    middle = path[len(path) // 5]
    near.set(
        title="the same, near",
        xlim=(middle[0] - 1.5, middle[0] + 1.5),
        ylim=(middle[1] - 1.2, middle[1] + 1.2),
    )
    whole.plot(*middle[:2], "s", color="black", fillstyle="none", markersize=8)
    speed = np.linalg.norm(np.gradient(seen, axis=0), axis=1) / np.gradient(recording.t) / 1e3
    smooth = np.convolve(speed, np.ones(25) / 25, mode="same")
    tempo.plot(recording.t, smooth, color=LIMIT, linewidth=1, label="the hand, mean of 50 ms")
    for factor, colour in ((1.0, LINE), (2.0, OTHER)):
        samples = wipe.program(speed=factor).plan().sample(0.002)
        speed = np.linalg.norm(samples.twist[:, :3], axis=1)
        tempo.plot(samples.t, speed, color=colour, label=f"played, speed={factor:g}")
    tempo.set(title="speed of the tool", xlabel="time [s]", ylabel="speed [m/s]")
    tempo.set_ylim(top=0.9)
    tempo.legend(loc="upper right")
    save(figure, "ur5e guided by hand, fitted within 0.5 mm, and played", "hand_guided")


def draw_mujoco_plant() -> None:
    """Draw how far an arm with mass is behind its setpoints, by its payload."""
    made = run_example("mujoco_plant")
    robot, told = made["robot"], made["told"]
    figure, (speed, behind) = plt.subplots(
        2, 1, figsize=(8, 5.6), sharex=True, layout="constrained"
    )
    t = told.samples.t
    speed.plot(t, np.linalg.norm(told.samples.twist[:, :3], axis=1), color=GREY)
    speed.set(ylabel="speed told [m/s]")
    for log, payload, colour in zip(
        made["logs"], ("0.5 kg", "2 kg", "5 kg"), (LINE, OTHER, LIMIT), strict=True
    ):
        off = robot.fk(log.measured)[:, :3, 3] - told.samples.pose[:, :3, 3]
        behind.plot(t, 1e3 * np.linalg.norm(off, axis=1), color=colour, label=f"payload {payload}")
    behind.set(xlabel="time [s]", ylabel="tool behind its setpoint [mm]")
    behind.legend()
    save(figure, "ur5e in MuJoCo: following error under servos of 100 rad/s", "mujoco_plant")


if __name__ == "__main__":
    draw_hand_guided()
    draw_mujoco_plant()
