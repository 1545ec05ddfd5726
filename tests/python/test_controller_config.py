"""A configuration that is wrong anywhere is refused by name, before anything is enabled."""

import json
import subprocess
from pathlib import Path

import pytest

import viapoint as vp

WRONG = {
    "speed: 3": 'unknown key "speed"',
    "robot: ur5e": '"robot" is there twice',
    "listen: 0.0.0.0:7420": "other machines could reach the arm",
    "listen: '[::]:7420'": "other machines could reach the arm",
    "listen: 10.0.0.1:7420": "other machines could reach the arm",
    "listen: localhost:7420": "no address and port in numbers",
    "listen: 127.0.0.1": "no address and port in numbers",
    "listen: 127.0.0.1:99999": "no address and port in numbers",
    "listen: 127.0.0.1:-1": "no address and port in numbers",
    "cycle: 0": "cycle: is 0; allowed are 1e-04 to 1 s",
    "cycle: fast": "cycle: expected a number",
    "heartbeat: .nan": "heartbeat: expected a number",
    "heartbeat: 0.001": "heartbeat: is 0.001; allowed are 0.02 to 60 s",
    "heartbeat: 0.02": "allowed are 40 cycles, 0.08 s, or more",
    "cycle: 0.01": "allowed are 40 cycles, 0.4 s, or more",
    "processor: -1": "processor: is -1; processors count from 0",
    "processor: 1.5": "processor: expected a whole number",
    "keep_awake: never": 'keep_awake: is "never"; allowed are true and false',
    "tool_speed: -1": "tool_speed: is -1",
    "drive: ethercat": '"ethercat" is no drive',
    "drive: {}": "is no drive",
    "drive: {simulated: {}, udp: 127.0.0.1:7500}": "is no drive",
    "drive: {simulated: {lag: -1}}": "lag: is -1; allowed are 0 to 10 s",
    "drive: {simulated: {noise: .nan}}": "noise: expected a number",
    "drive: {simulated: {seed: -1}}": "seed: is -1; it must be 0 or more",
    "drive: {simulated: {weight: 3}}": 'unknown key "weight"',
    "drive: {udp: localhost:7500}": "no address and port in numbers",
    "drive: {udp: 127.0.0.1:0}": "the device's port is 0",
    "drive: {udp: 127.0.0.1:7500, silent_cycles: -1}": "silent_cycles: is -1; allowed are 0",
    "start: [0, 0, 0, 0, 0, 0]\ndrive: {udp: 127.0.0.1:7500}": "is for a simulated drive",
    "start: [0, 0]": 'start has 2 values, "puma560" has 6 joints',
    "start: [0, 0, 0, 0, 0, .inf]": "not finite",
    "start: [9, 0, 0, 0, 0, 0]": "start of joint 1 is 9; allowed are",
    "start: []": "start: has 0 values",
    "workspace: {min: [0, 0, 0]}": '"max" is missing',
    "workspace: {min: [0, 0, 0], max: [1, 1, 0]}": "max must be beyond min",
    "tls: {authority: a.pem, certificate: b.pem}": '"key" is missing',
    "tls: {authority: a.pem, certificate: b.pem, key: c.key}": "cannot open: No such file",
    "logs: /nowhere/at/all": "the log cannot be written there",
    "rtde: {port: 65536}": "rtde.port: is 65536; allowed are 0 to 65535",
    "rtde: {port: 0.5}": "is no whole number",
    "rtde: {address: localhost}": "no address in numbers",
    "rtde: {address: 0.0.0.0}": "RTDE has neither passwords nor encryption",
    "rtde: {address: 10.0.0.1, other_machines: 'yes'}": 'the only word for it is "allowed"',
    "rtde: {ports: 1}": 'unknown key "ports"',
    "cycle: [": "is no YAML",
    "---": "holds 2 documents",
}


def refusal(controller, tmp_path, text):
    config = tmp_path / "controller.yaml"
    config.write_text(text, encoding="utf-8")
    done = subprocess.run(
        [controller, "--config", str(config)],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    return done.returncode, done.stderr


@pytest.mark.parametrize("line", WRONG, ids=str)
def test_what_is_wrong_is_named(controller, tmp_path, line):
    code, said = refusal(controller, tmp_path, f"robot: puma560\n{line}\n")
    assert code == 3
    assert WRONG[line] in said


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("robt: puma560\n", ['key "robot" is missing, there is "robt"', 'write "robot"']),
        ("robot: puma560\nheartbaet: 1\n", ['unknown key "heartbaet"', 'write "heartbeat"']),
        ("robot: puma560\nworkspace: {min: [0, 0, 0]}\n", ['key "max" is missing', "add max"]),
        ("robot: puma560\nnonsense: 1\n", ['unknown key "nonsense"', "known keys here"]),
    ],
)
def test_a_slip_of_the_pen_is_told_what_was_meant(controller, tmp_path, text, says):
    code, said = refusal(controller, tmp_path, text)
    assert code == 3
    for part in says:
        assert part in said
    assert ('write "' in said) == any("write" in part for part in says)


def test_a_file_that_is_none_is_named(controller, tmp_path):
    code, said = refusal(controller, tmp_path, "")
    assert code == 3
    assert "holds 0 documents" in said
    assert 'key "robot" is missing' in refusal(controller, tmp_path, "cycle: 0.002")[1]
    assert refusal(controller, tmp_path, "x" * (2 << 20))[0] == 3
    missing = subprocess.run(
        [controller, "--config", str(tmp_path / "none.yaml")],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert missing.returncode == 3
    assert "none.yaml" in missing.stderr


def test_the_configuration_that_is_installed_is_one(serve):
    example = Path(__file__).parents[2] / "cpp/controller/viapoint-controller.yaml"
    lines = example.read_text(encoding="utf-8").splitlines()
    keys = [line for line in lines if line[:1] not in "# "]
    told = dict(line.partition("#")[0].strip().split(": ", 1) for line in keys)
    assert {"robot", "drive", "start", "listen", "cycle", "heartbeat"} == set(told)
    start = json.loads(told["start"])
    served = serve(
        robot=told["robot"],
        drive=told["drive"],
        start=start,
        cycle=float(told["cycle"]),
        heartbeat=float(told["heartbeat"]),
    )
    assert served.end() == 0


def test_names_that_are_relative_count_from_the_folder_of_the_configuration(
    serve, tmp_path, monkeypatch
):
    """The controller is started somewhere else."""
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    (tmp_path / "logs").mkdir()
    robot = vp.load_robot("puma560")
    (tmp_path / "arm.yaml").write_text(robot._core.to_yaml(), encoding="utf-8")
    served = serve(robot="./arm.yaml", logs="logs")
    with vp.connect(served.url) as arm:
        assert arm.robot.fingerprint == robot.fingerprint
        arm.run(vp.Program(arm.robot, start=arm.setpoint).movej([0.05] * 6))
    served.end()
    assert list((tmp_path / "logs").glob("*.csv"))
    assert not list(elsewhere.iterdir())
