"""Beyond this machine a controller wants to know who connects, and says who it is."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

import viapoint as vp
from viapoint.errors import FileError, UnconnectedError

DOCUMENT = Path(__file__).parents[2] / "docs" / "controller.md"


def openssl(folder, *arguments):
    subprocess.run(["openssl", *arguments], cwd=folder, check=True, capture_output=True, timeout=60)


def authority(folder, name):
    openssl(
        folder, *("req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256"),
        *("-nodes", "-days", "2", "-subj", f"/CN={name}", "-keyout", f"{name}.key"),
        *("-out", f"{name}.pem"),
    )  # fmt: skip


def certificate(folder, name, signed_by, days="2"):
    (folder / "names").write_text("subjectAltName=IP:127.0.0.1\n", encoding="ascii")
    openssl(
        folder, *("req", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes"),
        *("-subj", f"/CN={name}", "-keyout", f"{name}.key", "-out", f"{name}.csr"),
    )  # fmt: skip
    openssl(
        folder, *("x509", "-req", "-in", f"{name}.csr", "-CA", f"{signed_by}.pem", "-days", days),
        *("-CAkey", f"{signed_by}.key", "-CAcreateserial", "-extfile", "names"),
        *("-out", f"{name}.pem"),
    )  # fmt: skip


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("tls")
    for name in ("controller-ca", "clients-ca", "strangers-ca"):
        authority(folder, name)
    certificate(folder, "controller", "controller-ca")
    certificate(folder, "me", "clients-ca")
    certificate(folder, "stranger", "strangers-ca")
    certificate(folder, "late", "clients-ca", days="-1")
    return folder


@pytest.fixture
def served(serve, files):
    tls = {
        "authority": str(files / "clients-ca.pem"),
        "certificate": str(files / "controller.pem"),
        "key": str(files / "controller.key"),
    }
    return serve(tls=tls)


def shown(files, who, trusts="controller-ca"):
    return vp.TlsFiles(files / f"{trusts}.pem", files / f"{who}.pem", files / f"{who}.key")


def test_who_shows_a_certificate_has_the_arm(served, files):
    with vp.connect(served.url, tls=shown(files, "me")) as arm:
        arm.run(vp.Program(arm.robot, start=arm.setpoint).movej(arm.setpoint + 0.02))


def test_who_shows_none_or_a_strangers_is_refused(served, files):
    with pytest.raises(UnconnectedError):
        vp.connect(served.url)
    with pytest.raises(UnconnectedError):
        vp.connect(served.url, tls=shown(files, "stranger"))


def test_who_shows_a_certificate_that_has_run_out_is_refused(served, files):
    with pytest.raises(UnconnectedError):
        vp.connect(served.url, tls=shown(files, "late"))
    assert served.process.poll() is None


def test_a_controller_whose_own_files_are_none_does_not_start(serve, files):
    tls = {name: str(files / "controller.pem") for name in ("authority", "certificate", "key")}
    with pytest.raises(AssertionError, match="belong together"):
        serve(tls=tls)
    (files / "none.pem").write_text("no certificate\n", encoding="ascii")
    tls = {name: str(files / "none.pem") for name in ("authority", "certificate", "key")}
    with pytest.raises(AssertionError, match="PEM"):
        serve(tls=tls)


def test_a_controller_of_another_authority_is_not_believed(served, files):
    with pytest.raises(UnconnectedError):
        vp.connect(served.url, tls=shown(files, "me", trusts="strangers-ca"))


def test_a_tls_file_that_is_not_there_is_named(served, files):
    with pytest.raises(FileError, match="nobody"):
        vp.connect(served.url, tls=shown(files, "nobody"))


def test_the_script_of_the_document_runs(served, files):
    text = DOCUMENT.read_text(encoding="utf-8")
    (script,) = [
        script
        for script in re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
        if "tls" in script
    ]
    done = subprocess.run(
        [sys.executable, "-c", re.sub(r"[\d.]+:7420", f"127.0.0.1:{served.port}", script)],
        cwd=files,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0, done.stderr
