"""No motion of ours takes longer than Ruckig's; skipped where Ruckig is not installed."""

import numpy as np
import pytest

import viapoint as vp

ruckig = pytest.importorskip(
    "ruckig",
    reason="Ruckig is not installed: pip install 'viapoint[compare]'",
)


def random_states(random, limits):
    """Velocities and accelerations that can be held, (n,) each; some zero."""
    n = len(limits["v_max"])
    while True:
        v = random.uniform(limits["v_min"], limits["v_max"])
        a = random.uniform(limits["a_min"], limits["a_max"]) * 10.0 ** random.uniform(-3, 0, n)
        a[random.random(n) < 0.2] = 0.0
        still = random.random(n) < 0.1
        v[still] = a[still] = 0.0
        slow = a * a / (2.0 * limits["j_max"])
        if ((v + slow <= limits["v_max"]) & (v - slow >= limits["v_min"])).all():
            return v, a


def random_problem(seed, joints):
    """Other limits upwards than downwards; every second one ends close by, where gaps are."""
    random = np.random.default_rng([seed, joints])
    limits = {
        "v_max": random.uniform(0.5, 3.0, joints),
        "v_min": -random.uniform(0.5, 3.0, joints),
        "a_max": random.uniform(0.5, 5.0, joints),
        "a_min": -random.uniform(0.5, 5.0, joints),
        "j_max": random.uniform(1.0, 20.0, joints),
    }
    v0, a0 = random_states(random, limits)
    v1, a1 = random_states(random, limits)
    q1 = random.normal(0.0, 0.1 if seed % 2 else 2.0, joints)
    if seed % 5 == 0:
        v0 *= 1.5  # some starts are outside
    return {"q0": np.zeros(joints), "q1": q1, "v0": v0, "a0": a0, "v1": v1, "a1": a1} | limits


def duration_of_ruckig(problem, solver, cycle=None):
    joints = len(problem["q0"])
    given = ruckig.InputParameter(joints)
    for ours, theirs in (("0", "current"), ("1", "target")):
        setattr(given, f"{theirs}_position", problem[f"q{ours}"])
        setattr(given, f"{theirs}_velocity", problem[f"v{ours}"])
        setattr(given, f"{theirs}_acceleration", problem[f"a{ours}"])
    given.max_velocity, given.min_velocity = problem["v_max"], problem["v_min"]
    given.max_acceleration, given.min_acceleration = problem["a_max"], problem["a_min"]
    given.max_jerk = problem["j_max"]
    if cycle is not None:
        given.duration_discretization = ruckig.DurationDiscretization.Discrete
    trajectory = ruckig.Trajectory(joints)
    try:
        result = solver.calculate(given, trajectory)
    except RuntimeError:
        return None
    return (
        trajectory.duration if result in (ruckig.Result.Working, ruckig.Result.Finished) else None
    )


@pytest.mark.parametrize(("joints", "count"), [(1, 3000), (3, 2000), (7, 1500)])
def test_no_motion_takes_longer_than_ruckigs(joints, count):
    solver = ruckig.Ruckig(joints)
    compared = 0
    for seed in range(count):
        problem = random_problem(seed, joints)
        ours = vp.profile.state_to_state(**problem).duration  # every one is solved
        theirs = duration_of_ruckig(problem, solver)
        if theirs is None:
            continue
        compared += 1
        assert ours <= theirs * (1.0 + 1e-9), f"seed {seed}, {joints} joints"
    assert compared > 0.9 * count


def test_rounded_up_to_a_cycle_no_motion_takes_longer_than_ruckigs():
    cycle = 0.01
    solver = ruckig.Ruckig(3, cycle)
    for seed in range(500):
        problem = random_problem(seed, 3)
        ours = vp.profile.state_to_state(**problem, cycle=cycle).duration
        theirs = duration_of_ruckig(problem, solver, cycle)
        assert theirs is None or ours <= theirs * (1.0 + 1e-9), f"seed {seed}"
