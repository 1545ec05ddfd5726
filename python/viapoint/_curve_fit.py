"""Any curve of the tool as a spline that stays within a tolerance of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from . import _core
from ._arguments import ArrayLike, Vector, number, numbers_of, pose, vector
from .errors import BadArgumentError


@dataclass(frozen=True, eq=False)
class CurveFit:
    """A C² spline near a curve: made by `fit_curve`, run by `Program.spline`.

    Attributes
    ----------
    poses : ndarray, (k, 4, 4)
        Poses on the curve that the spline passes [m].
    at : ndarray, (k,)
        The curve's parameter at each.
    oriented : bool
        False where the curve gave positions alone; the rotations in `poses` then mean nothing.
    deviation, angle_deviation : float
        Largest distance [m] and angle [rad] between spline and curve where they were compared.
    looked_at : int
        At how many places that was; of a function nothing is known between them.
    """

    poses: Vector
    at: Vector
    oriented: bool
    deviation: float
    angle_deviation: float
    looked_at: int


def fit_curve(
    curve: Callable[[float], ArrayLike] | ArrayLike,
    *,
    tolerance: float,
    angle_tolerance: float = 1e-3,
    domain: tuple[float, float] = (0.0, 1.0),
    at: ArrayLike | None = None,
) -> CurveFit:
    """Fit a C² spline to a curve of the tool within a tolerance.

    Poses on the curve are added until the natural cubic spline through their positions, and the
    orientation spline through their rotations, stay within the tolerances wherever they are
    compared, at equal parameter: at eight places between two poses of a function, at every sample
    of an array.

    Parameters
    ----------
    curve : callable, or array_like, (k, 4, 4) or (k, 3)
        A function of one parameter that returns a pose (4, 4) or a position (3,) [m]; or samples.
    tolerance, angle_tolerance : float
        Largest distance [m] and angle [rad].
    domain : (float, float)
        Where a function's parameter begins and ends.
    at : array_like, (k,), optional
        Parameter of each sample, rising. Default: the distance travelled.

    Returns
    -------
    CurveFit
        The spline, and how far from the curve it was found to be.

    Raises
    ------
    DegenerateCurveError
        No spline comes within the tolerances, because the curve jumps; with the share of the
        parameter.
    BadArgumentError, NotARotationError
        By the argument's name, or at which parameter the function returned what.
    """
    near = number(tolerance, "tolerance", "m", above=0.0)
    turned = number(angle_tolerance, "angle_tolerance", "rad", above=0.0)
    if callable(curve):
        if at is not None:
            raise BadArgumentError("at belongs to samples; a function has its domain.")
        return _of_function(curve, vector(domain, "domain", 2, "begin and end"), near, turned)
    samples = numbers_of(curve, "curve")
    oriented = samples.ndim == 3
    if samples.shape[1:] not in ((4, 4), (3,)):
        raise BadArgumentError(
            f"curve has the shape {samples.shape}; samples are (k, 4, 4) or (k, 3)."
        )
    positions = samples[:, :3, 3] if oriented else samples
    matrices = (
        [pose(sample, f"curve[{i}]")[0] for i, sample in enumerate(samples)]
        if oriented
        else list(_poses_at(samples))
    )
    if at is None:
        steps = np.linalg.norm(np.diff(positions, axis=0), axis=1)
        places = np.concatenate([[0.0], steps.cumsum()])
    else:
        places = vector(at, "at", len(samples), "one place a sample")
    fit = _core.fit_samples(matrices, list(places), tolerance=near, angle_tolerance=turned)
    return _fit_of(fit, oriented)


def _of_function(
    curve: Callable[[float], ArrayLike], domain: Vector, tolerance: float, angle_tolerance: float
) -> CurveFit:
    if not domain[0] < domain[1]:
        raise BadArgumentError(f"domain is {tuple(domain)}; its end must be above its begin.")
    oriented = numbers_of(curve(float(domain[0])), "the curve's value").shape != (3,)

    def gamma(parameter: float) -> Vector:
        name = f"the curve at {parameter:g}"
        value = curve(parameter)
        if oriented:
            return pose(value, name)[0]
        placed: Vector = _poses_at(vector(value, name, 3, "x, y, z")[None])[0]
        return placed

    fit = _core.fit_function(
        gamma,
        from_=float(domain[0]),
        to=float(domain[1]),
        tolerance=tolerance,
        angle_tolerance=angle_tolerance,
    )
    return _fit_of(fit, oriented)


def _poses_at(positions: Vector) -> Vector:
    poses = np.tile(np.eye(4), (len(positions), 1, 1))
    poses[:, :3, 3] = positions
    return poses


def _fit_of(fit: _core.PoseFit, oriented: bool) -> CurveFit:
    return CurveFit(
        poses=fit.poses,
        at=np.array(fit.at),
        oriented=oriented,
        deviation=fit.deviation,
        angle_deviation=fit.angle_deviation,
        looked_at=fit.looked_at,
    )
