"""A smooth curve near noisy samples: cubic B-splines as smooth as a tolerance allows.

The curve is the clamped uniform cubic B-spline that minimises the squares of the residuals and of
the third differences of its control points (Eilers & Marx 1996), with as few spans as come within
the tolerance, and then as much weight on smoothness as stays within it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from ._arguments import Vector

DEGREE = 3
STEP = 4.0
"""Distance of the points that tell how far along a sample is, in tolerances: above any noise."""
REVERSAL = np.cos(np.radians(120.0))
"""Where the way turns by more than this, it is cut, and the arm stops."""
MOST_SPANS = 600
GROWTH = 1.5
"""Of the number of spans, from one trial to the next."""
ROOM = 0.9
"""Share of the tolerance that the number of spans is chosen for; the rest is for smoothness."""
_LINE = 1e-10
"""Weight of second differences: enough to hold what few samples leave open."""
SMOOTHNESS = 10.0 ** np.arange(-8, 7)

Features = Callable[[Vector], Vector]
"""Of points (k, n): (k, f), in which distances count in tolerances."""
Shares = Callable[[Vector, Vector], Vector]
"""Of points (k, n) and samples (k, n): how far apart they are, as shares of the tolerance, (k,)."""


@dataclass(frozen=True)
class SmoothCurve:
    """A clamped uniform cubic B-spline over u in [0, 1], and where on it samples are.

    Attributes
    ----------
    control : ndarray, (m, n)
        Control points.
    at : ndarray, (k,)
        Place u of each sample.
    shares : ndarray, (k,)
        Distance of each sample from the curve at that place, in tolerances.
    """

    control: Vector
    at: Vector
    shares: Vector

    def points(self, u: Vector) -> Vector:
        """Points of the curve, (k, n)."""
        return b_spline(self.control, u)


def b_spline(control: Vector, u: Vector) -> Vector:
    """Points (k, n) of the clamped uniform cubic B-spline at u in [0, 1]."""
    first, weights = _basis(len(control) - DEGREE, u)
    points: Vector = np.einsum("kj,kjn->kn", weights, control[first[:, None] + np.arange(4)])
    return points


def _basis(spans: int, u: Vector) -> tuple[npt.NDArray[np.intp], Vector]:
    """First control point and weights (k, 4) at u, by Cox and de Boor's recurrence (1972)."""
    knots = np.concatenate([[0.0] * DEGREE, np.linspace(0.0, 1.0, spans + 1), [1.0] * DEGREE])
    span = np.clip((u * spans).astype(np.intp), 0, spans - 1)
    at = span + DEGREE
    weights = np.ones((len(u), 1))
    for degree in range(1, DEGREE + 1):
        wider = np.zeros((len(u), degree + 1))
        for j in range(degree):
            low, high = knots[at + 1 + j - degree], knots[at + 1 + j]
            part = weights[:, j] / (high - low)
            wider[:, j] += (high - u) * part
            wider[:, j + 1] += (u - low) * part
        weights = wider
    return span, weights


