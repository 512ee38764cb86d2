import importlib.util
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PAGES = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
SHOWN = [
    (page.parent / path).resolve()
    for page in PAGES
    for path in re.findall(r"!\[[^\]]*\]\(([^)#:]+)\)", page.read_text())
]


def load_script():
    spec = importlib.util.spec_from_file_location("pictures", ROOT / "scripts/make_pictures.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_pages_show_pictures_that_are_there_and_tell_what_they_show():
    assert SHOWN
    assert not [path for path in SHOWN if not path.is_file()]
    for page in PAGES:
        assert "![](" not in page.read_text()


def test_each_picture_that_the_script_makes_is_shown_and_small():
    script = load_script()
    for name in (*script.FILMS, *script.STILLS, *script.RECORDINGS, *script.WINDOWS):
        path = ROOT / "docs" / name
        assert path in SHOWN
        assert path.stat().st_size <= script.MOST_BYTES


def test_a_picture_that_is_none_is_refused_with_those_that_there_are(monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["make_pictures.py", "nothing.png"])
    with pytest.raises(SystemExit):
        load_script().main()
    assert "there is no picture 'nothing.png'; there are hero.webp, " in capsys.readouterr().err
