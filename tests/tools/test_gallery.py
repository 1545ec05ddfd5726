"""The gallery shows what its code makes, and every law there is."""

import re

import pytest

import make_gallery
import viapoint as vp


@pytest.fixture(scope="module")
def page():
    return make_gallery.PAGE.read_text(encoding="utf-8")


def test_every_block_runs_and_the_page_says_what_it_found(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with make_gallery.without_files():
        made = make_gallery.made_page(page)
    assert made == page, "docs/gallery.md is not what its code makes: run ./tools/gallery"
    assert list(tmp_path.iterdir()) == []


def test_a_changed_number_is_noticed(page):
    block = make_gallery.BLOCK.search(page, page.index("### Cubic"))
    with make_gallery.without_files():
        made = make_gallery.made_page(block[0].replace("cubic(10.0", "cubic(11.0"))
    assert made != block[0]
    assert "| 11 |" in made


def test_pictures_and_page_belong_together(page):
    shown = set(re.findall(r"images/gallery/(\w+\.png)", page))
    drawn = {path.name for path in make_gallery.PICTURES.iterdir()}
    assert shown == drawn


def test_every_law_is_in_the_gallery(page):
    functions = [name for name in vp.profile.__all__ if callable(getattr(vp.profile, name))]
    laws = [name for name in functions if not isinstance(getattr(vp.profile, name), type)]
    assert len(laws) > 10
    assert [name for name in laws if f"`{name}`" not in page] == []


def test_links_within_the_page_lead_to_its_headings(page):
    headings = re.findall(r"^#+ (.*)$", page, re.MULTILINE)
    anchors = {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}
    links = re.findall(r"\]\(#([^)]+)\)", page)
    assert links
    assert [link for link in links if link not in anchors] == []
