"""Run the notebooks of examples/notebooks, and keep in them what their cells show.

    .venv/bin/python scripts/run_notebooks.py [NAME ...]

They need no Jupyter to run: the cells of one share their names, as there. What a cell prints is
kept as text, each figure as a PNG, and the value of its last expression as HTML, where it has
that, or as text.
"""

import argparse
import ast
import base64
import contextlib
import io
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib as mpl

ROOT = Path(__file__).resolve().parent.parent
NOTEBOOKS = {path.stem: path for path in sorted((ROOT / "examples/notebooks").glob("*.ipynb"))}
"""The notebooks by their names."""


def main() -> None:
    """Run those that are asked for, or all."""
    parser = argparse.ArgumentParser(description="Run the notebooks, and keep what they show.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(NOTEBOOKS)}")
    for name in parser.parse_args().names or NOTEBOOKS:
        path = NOTEBOOKS[name]
        notebook = json.loads(path.read_text())
        cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
        for number, (cell, outputs) in enumerate(zip(cells, run(cells), strict=True), 1):
            cell |= {"execution_count": number, "outputs": outputs}
            for output in outputs:
                if output["output_type"] == "execute_result":
                    output["execution_count"] = number
        path.write_text(json.dumps(notebook, indent=1) + "\n")
        print(f"{path.relative_to(ROOT)}: {path.stat().st_size:,} bytes")


def run(cells: list[dict[str, Any]]) -> Iterator[list[dict[str, Any]]]:
    """Run the cells one after the other: what each shows, as a notebook keeps it."""
    mpl.use("agg")
    names: dict[str, Any] = {"__name__": "__main__"}
    for cell in cells:
        tree = ast.parse("".join(cell["source"]))
        last = None
        if tree.body and isinstance(tree.body[-1], ast.Expr):
            last = ast.Expression(tree.body.pop().value)
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            exec(compile(tree, "cell", "exec"), names)
            value = None if last is None else eval(compile(last, "cell", "eval"), names)
        yield [*_text(printed.getvalue()), *_figures(), *_value(value)]


def _text(printed: str) -> Iterator[dict[str, Any]]:
    """What was printed."""
    if printed:
        yield {"output_type": "stream", "name": "stdout", "text": printed.splitlines(True)}


def _figures() -> Iterator[dict[str, Any]]:
    """The figures that were drawn, which are closed."""
    import matplotlib.pyplot as plt

    for number in plt.get_fignums():
        file = io.BytesIO()
        plt.figure(number).savefig(file, dpi=100, metadata={"Software": None})
        picture = {"image/png": base64.b64encode(file.getvalue()).decode()}
        yield {"output_type": "display_data", "metadata": {}, "data": picture}
    plt.close("all")


def _value(value: Any) -> Iterator[dict[str, Any]]:
    """The value of a last expression."""
    if value is not None:
        shown = {"text/plain": repr(value).splitlines(True)}
        if hasattr(value, "_repr_html_"):
            shown["text/html"] = value._repr_html_().splitlines(True)
        yield {"output_type": "execute_result", "metadata": {}, "data": shown}


if __name__ == "__main__":
    main()
