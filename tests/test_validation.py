"""The validation: its page is what its cases find, what fails has its reason, and the command tells."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from buoyancy_mj.cli import app
from buoyancy_mj.validation import report
from buoyancy_mj.validation.case import Case, Row

DOCS = Path(__file__).parents[1] / "docs"
QUICK = (
    "sphere_coefficients",
    "drag_table",
    "added_mass_table",
    "engine_fluid",
    "fixed_cylinder",
    "small_sphere",
    "remus_100",
)


@pytest.mark.parametrize("name", QUICK)
def test_the_page_shows_what_a_case_finds(name):
    page = (DOCS / "validation.md").read_text()
    case = report.CASES[name]
    assert case.source in page
    part = page.split(f"\n## {case.title}\n")[1].split("\n## ")[0]
    for row in case.run():
        line = next(line for line in part.splitlines() if line.startswith(f"| {row.quantity} |"))
        _, published, ours, *_, verdict = (cell.strip() for cell in line.strip("|").split("|"))
        assert float(published) == pytest.approx(row.published, rel=1e-3)
        assert float(ours) == pytest.approx(row.ours, rel=2e-3)
        assert (verdict == "holds") == row.passes


def test_the_page_has_every_case_and_its_pictures():
    page = (DOCS / "validation.md").read_text()
    for name, case in report.CASES.items():
        assert f"## {case.title}\n" in page
        assert f"buoyancy-mj validate --only {name}`" in page
        if case.draw is not None:
            assert (DOCS / report.PICTURES / f"{name}.png").stat().st_size > 1000
    # what fails has its reason
    for part in page.split("\n## ")[1:]:
        case = next(case for case in report.CASES.values() if part.startswith(case.title))
        if "**fails**" in part:
            assert case.reason
            assert case.reason in part


def test_rows_hold_within_what_is_allowed():
    assert Row("a", 2.0, 2.1, 0.06).passes
    assert not Row("a", 2.0, 2.1, 0.04).passes
    assert Row("a", -2.0, -2.1, 0.06).difference == pytest.approx(-0.05)
    assert Row("a", 2.0, 2.1, 0.11, absolute=True).passes
    assert not Row("a", 2.0, float("nan"), 0.11).passes
    assert report.cells(Row("a [m]", 2.0, 2.1, 0.01)) == (
        "a [m]",
        "2",
        "2.1",
        "+5 %",
        "1 %",
        "**fails**",
    )


def test_the_page_is_written_with_its_pictures(tmp_path, monkeypatch):
    from matplotlib.figure import Figure

    def run():
        return [Row("a [m]", 2.0, 2.1, 0.01), Row("b [m]", 2.0, 2.0, 0.01)]

    case = Case("x", "A title", "Somebody 1900", "So.", run, "It is coarse.", Figure)
    monkeypatch.setattr(report, "CASES", {"x": case})
    report.validate(tmp_path)
    page = (tmp_path / "validation.md").read_text()
    assert "1 of 2 rows hold" in page
    assert "1 of 2 fail. It is coarse." in page
    assert (tmp_path / "validation" / "x.png").is_file()


def test_the_command_runs_cases_and_lists_them():
    found = CliRunner().invoke(app, ["validate", "--only", "small_sphere"])
    assert found.exit_code == 0
    assert "2 of 2 rows hold" in found.output
    wrong = CliRunner().invoke(app, ["validate", "--only", "spheres"])
    assert wrong.exit_code != 0
    assert "there is no case 'spheres'" in wrong.output
