import re

import pytest

from tests.scripts import ROOT, script

PAGES = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
SHOWN = [
    (page.parent / path).resolve()
    for page in PAGES
    for path in re.findall(r"!\[[^\]]*\]\(([^)#:]+)\)", page.read_text())
]


def test_pages_show_pictures_that_are_there_and_tell_what_they_show():
    assert SHOWN
    assert not [path for path in SHOWN if not path.is_file()]
    for page in PAGES:
        assert "![](" not in page.read_text()


def test_each_picture_that_the_script_makes_is_shown_and_small():
    pictures = script("make_pictures")
    for name in (*pictures.FILMS, *pictures.STILLS, *pictures.RECORDINGS, *pictures.WINDOWS):
        path = ROOT / "docs" / name
        assert path in SHOWN
        assert path.stat().st_size <= pictures.MOST_BYTES


def test_a_picture_that_is_none_is_refused_with_those_that_there_are(monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["make_pictures.py", "nothing.png"])
    with pytest.raises(SystemExit):
        script("make_pictures").main()
    assert "there is no picture 'nothing.png'; there are hero.webp, " in capsys.readouterr().err
