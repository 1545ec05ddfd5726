"""Logs into files and back: to the last bit, and into what other tools read."""

import contextlib
import json
import resource
import subprocess
import sys

import numpy as np
import pytest

import viapoint as vp
from viapoint import _core, errors
from viapoint._log_files import ROWS, SCALARS, robot_in
from viapoint._log_mcap import TOPICS
from viapoint._written_aside import written_aside

reader = pytest.importorskip("mcap.reader")


@pytest.fixture(scope="module")
def log(puma, abc):
    """A run with a pause, outputs and two tools, in virtual time: nothing was measured."""
    tool = np.eye(4)
    tool[2, 3] = 0.1
    program = vp.Program(puma, start=abc["A"]).movej(abc["A"] + 0.1).set_do(63, True)
    program.set_do(2, True).set_tool(tool).movej(abc["A"]).set_do(2, False)
    motion = program.plan()
    core = _core.simulate(motion._core, [(0.1, "pause", []), (0.3, "resume", [])], 0.002)
    return vp.RunLog.of(core, motion, 0.002)


@pytest.fixture(scope="module")
def real(puma, abc):
    """A run on the simulated drive: every cycle was measured."""
    program = vp.Program(puma, start=abc["A"]).movej(abc["A"] + 0.05)
    with vp.connect("sim://puma560", start=abc["A"]) as arm:
        return arm.run(program).log


def assert_same(read, log):
    for key in (*SCALARS, *ROWS):
        np.testing.assert_array_equal(getattr(read, key), getattr(log, key), err_msg=key)
        assert getattr(read, key).dtype == getattr(log, key).dtype
    assert read.period == log.period
    np.testing.assert_array_equal(read.samples.t, log.samples.t)


@pytest.mark.parametrize("ending", ["npz", "mcap", "csv"])
def test_a_log_reads_back_to_the_last_bit(log, real, puma, tmp_path, ending):
    for name, kept in (("virtual", log), ("real", real)):
        path = tmp_path / f"{name}.{ending}"
        kept.save(path)
        read = vp.load_log(path, puma if ending == "csv" else None)
        assert_same(read, kept)
        assert read.robot.fingerprint == puma.fingerprint
        again = tmp_path / f"{name}.again.csv"
        read.save(again)
        kept.save(tmp_path / f"{name}.csv")
        assert again.read_bytes() == (tmp_path / f"{name}.csv").read_bytes()


@pytest.mark.parametrize("ending", ["npz", "mcap"])
def test_a_log_holds_its_robot_and_tools(log, tmp_path, ending):
    log.save(tmp_path / f"x.{ending}")
    read = vp.load_log(tmp_path / f"x.{ending}")
    np.testing.assert_array_equal(read.samples.pose, log.samples.pose)
    own = vp.joint_robot(2, velocity=1, acceleration=5, jerk=50)
    samples = vp.Program(own, start=[0, 0]).movej([0.1, 0]).plan()
    core = _core.simulate(samples._core, [], 0.004)
    vp.RunLog.of(core, samples, 0.004).save(tmp_path / f"own.{ending}")
    assert vp.load_log(tmp_path / f"own.{ending}").robot.fingerprint == own.fingerprint


def test_an_mcap_is_what_its_own_reader_and_its_schemas_say(log, tmp_path):
    log.save(tmp_path / "x.mcap")
    kinds = {"number": (int, float), "integer": int, "string": str, "object": dict, "array": list}

    def check(value, schema, place):
        if value is None:
            assert place.startswith("/measured")  # nothing was measured
            return
        assert isinstance(value, kinds[schema["type"]]), place
        for member, of in schema.get("properties", {}).items():
            check(value[member], of, f"{place}.{member}")
        for i, item in enumerate(value if isinstance(value, list) else []):
            check(item, schema["items"], f"{place}[{i}]")

    counts = dict.fromkeys(TOPICS, 0)
    with (tmp_path / "x.mcap").open("rb") as file:
        for schema, channel, message in reader.make_reader(file).iter_messages():
            assert (schema.name, schema.encoding) == (TOPICS[channel.topic][0], "jsonschema")
            assert channel.message_encoding == "json"
            content = json.loads(message.data)
            check(content, json.loads(schema.data), channel.topic)
            stamp = content["timestamp"]
            assert stamp["sec"] * 10**9 + stamp["nsec"] == message.log_time
            counts[channel.topic] += 1
    events = counts.pop("/events")
    assert set(counts.values()) == {len(log)}
    assert events >= 8  # states, moves and outputs