def smooth(
    samples: Vector, features: Features, shares: Shares, first: Vector | None = None
) -> SmoothCurve:
    """Find a curve within the tolerance of all samples, or as near as it gets.

    Parameters
    ----------
    samples : ndarray, (k, n)
        In the order in which they are passed.
    first : ndarray, (n,), optional
        Where the curve begins.
    """
    seen = features(samples)
    chosen = thinned(seen)
    at = _places(seen, chosen)
    most = int(np.clip(min(2 * len(chosen), len(samples) // 2), 1, MOST_SPANS))
    spans = 1
    best: SmoothCurve | None = None
    while True:
        curve = _fitted(samples, at, spans, SMOOTHNESS[0], first, features, seen, shares)
        if best is None or curve.shares.max() < best.shares.max():
            best = curve
        if curve.shares.max() <= ROOM or spans == most:
            break
        spans = min(int(np.ceil(GROWTH * spans)), most)
    if best.shares.max() > ROOM:
        return best
    for weight in SMOOTHNESS[1:]:
        smoother = _fitted(samples, best.at, spans, weight, first, features, seen, shares)
        if smoother.shares.max() > 1.0:
            break
        best = smoother
    return best


def thinned(seen: Vector) -> npt.NDArray[np.intp]:
    """Choose samples STEP or farther from the one chosen before; the last one closes the way."""
    chosen = [0]
    for i, place in enumerate(seen):
        off = place - seen[chosen[-1]]
        if off @ off >= STEP * STEP:
            chosen.append(i)
    if len(chosen) > 1:
        chosen[-1] = len(seen) - 1
    else:  # a way shorter than that is one chord
        chosen.append(len(seen) - 1)
    return np.array(chosen, dtype=np.intp)


def reversals(seen: Vector) -> list[int]:
    """Find the samples where the way goes back on itself: the farthest of those about a turn."""
    chosen = thinned(seen)
    chords = np.diff(seen[chosen], axis=0)
    chords /= np.maximum(np.linalg.norm(chords, axis=1), 1e-300)[:, None]
    turns = np.flatnonzero(np.sum(chords[1:] * chords[:-1], axis=1) < REVERSAL) + 1
    found: list[int] = []
    for k in turns:
        begin, end = chosen[k - 1], chosen[k + 1]
        farthest = int(begin + np.argmax(seen[begin:end] @ chords[k - 1]))
        if not found or farthest > found[-1]:
            found.append(farthest)
    return found


def _places(seen: Vector, chosen: npt.NDArray[np.intp]) -> Vector:
    """How far along the polygon of chosen samples each sample is, 0 to 1."""
    chords = np.diff(seen[chosen], axis=0)
    lengths = np.linalg.norm(chords, axis=1)
    starts = np.concatenate([[0.0], np.cumsum(lengths)])
    chord = np.clip(
        np.searchsorted(chosen, np.arange(len(seen)), side="right") - 1, 0, len(chords) - 1
    )
    along = np.sum((seen - seen[chosen[chord]]) * chords[chord], axis=1)
    along = np.clip(along / np.maximum(lengths[chord], 1e-300), 0.0, lengths[chord])
    places: Vector = (starts[chord] + along) / max(starts[-1], 1e-300)
    return places


def _fitted(
    samples: Vector,
    at: Vector,
    spans: int,
    smoothness: float,
    first: Vector | None,
    features: Features,
    seen: Vector,
    shares: Shares,
) -> SmoothCurve:
    """Fit, move every sample's place to the nearest, and fit again."""
    for _ in range(3):
        control = _control(samples, at, spans, smoothness, first)
        at = _nearer(control, at, features, seen)
    control = _control(samples, at, spans, smoothness, first)
    return SmoothCurve(control, at, shares(b_spline(control, at), samples))


def _control(
    samples: Vector, at: Vector, spans: int, smoothness: float, first: Vector | None
) -> Vector:
    """Solve the normal equations of the penalised least squares."""
    count = spans + DEGREE
    begin, weights = _basis(spans, at)
    touched = begin[:, None] + np.arange(4)
    pairs = (touched[:, :, None] * count + touched[:, None, :]).ravel()
    products = (weights[:, :, None] * weights[:, None, :]).ravel()
    squares = np.bincount(pairs, products, count * count).reshape(count, count)
    right = np.stack(
        [
            np.bincount(touched.ravel(), (weights * column[:, None]).ravel(), count)
            for column in samples.T
        ],
        axis=1,
    )
    per_sample = len(samples) / count
    matrix = squares + per_sample * (
        smoothness * _roughness(count, 3) + _LINE * _roughness(count, 2)
    )
    control = np.empty((count, samples.shape[1]))
    if first is None:
        control[:] = _solved(matrix, right.astype(np.float64))
    else:
        control[0] = first
        control[1:] = _solved(matrix[1:, 1:], right[1:] - np.outer(matrix[1:, 0], first))
    return control


def _solved(matrix: Vector, right: Vector) -> Vector:
    """Solve; of what the samples leave open take the shortest."""
    try:
        solution: Vector = np.asarray(np.linalg.solve(matrix, right), dtype=np.float64)
    except np.linalg.LinAlgError:
        solution = np.asarray(np.linalg.lstsq(matrix, right)[0], dtype=np.float64)
    return solution


@lru_cache(maxsize=8)
def _roughness(count: int, order: int) -> Vector:
    """Return the matrix of the sum of squared differences of an order."""
    differences = np.diff(np.eye(count), n=order, axis=0)
    matrix: Vector = differences.T @ differences
    return matrix


def _nearer(control: Vector, at: Vector, features: Features, seen: Vector) -> Vector:
    """One Gauss-Newton step of each sample's place towards the nearest, of half a span at most."""
    spans = len(control) - DEGREE
    h = 1e-3 / spans
    low, high = np.clip(at - h, 0.0, 1.0), np.clip(at + h, 0.0, 1.0)
    slope = (features(b_spline(control, high)) - features(b_spline(control, low))) / (high - low)[
        :, None
    ]
    off = seen - features(b_spline(control, at))
    square = np.sum(slope * slope, axis=1)
    step = np.sum(off * slope, axis=1) / np.maximum(square, 1e-300)
    reach = 0.5 / spans
    nearer: Vector = np.clip(at + np.clip(step, -reach, reach), 0.0, 1.0)
    return nearer
