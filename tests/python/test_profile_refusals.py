"""Whatever is given to the laws, what is refused is refused by name."""

import numpy as np
import pytest

import viapoint as vp
from viapoint import errors

p = vp.profile
STATES = {"v_max": 1.0, "a_max": 1.0, "j_max": 1.0}


def repr_or_huge(value):
    """Name a case; integers of thousands of digits are not written."""
    return "huge" if isinstance(value, int) and abs(value) > 10**4000 else repr(value)[:12]


@pytest.mark.parametrize("gap", [1e-7, 1e-15, 1e-300, 5e-324])
@pytest.mark.parametrize("way", [{"speed": 1.0}, {"durations": [1.0, 1.0]}])
def test_a_half_gap_too_small_to_matter_is_named_at_once(gap, way):
    with pytest.raises(
        errors.BadArgumentError, match=r"^half_gap is .* s; it must be at least"
    ) as e:
        p.blended_lines([0.0, 1.0, 0.0], **way, acceleration=20.0, through={1: 0.0}, half_gap=gap)
    assert e.value.value == gap
    assert e.value.limit == pytest.approx(1e-6, rel=0.1)
    assert e.value.ways_out


def test_the_least_acceleration_is_named_where_half_gap_is_small():
    lines = {"points": [0.0, 1.0, 0.0], "speed": 1.0, "through": {1: 0.5}, "half_gap": 1e-5}
    with pytest.raises(errors.BadArgumentError, match="no linear part") as caught:
        p.blended_lines(**lines, acceleration=20.0)
    assert caught.value.limit > 1e4
    p.blended_lines(**lines, acceleration=caught.value.limit * (1.0 + 1e-6))
    lines["half_gap"] = 10.0
    with pytest.raises(errors.BadArgumentError, match=r"leave .* of segment 0"):
        p.blended_lines(**lines, acceleration=20.0)


@pytest.mark.parametrize(
    "joint", ["x", 1.5, None, True, -1, 2, 10**400, 10**5000, [0]], ids=repr_or_huge
)
def test_joints_and_derivatives_of_a_motion_are_integers(joint):
    motion = p.state_to_state([0.0, 0.0], [1.0, 1.0], **STATES)
    with pytest.raises(errors.BadArgumentError, match=r"^axis is .*from 0 to 1"):
        motion.parts(joint)
    if joint is not None:
        with pytest.raises(errors.BadArgumentError, match=r"^axis is .*from 0 to 1"):
            motion.knots(joint)
    if joint != 2:
        with pytest.raises(errors.BadArgumentError, match=r"^derivative is .*from 0 to 3"):
            motion.extremes(joint)
    assert motion.extremes(np.int64(1)).high.shape == (2,)
    assert motion.parts(np.int32(1))


@pytest.mark.parametrize(
    "value", [10**400, -(10**400), 10**5000, np.longdouble("1e4000")], ids=repr_or_huge
)
def test_numbers_beyond_doubles_are_named(value):
    with pytest.raises(errors.BadArgumentError, match=r"^duration is .*finite"):
        p.cubic(0.0, 1.0, value)
    with pytest.raises(errors.BadArgumentError, match=r"^q1"):
        p.cubic(0.0, value, 1.0)
    with pytest.raises(errors.BadArgumentError, match=r"^dt is .*finite"):
        p.state_to_state(0.0, 1.0, **STATES).sample(value)


@pytest.mark.parametrize("laws", [1.0, None, np.array(3.0), p.cubic(0.0, 1.0, 1.0)])
def test_laws_that_are_no_list_are_named(laws):
    with pytest.raises(errors.BadArgumentError, match=r"^laws is a .*list of laws"):
        p.together(laws)


@pytest.mark.parametrize("conditions", [1.0, None, "x", np.array(3.0), np.ma.masked])
def test_conditions_that_are_no_list_are_named(conditions):
    with pytest.raises(errors.BadArgumentError, match=r"^conditions must be a list"):
        p.polynomial(conditions)