def test_events_tell_every_change_in_its_cycle(log, tmp_path):
    log.save(tmp_path / "x.mcap")
    with (tmp_path / "x.mcap").open("rb") as file:
        told = [
            (message.sequence, json.loads(message.data)["message"])
            for _, _, message in reader.make_reader(file).iter_messages(topics="/events")
        ]
    paused = int(np.flatnonzero(log.state == log.STATES.index("paused"))[0])
    on = int(np.flatnonzero(log.outputs & np.uint64(4))[0])
    assert (paused, "state: paused") in told
    assert (on, "output 2: on") in told
    assert (on, "output 63: on") in told
    assert any(text == "output 2: off" for _, text in told)


def test_the_tools_pose_is_there(log, tmp_path):
    log.save(tmp_path / "x.mcap")
    with (tmp_path / "x.mcap").open("rb") as file:
        last = [m for _, _, m in reader.make_reader(file).iter_messages(topics="/tool")][-1]
    place = json.loads(last.data)["pose"]["position"]
    np.testing.assert_array_equal([place[k] for k in "xyz"], log.samples.pose[-1, :3, 3])


def test_joints_keep_their_names_whatever_signs_are_in_them(puma, log, tmp_path):
    odd = robot_in(puma._core.to_yaml().replace("joint1", "100%d"))
    vp.RunLog.of_robot(log.core, odd, log.period).save(tmp_path / "x.mcap")
    with (tmp_path / "x.mcap").open("rb") as file:
        messages = reader.make_reader(file).iter_messages(topics="/joint_states")
        last = json.loads([message.data for _, _, message in messages][-1])
    assert [joint["name"] for joint in last["joints"]] == ["100%d", *puma.joint_names[1:]]
    assert [joint["position"] for joint in last["joints"]] == log.q[-1].tolist()
    assert [joint["acceleration"] for joint in last["joints"]] == log.qdd[-1].tolist()


def test_numbers_as_json_read_back_to_the_last_bit():
    rng = np.random.default_rng(5)
    bits = rng.integers(0, 2**64, (2000, 6), dtype=np.uint64).view(np.float64)
    plain = [[0.0, -0.0, 5e-324, 1e22, -7.0, 100000.0], [np.nan, np.inf, -np.inf, 0.1, 1 / 3, 2e-5]]
    values = np.vstack((np.round(rng.normal(size=(500, 6)), 2), bits, plain))
    texts = _core.json_rows(values)
    read = np.array([json.loads(text) for text in texts], dtype=np.float64)
    expected = np.where(np.isfinite(values), values, np.nan)
    is_number = np.isfinite(values)
    np.testing.assert_array_equal(
        read.view(np.uint64)[is_number], expected.view(np.uint64)[is_number]
    )
    assert np.isnan(read[~is_number]).all()
    assert texts[-1].startswith("[null,null,null,0.1,")
    assert "-0.0," in texts[-2]
    assert _core.json_rows(np.zeros((0, 6))) == []


@pytest.mark.parametrize("name", ["log", "log.txt", "log.npz.gz"])
def test_a_log_of_no_known_format_is_refused(log, tmp_path, name):
    for call in (log.save, vp.load_log):
        with pytest.raises(errors.BadArgumentError, match="ends in"):
            call(tmp_path / name)


@pytest.mark.parametrize("ending", ["npz", "mcap", "csv"])
def test_a_log_that_is_not_there_or_cannot_be_written_is_refused(log, puma, tmp_path, ending):
    with pytest.raises(errors.FileError, match="no_such_folder"):
        log.save(tmp_path / "no_such_folder" / f"x.{ending}")
    with pytest.raises(errors.FileError, match=r"no log .*nothing"):
        vp.load_log(tmp_path / f"nothing.{ending}", puma)


