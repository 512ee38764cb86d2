"""The validation: the page shows what the cases compute, failures have a reason, the command works.

Each case runs by itself, those that take seconds as slow tests. Together they check every verdict
on the page, so that the counts of rows that hold follow from the page, there and elsewhere.
"""

import re
from pathlib import Path

import pytest
from matplotlib.figure import Figure
from typer.testing import CliRunner

from buoyancy_mj import Buoyancy
from buoyancy_mj.cli import app
from buoyancy_mj.validation import report
from buoyancy_mj.validation.case import Case, Row

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "validation.md"
SLOW = ("long_waves", "stokes_drift")
"""Cases that run for seconds."""
LONG = ("sphere_response", "added_mass_table")
"""Cases that run longer."""
MARKS = dict.fromkeys(SLOW, pytest.mark.slow) | dict.fromkeys(LONG, pytest.mark.long)


def read_sections():
    """Sections of the page by the names of their cases."""
    _, *sections = re.split(r"^## ", PAGE.read_text(), flags=re.MULTILINE)
    return {re.search(r"--only (\w+)`$", text.strip())[1]: text for text in sections}


def read_rows(section):
    """Rows of the table of a section, cell by cell."""
    _, _, *lines = re.findall(r"^\| (.*) \|$", section, flags=re.MULTILINE)
    return [line.split(" | ") for line in lines]


# the page


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=MARKS.get(name, ()), id=name) for name in report.CASES],
)
def test_the_page_shows_what_a_case_computes(name, monkeypatch):
    # what acts in its runs, unless another test has run it before
    acting, begin = set(), Buoyancy.__init__

    def note(self, *args, **options):
        begin(self, *args, **options)
        # where nothing is viscous, drag is a row of zeros
        damping = self.settings.damping
        acting.update(c for c in self.causes if c != "drag" or damping.viscous is not None)

    monkeypatch.setattr(Buoyancy, "__init__", note)
    rows = report.CASES[name].run()
    if acting:
        assert {load.partition(":")[0] for load in report.CASES[name].loads} == acting
    cells = read_rows(read_sections()[name])
    assert len(cells) == len(rows)
    for row, (quantity, published, computed, _, tolerance, verdict) in zip(
        rows, cells, strict=True
    ):
        expected = report.format_row(row)
        assert (quantity, published, tolerance) == (expected[0], expected[1], expected[4])
        # one unit in the fourth digit, which another processor may round otherwise
        assert float(computed) == pytest.approx(row.computed, rel=1e-3), quantity
        assert verdict == expected[5], quantity


def test_counts_of_rows_that_hold_are_those_of_the_page():
    rows = [row for section in read_sections().values() for row in read_rows(section)]
    expected = (str(sum(row[-1] == "holds" for row in rows)), str(len(rows)))
    assert set(re.findall(r"(\d+) of (\d+) rows hold", PAGE.read_text())) == {expected}
    for path in (ROOT / "README.md", *(ROOT / "docs").rglob("*.md")):
        for counts in re.findall(r"(\d+)\s+of\s+(?:its\s+)?(\d+)\s+rows\s+hold", path.read_text()):
            assert counts == expected, path


def test_the_page_has_every_case_and_its_picture():
    sections = read_sections()
    assert list(sections) == list(report.CASES)
    for name, section in sections.items():
        case = report.CASES[name]
        assert section.startswith(f"{case.title}\n")
        assert f"Published: {case.source}." in section
        assert f"Here: {case.setup}" in section
        assert ("Acting: " in section) == bool(case.loads)
        if case.draw is not None:
            assert f"![{case.title}]({report.PICTURES}/{name}.png)" in section
            assert (PAGE.parent / report.PICTURES / f"{name}.png").stat().st_size > 1000


def test_what_fails_has_its_reason():
    for name, section in read_sections().items():
        rows = read_rows(section)
        failing = sum(row[-1] == "**fails**" for row in rows)
        if failing:
            reason = report.CASES[name].reason
            assert reason
            assert f"\n{failing} of {len(rows)} fail. {reason}\n" in section


# rows, and how they are written


def test_rows_hold_within_what_is_allowed():
    assert Row("a", 2.0, 2.1, 0.06).holds
    assert not Row("a", 2.0, 2.1, 0.04).holds
    assert Row("a", -2.0, -2.1, 0.06).difference == pytest.approx(-0.05)
    assert Row("a", 2.0, 2.1, 0.11, absolute=True).holds
    assert not Row("a", 2.0, float("nan"), 0.11).holds
    assert report.format_row(Row("a [m]", 2.0, 2.1, 0.01)) == (
        "a [m]",
        "2",
        "2.1",
        "+5 %",
        "1 %",
        "**fails**",
    )


def test_a_section_says_which_loads_act():
    def run():
        return [Row("a [m]", 2.0, 2.0, 0.01)]

    case = Case("x", "T", "S", "So.", run, loads=("buoyancy", "added_mass", "drag: estimated"))
    assert "\nActing: buoyancy, added mass, drag (estimated).\n" in report._render_case(case, run())
    assert "Acting" not in report._render_case(Case("x", "T", "S", "So.", run), run())


def test_the_page_is_written_with_its_pictures(tmp_path, monkeypatch):
    def run():
        return [Row("a [m]", 2.0, 2.1, 0.01), Row("b [m]", 2.0, 2.0, 0.01)]

    case = Case("x", "A title", "Somebody 1900", "So.", run, "It is coarse.", Figure)
    monkeypatch.setattr(report, "CASES", {"x": case})
    report.validate(tmp_path)
    page = (tmp_path / "validation.md").read_text()
    assert "1 of 2 rows hold" in page
    assert "1 of 2 fail. It is coarse." in page
    assert (tmp_path / "validation" / "x.png").is_file()


# the command


def test_the_command_runs_cases_and_lists_them():
    result = CliRunner().invoke(app, ["validate", "--only", "small_sphere"])
    assert result.exit_code == 0
    assert "2 of 2 rows hold" in result.output
    told = CliRunner().invoke(app, ["validate", "--only", "small_sphere", "--out", "pages"])
    assert told.exit_code == 1
    assert told.stderr == (
        "error: --out is 'pages', and its page holds all cases; leave out --only, or --out\n"
    )

    wrong = CliRunner().invoke(app, ["validate", "--only", "spheres"])
    assert wrong.exit_code != 0
    assert "there is no case 'spheres'" in wrong.output
