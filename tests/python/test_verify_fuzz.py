"""Whatever a motion file holds, the verifier gives a verdict or refuses it by name."""

import copy
import hashlib
import json

import numpy as np
import pytest

import viapoint as vp
from viapoint import verifier
from viapoint._motion_file import motion_text

FILES = 300
"""In CI, of each kind; ten thousand were looked at when this was written."""
ODD = (None, True, "x", [], {}, -1, 0, 1, 2, 63, 10**9, 10**400, -1.5, 0.5, 1e-300, 1e11, 1e300)


def motions():
    """Small motions that hold every part of the format."""
    ur5e = vp.load_robot("ur5e")
    home = np.radians([0, -90, 90, -90, -90, 0])
    pose = ur5e.fk(home)

    def moved(x, y, z):
        there = pose.copy()
        there[:3, 3] += (x, y, z)
        return there

    curves = vp.Program(ur5e, start=home, position_tolerance=1e-3, angle_tolerance=1e-2)
    curves.movel(moved(0, 0.02, 0), speed=0.3, zone=vp.deviation(2e-3))
    curves.movec(moved(0.01, 0.03, 0), moved(0.02, 0.02, 0), zone="fine").set_do(3, True)
    yield curves.plan()
    splines = vp.Program(ur5e, start=home, position_tolerance=1e-3, angle_tolerance=1e-2)
    splines.spline([moved(0.01, 0.01, 0), ur5e.fk(home + 0.02)])
    yield splines.plan()
    slide = vp.joint_robot(
        2, velocity=1.0, acceleration=5.0, jerk=50.0, coupling=[[1, 1]], lower=[-1], upper=[1]
    )
    joints = vp.Program(slide, start=[0, 0], zone=vp.joint_deviation(0.01))
    yield joints.movej([0.1, 0.0]).movej([0.1, 0.1]).wait(0.1).plan()
    timed = vp.Program(slide, start=[0, 0])
    yield timed.timed([([0, 0], 0.0), ([0.1, 0], 1.0), ([0.1, 0.1], 1.0)], t_acc=0.2).plan()


@pytest.fixture(scope="module")
def files():
    return [motion_text(motion) for motion in motions()]


def mutated_bytes(data, rng):
    """A few bytes of the sealed part replaced, doubled or left out, and sealed anew."""
    body = bytearray(data[: data.rindex(b',\n"sha256"')])
    for _ in range(int(rng.integers(1, 4))):
        at = int(rng.integers(len(body)))
        to = at + int(rng.integers(1, 30))
        kind = rng.integers(3)
        if kind == 0:
            body[at] = int(rng.integers(256))
        elif kind == 1:
            del body[at:to]
        else:
            body[at:at] = body[at:to]
    digest = hashlib.sha256(body).hexdigest().encode()
    return bytes(body) + b',\n"sha256": "' + digest + b'"\n}\n'


def mutated_fields(document, rng):
    """One to three values, anywhere in the tree, replaced, scaled, swapped, left out or doubled."""
    tree = copy.deepcopy(document)
    for _ in range(int(rng.integers(1, 4))):
        node = tree
        while True:
            keys = list(node) if isinstance(node, dict) else list(range(len(node)))
            if not keys:
                break
            key = keys[int(rng.integers(len(keys)))]
            deeper = isinstance(node[key], (dict, list)) and node[key]
            if deeper and rng.random() < 0.95:
                node = node[key]
                continue
            change_member(node, key, keys[int(rng.integers(len(keys)))], rng)
            break
    return verifier.seal(json.dumps(tree)[:-1])


def change_member(node, key, other, rng):
    kind = rng.integers(5)
    value = node[key]
    is_number = isinstance(value, (int, float)) and abs(value) < 2**60 and value is not True
    if kind == 0:
        node[key] = copy.deepcopy(ODD[int(rng.integers(len(ODD)))])
    elif kind == 1 and is_number:
        node[key] = type(value)(value * rng.choice([-1, 0, 2, 10, 1.001]))
    elif kind == 2:
        node[key], node[other] = node[other], node[key]
    elif kind == 3:
        del node[key]
    elif isinstance(node, list):
        node.append(copy.deepcopy(value))
    elif is_number:
        node[key] = type(value)(value + rng.choice([-1, 1]))


def judge(data):
    """Count as a verdict or as a refusal; anything else goes on up."""
    try:
        verifier.verify_bytes(data)
    except verifier.MotionFileError:
        return "refused"
    return "judged"


def sweep(files, mutate, seeds):
    outcomes = []
    for seed in seeds:
        rng = np.random.default_rng(seed)
        data = mutate(files[seed % len(files)], rng)
        try:
            outcomes.append(judge(data))
        except Exception as error:
            raise AssertionError(f"seed {seed}: {error!r}") from error
    return outcomes


def test_files_with_other_bytes_are_judged_or_refused_by_name(files):
    outcomes = sweep(files, mutated_bytes, range(FILES))
    assert "refused" in outcomes


def test_files_with_other_values_are_judged_or_refused_by_name(files):
    documents = [json.loads(data) for data in files]
    for document in documents:
        del document["sha256"]
    outcomes = sweep(documents, mutated_fields, range(FILES))
    assert {"refused", "judged"} == set(outcomes)


def test_a_turn_beyond_what_its_series_holds_for_is_refused(files):
    document = json.loads(files[1])
    del document["sha256"]
    spline = next(leg["orientation"] for leg in document["legs"] if "bases" in leg["orientation"])
    spline["coefficients"][0][0] = [3.0, 3.0, 3.0]
    with pytest.raises(verifier.MotionFileError, match="half a turn"):
        verifier.verify_bytes(verifier.seal(json.dumps(document)[:-1]))


def test_a_timed_motion_with_corners_is_refused(files):
    document = json.loads(files[2])
    del document["sha256"]
    document["kind"] = "timed"
    with pytest.raises(verifier.MotionFileError, match="neither legs nor corners"):
        verifier.verify_bytes(verifier.seal(json.dumps(document)[:-1]))