@pytest.mark.parametrize("ending", ["npz", "mcap", "csv"])
def test_a_full_disk_is_told_by_name_and_costs_nothing_that_was_there(log, real, tmp_path, ending):
    path = tmp_path / f"x.{ending}"
    real.save(path)
    old = path.read_bytes()
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    # A write beyond 4 KiB fails, as it does on a full disk; Python ignores the signal.
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, before[1]))
    try:
        with pytest.raises(errors.FileError, match=rf"x\.{ending}: cannot write") as told:
            log.save(path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert "make room" in told.value.ways_out[0]
    assert path.read_bytes() == old
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("ending", ["npz", "mcap"])
def test_a_long_log_is_written_in_pieces(log, tmp_path, monkeypatch, ending):
    columns = {key: np.tile(getattr(log, key), 20) for key in SCALARS}
    columns |= {key: np.tile(getattr(log, key), (20, 1)) for key in ROWS}
    columns["cycle"] = np.arange(len(columns["cycle"]), dtype=np.uint64)
    columns["stamp"] = columns["cycle"].astype(np.int64) * 2_000_000
    long = vp.RunLog.of_robot(_core.Log.of_columns(columns), log.robot, log.period, log.tools)
    pieces = []

    class Watched(_core.AtomicFile):
        def write(self, piece):
            pieces.append(len(piece))
            super().write(piece)

    monkeypatch.setattr(_core, "AtomicFile", Watched)
    path = tmp_path / f"long.{ending}"
    long.save(path)
    assert sum(pieces) == path.stat().st_size
    assert max(pieces) < 0.5 * path.stat().st_size
    assert_same(vp.load_log(path), long)


def test_a_block_that_fails_leaves_the_old_file(tmp_path):
    path = tmp_path / "x.bin"
    path.write_bytes(b"old")

    def fail_halfway():
        with written_aside(str(path)) as file:
            file.write(b"part")
            raise KeyError

    with pytest.raises(KeyError):
        fail_halfway()
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]
    with written_aside(str(path)) as file:
        file.write(b"ne")
        file.write(bytearray(b"w"))
        assert file.tell() == 3
        assert path.read_bytes() == b"old"
    assert path.read_bytes() == b"new"


def test_a_csv_without_its_robot_and_a_log_of_another_are_refused(log, tmp_path):
    log.save(tmp_path / "x.csv")
    with pytest.raises(errors.BadArgumentError, match="which arm moved"):
        vp.load_log(tmp_path / "x.csv")
    with pytest.raises(errors.BadArgumentError, match="holds 6 joints"):
        vp.load_log(tmp_path / "x.csv", vp.load_robot("scara"))


@pytest.mark.parametrize("ending", ["npz", "mcap", "csv"])
def test_a_log_that_is_cut_short_or_damaged_is_refused_by_name(log, puma, tmp_path, ending):
    path = tmp_path / f"x.{ending}"
    log.save(path)
    data = path.read_bytes()
    rng = np.random.default_rng(7)
    for _ in range(60):
        broken = bytearray(data)
        if rng.random() < 0.3:
            del broken[int(rng.integers(len(data) - 1)) :]
        else:
            for at in rng.integers(len(data), size=3):
                broken[int(at)] ^= int(rng.integers(1, 256))
        path.write_bytes(broken)
        with contextlib.suppress(errors.BadProgramError, errors.BadArgumentError):
            vp.load_log(path, puma)


def test_without_mcap_its_installation_is_the_way_out(tmp_path):
    code = (
        "import sys; sys.modules['mcap'] = None\n"
        "import viapoint as vp\n"
        "robot = vp.load_robot('puma560')\n"
        "with vp.connect('sim://puma560', start=[0, 0, 0, 0, 0.5, 0]) as arm:\n"
        "    program = vp.Program(robot, start=arm.setpoint).movej([0, 0, 0, 0, 0.51, 0])\n"
        "    log = arm.run(program).log\n"
        "try:\n    log.save('x.mcap')\n"
        "except vp.errors.FileError as error:\n    print(error.ways_out[0])\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert "pip install viapoint[mcap]" in done.stdout


@pytest.mark.parametrize("ending", ["npz", "csv", "mcap"])
def test_a_log_without_a_cycle_is_read_back(tmp_path, puma, ending):
    columns = {
        **{key: np.zeros(0, kind) for key, kind in SCALARS.items()},
        **{key: np.zeros((0, 6)) for key in ROWS},
    }
    log = vp.RunLog.of_robot(_core.Log.of_columns(columns), puma, 0.002)
    log.save(tmp_path / f"none.{ending}")
    read = vp.load_log(tmp_path / f"none.{ending}", puma if ending == "csv" else None)
    assert len(read) == 0
    assert read.q.shape == (0, 6)
    assert read.samples.pose.shape == (0, 4, 4)
