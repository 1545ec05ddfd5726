"""The verifier finds whatever of a motion file was changed, by its place."""

import json

import numpy as np
import pytest

from viapoint import verifier
from viapoint._motion_file import motion_text


@pytest.fixture(scope="module")
def data(everything):
    return motion_text(everything)


def found(verdict):
    return "\n".join(str(finding) for finding in verdict.findings)


def changed(data, change):
    """Verify a motion file after a change whose author sealed it anew."""
    document = json.loads(data)
    change(document)
    del document["sha256"]
    return verifier.verify_bytes(verifier.seal(json.dumps(document)[:-1] + "\n"))


def piece_on_curve(d):
    legs = {i for i, leg in enumerate(d["legs"]) if leg["hold"] == "pose"}
    return next(i for i, path in enumerate(d["paths"]) if path.get("leg") in legs)


def bend(d):
    d["paths"][piece_on_curve(d)]["coefficients"][3][1] += 2e-3


def nudge(d):
    path = d["paths"][piece_on_curve(d)]["coefficients"]
    path[5][2] += 4e-9  # many ulps of it; steps may be 1e-9


def shift(d):
    d["paths"][0]["coefficients"][0][0] += 3e-9


def slow(d):
    d["pieces"][3]["duration"] *= 1 + 1e-5


def fast(d):
    d["pieces"][3]["duration"] *= 0.9


def run_on(d):
    d["pieces"][5]["timing"][1] += 1e-5


def stop_short(d):
    last = max(
        piece["path"]
        for piece in d["pieces"]
        if np.any(np.array(d["paths"][piece["path"]]["coefficients"])[1:])
    )
    for piece in d["pieces"]:
        if piece["path"] == last:
            piece["timing"] = [0.7 * c for c in piece["timing"]]


def lower_limit(d):
    d["robot"]["limits"]["velocity"][0] *= 0.4


def raise_limit(d):
    d["robot"]["limits"]["jerk"][1] *= 1.1


def narrow(d):
    d["robot"]["limits"]["position_max"][2] = 1.7


def couple(d):
    limits = d["robot"]["limits"]
    limits["coupling"] = [[0, 1, 1, 0, 0, 0]]
    limits["coupling_lower"], limits["coupling_upper"] = [None], [0.2]


def longer_link(d):
    d["robot"]["chain"][2]["before"][0][3] += 1e-3


def other_tool(d):
    d["tools"][0][2][3] += 1e-6


def move_curve(d):
    leg = next(leg for leg in d["legs"] if leg["hold"] == "pose")
    leg["position"]["from"][1] += 2e-4


def turn_curve(d):
    leg = next(leg for leg in d["legs"] if leg["hold"] == "pose")
    leg["orientation"]["rate"][0] += 0.1


def tighten(d):
    d["tolerance"]["position"] = 1e-7


def claim_less(d):
    worst = d["certificate"]["velocity"][0]
    worst["share"] *= 0.9999
    worst["value"] *= 0.9999


def claim_less_deviation(d):
    d["certificate"]["path_deviation"] *= 0.1


def claim_elsewhere(d):
    d["certificate"]["jerk"][0]["time"] = d["certificate"]["duration"] - 0.05  # it waits there


def claim_range(d):
    d["certificate"]["position_max"][0] -= 1e-3


def claim_rule(d):
    rule = next(r for r in d["certificate"]["rules"] if r["kind"] == "acceleration")
    rule["joint"] = (rule["joint"] + 3) % 6


def claim_dexterity(d):
    d["certificate"]["manipulability"] *= 1.01


def claim_duration(d):
    d["certificate"]["duration"] += 1e-6


def claim_less_of_a_zone(d):
    corner = next(c for c in d["corners"] if not c["stopped"] and c["kind"] == "radius")
    corner["used"] *= 0.9


def smaller_zone(d):
    corner = next(c for c in d["corners"] if c["kind"] == "deviation")
    corner["asked"] *= 0.5


def claim_cut(d):
    d["certificate"]["zone_deviation"] *= 0.5


def slower_wish(d):
    next(leg for leg in d["legs"] if leg.get("speed"))["speed"] = 0.1


def claim_slower(d):
    d["certificate"]["tool"]["speed"]["share"] *= 0.9


def turn_less(d):
    next(leg for leg in d["legs"] if leg["hold"] == "pose")["angular_speed"] = 1e-3


def smaller_scale(d):
    d["legs"][0]["scale"] = 0.3


def drop_leg_of_a_path(d):
    path = d["paths"][piece_on_curve(d)]
    del path["leg"], path["from"], path["to"]


def drop_a_piece(d):
    del d["pieces"][10]


