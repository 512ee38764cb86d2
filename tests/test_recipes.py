"""The recipes: each example stands on its page as it is, and prints what the page says."""

import importlib.util
import re
import runpy
from pathlib import Path

import pytest

from tests.printed import compare
from tests.scripts import ROOT, script

COPY = script("copy_examples")
PAGES = {path.stem for path in (ROOT / "docs" / "recipes").glob("*.md")} - {"index"}
NEEDS = {"from_capytaine": ("capytaine", "h5netcdf", "xarray")}
"""What some examples import beside what the package itself needs."""


def test_every_example_has_a_page_and_every_page_an_example_and_the_table_has_all():
    assert len(PAGES) > 10
    assert set(COPY.EXAMPLES) == PAGES
    index = COPY.recipe("index").read_text()
    assert sorted(re.findall(r"\((\w+)\.md\) \|$", index, re.MULTILINE)) == sorted(PAGES)
    navigation = re.findall(r"- recipes/(\w+)\.md", (ROOT / "mkdocs.yml").read_text())
    order = re.findall(r"^\| .*\((\w+)\.md\) \|$", index, re.MULTILINE)
    assert navigation == ["index", *order]


@pytest.mark.parametrize("name", sorted(PAGES))
def test_the_code_on_the_page_is_that_of_the_file(name):
    code, _ = COPY.read_blocks(COPY.recipe(name).read_text(), name)
    assert code == COPY.EXAMPLES[name].read_text(), "run scripts/copy_examples.py"


@pytest.mark.parametrize("name", sorted(PAGES))
def test_the_example_prints_what_the_page_says(name, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for module in NEEDS.get(name, ()):
        if importlib.util.find_spec(module) is None:
            pytest.skip(f"'{module}' is not installed")
    runpy.run_path(str(COPY.EXAMPLES[name]))
    printed = capsys.readouterr().out
    _, said = COPY.read_blocks(COPY.recipe(name).read_text(), name)
    compare(printed, said)


def test_an_example_is_short_and_begins_with_its_question():
    for name, path in COPY.EXAMPLES.items():
        code = Path(path).read_text()
        assert code.count("\n") <= 60, name
        assert re.match(r'"""[A-Z][^"]*\?"""\n', code), name
