"""Pictures of a law or a motion: position and derivatives over time, with their exact extremes."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ._arguments import ArrayLike, Vector, file_name, number, numbers_of
from ._plots import ENDINGS, LIMIT, LINE, SWEEP, save_figure
from .errors import BadArgumentError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._law import Extremes, Part

QUANTITIES = ("position", "velocity", "acceleration", "jerk")
COLOURS = (LINE, "#2e8b57", "#d07a00", "#7d4fa3", "#1aa0a0", "#b05a7a")
SAMPLES_A_PART = 200
JUMP = 1e-6
"""Share of the largest acceleration beyond which a step of it is an impulse of jerk."""


class Course(Protocol):
    """What a picture is drawn of: a law, or a motion from state to state."""

    @property
    def shape(self) -> tuple[int, ...]:
        """``()`` or ``(n,)``."""

    @property
    def start(self) -> float:
        """[s]."""

    @property
    def end(self) -> float:
        """[s]."""

    @property
    def duration(self) -> float:
        """[s], above 0."""

    def parts(self, axis: int = 0) -> list[Part]:
        """Return the polynomials of one axis, in order of time; at least one."""

    def extremes(self, derivative: int = 0) -> Extremes:
        """Exact extremes of each axis."""


@dataclass(frozen=True)
class Marks:
    """What a picture shows beside the law itself."""

    unit: str = "rad"
    names: Sequence[str] | None = None
    points: tuple[ArrayLike, ArrayLike] | None = None
    limits: Mapping[str, float] = field(default_factory=dict)


def save_law_plot(law: Course, path: str | os.PathLike[str], title: str, marks: Marks) -> None:
    """Draw a law or a motion into a file whose ending names the format.

    Raises
    ------
    BadArgumentError
        Another ending, names or points that do not fit, an unknown limit.
    FileError
        The file cannot be written.
    """
    if Path(file_name(path)).suffix not in ENDINGS:
        raise BadArgumentError(
            f'path is "{file_name(path)}"; a picture ends in {", ".join(ENDINGS)}.'
        )
    save_figure(draw_law(law, title, marks), path)


def draw_law(law: Course, title: str = "", marks: Marks | None = None) -> Figure:
    """Draw one panel each for position, velocity, acceleration and jerk."""
    shown = marks or Marks()
    names = _names(law, shown)
    figure = Figure(figsize=(7.6, 8.2), layout="constrained")
    if title:
        figure.suptitle(title, fontweight="bold")
    panels = figure.subplots(4, 1, sharex=True)
    impulses = False
    for axis, name in enumerate(names):
        colour = COLOURS[axis % len(COLOURS)]
        for derivative, panel in enumerate(panels):
            _draw_curve(panel, law, axis, derivative, colour, name)
            _draw_extremes(panel, law, axis, derivative, colour)
        impulses |= _draw_impulses(panels[3], law, axis, colour)
    for derivative, panel in enumerate(panels):
        _draw_limit(panel, QUANTITIES[derivative], shown.limits)
        per = ("", "/s", "/s²", "/s³")[derivative]
        panel.set_ylabel(f"{QUANTITIES[derivative]} [{shown.unit}{per}]")
        panel.margins(y=0.16)
        panel.grid(alpha=0.25, lw=0.5)
        for border in sorted({part.start for a in range(len(names)) for part in law.parts(a)[1:]}):
            panel.axvline(border, color=SWEEP, lw=0.8, ls=":", zorder=1)
    _draw_points(panels[0], law, shown)
    if not any(np.any(bound) for bound in (law.extremes(3).low, law.extremes(3).high)):
        panels[3].set_yticks([0.0])  # the scale of nothing means nothing
    panels[0].set_xlim(law.start, law.end)
    panels[3].set_xlabel("time [s]")
    figure.align_ylabels()
    _draw_legend(figure, law, names, shown, impulses=impulses)
    return figure


def _names(law: Course, marks: Marks) -> list[str]:
    count = law.shape[0] if law.shape else 1
    if marks.names is None:
        return [f"axis {i}" for i in range(count)] if law.shape else ["law"]
    if isinstance(marks.names, str) or len(marks.names) != count:
        raise BadArgumentError(f"names must hold one name an axis, {count} in all.")
    return [str(name) for name in marks.names]


def _of_axis(values: Vector, law: Course, axis: int) -> Vector:
    """Return the column of one axis of values (k,) or (k, n)."""
    return values[:, axis] if law.shape else values


def _draw_curve(
    panel: Axes, law: Course, axis: int, derivative: int, colour: str, name: str
) -> None:
    """Draw each part for itself, so that a step is drawn as one, and join them."""
    times, values = [], []
    for part in law.parts(axis):
        # A part's own polynomial up to its end, where the law has already the next part's value.
        curve = np.polynomial.Polynomial(part.coefficients).deriv(derivative)
        tau = np.linspace(0.0, part.end - part.start, SAMPLES_A_PART)
        times.append(part.start + tau)
        values.append(curve(tau))
    panel.plot(np.concatenate(times), np.concatenate(values), color=colour, lw=1.6, label=name)


def _draw_extremes(panel: Axes, law: Course, axis: int, derivative: int, colour: str) -> None:
    found = law.extremes(derivative)
    place = axis if law.shape else ()
    size = max(abs(float(found.low[place])), abs(float(found.high[place])))
    for time, value, above in (
        (found.high_time[place], found.high[place], True),
        (found.low_time[place], found.low[place], False),
    ):
        if abs(value) <= 1e-9 * size or size == 0.0:
            continue  # rest is no extreme worth a mark
        if not above and value == found.high[place]:
            continue  # constant: one mark will do
        panel.plot(time, value, "o", color=colour, ms=4.5, zorder=4, clip_on=False)
        share = (float(time) - law.start) / law.duration
        panel.annotate(
            f"{float(value):.4g}".replace("-", "\N{MINUS SIGN}"),
            (float(time), float(value)),
            xytext=(4 if share < 0.9 else -4, 3 if above else -3),
            textcoords="offset points",
            ha="left" if share < 0.9 else "right",
            va="bottom" if above else "top",
            fontsize=8,
            color=colour,
            bbox={"boxstyle": "round,pad=0.12", "fc": "white", "ec": "none", "alpha": 0.75},
        )


def _draw_impulses(panel: Axes, law: Course, axis: int, colour: str) -> bool:
    """Where acceleration steps, jerk is an impulse: an arrow of its sign. True if there is one."""
    drawn = False
    parts = law.parts(axis)
    found = law.extremes(2)
    place = axis if law.shape else ()
    size = max(abs(float(found.low[place])), abs(float(found.high[place])))
    for before, after in pairwise(parts):
        step = 2.0 * after.coefficients[2] - _acceleration_at_end(before)
        if abs(step) <= JUMP * size:
            continue
        panel.annotate(
            "",
            xy=(after.start, 0.92 if step > 0 else 0.08),
            xytext=(after.start, 0.0),
            xycoords=("data", "axes fraction"),
            textcoords="data",
            arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.4},
        )
        drawn = True
    return drawn


def _acceleration_at_end(part: Part) -> float:
    return float(np.polynomial.Polynomial(part.coefficients).deriv(2)(part.end - part.start))


def _draw_limit(panel: Axes, quantity: str, limits: Mapping[str, float]) -> None:
    unknown = set(limits) - set(QUANTITIES[1:])
    if unknown:
        raise BadArgumentError(
            f'limits has "{sorted(unknown)[0]}"; it may have "velocity", "acceleration", "jerk".'
        )
    if quantity in limits:
        limit = number(limits[quantity], f"limits[{quantity!r}]", above=0.0)
        for bound in (-limit, limit):
            panel.axhline(bound, color=LIMIT, lw=1.0, ls="--")


def _draw_points(panel: Axes, law: Course, marks: Marks) -> None:
    if marks.points is None:
        return
    times = numbers_of(marks.points[0], "times of points")
    values = numbers_of(marks.points[1], "points")
    if times.ndim != 1 or values.shape != times.shape + law.shape:
        raise BadArgumentError(
            f"points are {times.shape} times and positions of the shape {values.shape}; they must "
            f"be (k,) and {('k', *law.shape)}."
        )
    for axis in range(law.shape[0] if law.shape else 1):
        panel.plot(
            times,
            _of_axis(values, law, axis),
            "--",
            marker="s",
            color=SWEEP,
            mfc="white",
            mec=COLOURS[axis % len(COLOURS)],
            lw=0.8,
            ms=5.0,
            zorder=2,
        )


def _draw_legend(
    figure: Figure, law: Course, names: list[str], marks: Marks, *, impulses: bool
) -> None:
    entries = [
        (Line2D([], [], color=COLOURS[i % len(COLOURS)], lw=1.6), name)
        for i, name in enumerate(names)
    ]
    entries.append((Line2D([], [], color="black", marker="o", ls="", ms=4.5), "exact extreme"))
    if marks.points is not None:
        square = Line2D([], [], color=SWEEP, marker="s", mfc="white", mec="black", ls="--", ms=5.0)
        entries.append((square, "given point"))
    if marks.limits:
        entries.append((Line2D([], [], color=LIMIT, ls="--", lw=1.0), "limit"))
    if any(len(law.parts(axis)) > 1 for axis in range(len(names))):
        entries.append((Line2D([], [], color=SWEEP, ls=":", lw=0.8), "parts meet"))
    if impulses:
        entries.append((Line2D([], [], color="black", marker="^", ls="", ms=5), "impulse of jerk"))
    figure.legend(
        [handle for handle, _ in entries],
        [name for _, name in entries],
        loc="outside lower center",
        ncols=len(entries) if len(entries) <= 6 else (len(entries) + 1) // 2,
        frameon=False,
        fontsize=9,
    )