def swap_curve_for_less(d):
    d["legs"][3]["length"] *= 0.5


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (bend, "steps between"),
        (nudge, "position steps"),
        (shift, "position steps"),
        (slow, "steps between"),
        (fast, "steps between"),
        (run_on, "steps between"),
        (stop_short, "is not run from its beginning to its end"),
        (lower_limit, "velocity limit is broken"),
        (raise_limit, "claims more jerk"),
        (narrow, "leaves its range"),
        (couple, "coupled limit 1 is left"),
        (longer_link, "tool leaves its curve"),
        (other_tool, "fingerprint"),
        (move_curve, "tool leaves its curve"),
        (turn_curve, "tool turns away"),
        (tighten, "tool leaves its curve"),
        (claim_less, "claims less velocity"),
        (claim_less_deviation, "path_deviation is below"),
        (claim_elsewhere, "worst jerk is not where"),
        (claim_range, "position_max is not what"),
        (claim_rule, "claims another share"),
        (claim_dexterity, "manipulability"),
        (claim_duration, "duration"),
        (claim_less_of_a_zone, "leaves the zone"),
        (smaller_zone, "claims to use more"),
        (claim_cut, "zone_deviation"),
        (slower_wish, "speed of the tool is above"),
        (claim_slower, "claims less speed of the tool"),
        (turn_less, "angular speed of the tool is above"),
        (smaller_scale, "limit is broken"),
        (drop_leg_of_a_path, "belongs to no leg"),
        (drop_a_piece, "steps between"),
        (swap_curve_for_less, "not run from its beginning"),
    ],
    ids=lambda value: getattr(value, "__name__", None),
)
def test_a_change_is_found_though_the_file_is_sealed_anew(data, change, says):
    verdict = changed(data, change)
    assert says in found(verdict)


def test_findings_name_piece_move_time_joint_value_and_limit(data):
    verdict = changed(data, fast)
    first = next(f for f in verdict.findings if "velocity steps" in f.what)
    assert first.piece in (3, 4)
    assert first.move == 0
    assert first.joint is not None
    assert first.time == pytest.approx(first.time)
    assert first.value > first.limit > 0


@pytest.mark.parametrize("seed", range(20))
def test_any_byte_that_changes_is_found_by_the_seal(data, seed):
    rng = np.random.default_rng(seed)
    place = int(rng.integers(len(data) - 4))
    broken = data[:place] + bytes([data[place] ^ (1 << int(rng.integers(8)))]) + data[place + 1 :]
    with pytest.raises(verifier.MotionFileError):
        verifier.verify_bytes(broken)


@pytest.mark.parametrize("share", [0.0, 0.3, 0.999])
def test_a_file_cut_short_is_refused(data, share):
    with pytest.raises(verifier.MotionFileError, match="cut short"):
        verifier.verify_bytes(data[: int(share * len(data))])


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda d: d.update(version=2), "version"),
        (lambda d: d.update(version=1.0), "version: 1.0 is no integer"),
        (lambda d: d.update(format="viapoint points"), "format"),
        (lambda d: d.update(extra=1), 'unknown key "extra"'),
        (lambda d: d["robot"].pop("limits"), '"limits" is missing'),
        (lambda d: d["pieces"][0].update(duration=True), "True is no number"),
        (lambda d: d["pieces"][0].update(duration=-1.0), "not within"),
        (lambda d: d["pieces"][0].update(path=10**6), "not within"),
        (lambda d: d["paths"][0]["coefficients"].pop(), "must hold 6 values"),
        (lambda d: d["paths"][0]["coefficients"][0].append("x"), "must hold 6 values"),
        (lambda d: d["robot"]["chain"][0]["axis"].__setitem__(0, 0.5), "unit length"),
        (lambda d: d["tools"][0][0].__setitem__(0, 0.5), "it is no pose"),
        (lambda d: d["pieces"][0].update(outputs=[[99, True]]), "not within 0 to 63"),
        (lambda d: d["certificate"]["velocity"].pop(), "must hold 6 entries"),
        (lambda d: d.update(legs={}), "must be a list"),
    ],
)
def test_a_file_that_says_something_else_is_refused_by_its_place(data, change, says):
    with pytest.raises(verifier.MotionFileError, match=says):
        changed(data, change)


@pytest.mark.parametrize(
    ("inside", "says"),
    [
        ('"version": NaN', "NaN is no number"),
        ('"version": 1, "version": 1', "there twice"),
        ('"version": ' + "[" * 100_000, "nested too deeply|no JSON"),
        ('"version": 1' + "0" * 5000, "digits"),
        ('"version": ', "no JSON"),
        ('"version": 1e999', "no integer"),
    ],
    ids=["nan", "twice", "deep", "digits", "broken", "huge"],
)
def test_json_that_would_be_misread_is_refused(inside, says):
    with pytest.raises(verifier.MotionFileError, match=says):
        verifier.verify_bytes(verifier.seal('{"format": "viapoint motion", ' + inside))
