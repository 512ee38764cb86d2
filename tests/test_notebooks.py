"""The notebooks run, and print what is kept in them."""

import json

import pytest

from tests.printed import compare
from tests.scripts import ROOT, script

NAMES = [path.stem for path in sorted((ROOT / "examples" / "notebooks").glob("*.ipynb"))]


def read(name):
    return json.loads((ROOT / "examples" / "notebooks" / f"{name}.ipynb").read_text())


def texts(outputs):
    return "".join("".join(output["text"]) for output in outputs if "text" in output)


def test_there_are_three():
    assert len(NAMES) == 3


@pytest.mark.parametrize("name", NAMES)
def test_a_notebook_runs_and_shows_what_is_kept_in_it(name):
    pytest.importorskip("matplotlib", reason="the extra 'charts' is not installed")
    cells = [cell for cell in read(name)["cells"] if cell["cell_type"] == "code"]
    shown = list(script("run_notebooks").run(cells))
    for outputs, cell in zip(shown, cells, strict=True):
        kinds = [output["output_type"] for output in outputs]
        assert kinds == [output["output_type"] for output in cell["outputs"]]
        compare(texts(outputs), texts(cell["outputs"]))


@pytest.mark.parametrize("name", NAMES)
def test_a_notebook_is_kept_as_it_ran_from_top_to_bottom(name):
    counts = [each["execution_count"] for each in read(name)["cells"] if "execution_count" in each]
    assert counts == list(range(1, len(counts) + 1))


def test_what_a_cell_shows_is_its_print_its_figures_and_its_last_value():
    pytest.importorskip("matplotlib", reason="the extra 'charts' is not installed")
    code = "import matplotlib.pyplot as plt\nprint('said')\nplt.plot([1, 2])\n6 * 7"
    (outputs,) = script("run_notebooks").run([{"source": [code]}])
    assert outputs[0]["text"] == ["said\n"]
    assert "image/png" in outputs[1]["data"]
    assert outputs[2]["data"] == {"text/plain": ["42"]}
