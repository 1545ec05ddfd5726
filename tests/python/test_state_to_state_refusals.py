"""What a motion from state to state cannot be is said with the joint, the value and a way out."""

import math

import numpy as np
import pytest

import viapoint as vp
from viapoint import errors

LIMITS = {"v_max": 1.0, "a_max": 1.0, "j_max": 1.0}


def test_last_digits_of_a_position_are_no_direction():
    motions = [
        vp.profile.state_to_state([0.3, 0.5], q1, v0=[0.0, 0.1], sync="line", **LIMITS)
        for q1 in ([0.3, 0.5], [0.1 + 0.2, 0.5])
    ]
    assert motions[0].duration == pytest.approx(motions[1].duration, rel=1e-12)


def test_a_joint_too_fast_to_wait_is_named():
    wall = 0.12647137053646249
    problem = {
        "q0": [-0.01863922441044345, -0.03041609229165854, -0.10060208233120412],
        "q1": [0.04427137265169751, 0.03165297544312665, 0.12563384593481963],
        "v0": [-0.0652046417568103, 0.48422338260556846, 1.6612719525571658],
        "a0": [-1.7406980167442037, -0.6996154949936793, -2.0994477140705015],
        "v1": [0.24797762996127404, 0.02366173459484218, 1.5587918292512288],
        "v_max": [1.7990965158837944, 2.2266601450006083, 8.239243134495418],
        "a_max": [23.047950855718526, 2.8545155055038194, 14.247812730284206],
        "j_max": [28.765148261427697, 17.91273024624364, 50.573455130481705],
    }
    with pytest.raises(errors.BadArgumentError, match=r"v0\[2\] is 1\.66.*p_min.*q1") as caught:
        vp.profile.state_to_state(**problem, p_min=-wall, p_max=wall)
    assert caught.value.joint == 2
    assert caught.value.value == problem["v0"][2]
    assert any('sync="none"' in way for way in caught.value.ways_out)
    assert vp.profile.state_to_state(**problem, p_min=-wall, p_max=wall, sync="none").duration > 0.0


@pytest.mark.parametrize(
    ("name", "value"),
    [("p_min", math.inf), ("p_max", -math.inf), ("p_min", math.nan), ("p_max", math.nan)],
)
def test_a_position_limit_that_is_none_is_named(name, value):
    with pytest.raises(errors.BadLimitsError, match=rf"^{name}\[0\] is .*{value}") as caught:
        vp.profile.state_to_state([0.0, 0.0], [1.0, 1.0], **LIMITS, **{name: value})
    assert caught.value.joint == 0
    assert caught.value.ways_out


@pytest.mark.parametrize("wait", [1e3, 1e5, 1e7, 1e9])
def test_joints_that_move_at_first_may_wait_for_years(wait):
    for seed in range(100):
        dice = np.random.default_rng(seed)
        v0, v1, a0 = (dice.uniform(-0.9, 0.9, 7) for _ in range(3))
        motion = vp.profile.state_to_state(
            np.zeros(7),
            dice.uniform(-2.0, 2.0, 7),
            v0=v0,
            a0=a0,
            v1=v1,
            v_max=1.0,
            a_max=5.0,
            j_max=50.0,
            least_duration=wait,
        )
        assert motion.duration >= wait, f"seed {seed}"


def test_a_cycle_finer_than_the_duration_can_tell_changes_nothing():
    motion = vp.profile.state_to_state(0.0, 1.0, cycle=1e-300, **LIMITS)
    assert motion.duration == vp.profile.state_to_state(0.0, 1.0, **LIMITS).duration
