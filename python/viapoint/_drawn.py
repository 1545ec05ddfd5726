"""What laws and motions have in common: they draw themselves."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from ._arguments import ArrayLike
from .errors import BadArgumentError

if TYPE_CHECKING:
    from ._law_plot import Course


class Drawn:
    """A course over time that can be drawn into a file."""

    def plot(
        self: Course,
        path: str | os.PathLike[str],
        *,
        title: str = "",
        unit: str = "rad",
        names: Sequence[str] | None = None,
        points: tuple[ArrayLike, ArrayLike] | None = None,
        limits: Mapping[str, float] | None = None,
    ) -> None:
        """Draw position, velocity, acceleration and jerk over time, with their exact extremes.

        Parameters
        ----------
        path : str or path-like
            The picture: .png, .svg or .pdf.
        title : str
            Above it.
        unit : str
            Of the positions, for the labels.
        names : sequence of str, optional
            One an axis or joint, for the legend; by default their numbers.
        points : (times (k,), positions (k,) or (k, n)), optional
            Marked in the position's panel: via points or control points.
        limits : mapping, optional
            Of ``"velocity"``, ``"acceleration"`` or ``"jerk"``, drawn both ways.

        Raises
        ------
        BadArgumentError
            Nothing moves, another ending, sizes that do not fit, an unknown limit.
        FileError
            The file cannot be written.
        """
        from ._law_plot import Marks, save_law_plot

        if not self.duration > 0.0:
            raise BadArgumentError("nothing moves: there is nothing to draw.")
        save_law_plot(self, path, title, Marks(unit, names, points, limits or {}))
