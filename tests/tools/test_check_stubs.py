"""Stale stubs are shown as a difference."""

from check_stubs import difference


def test_equal_stubs_have_no_difference():
    stubs = {"_core.pyi": "def f() -> int: ...\n"}
    assert difference(stubs, dict(stubs)) == ""


def test_a_changed_signature_and_a_missing_file_are_shown():
    committed = {"_core/__init__.pyi": "def f() -> int: ...\n"}
    generated = {
        "_core/__init__.pyi": "def f() -> float: ...\n",
        "_core/profile.pyi": "def g() -> int: ...\n",
    }
    text = difference(committed, generated)
    assert "-def f() -> int: ..." in text
    assert "+def f() -> float: ..." in text
    assert "+++ generated/_core/profile.pyi" in text
