"""The notebooks as pages of the site: mkdocs calls the `on_` functions.

A page has the cells and what is kept of what they showed: texts, figures, values. Nothing is run.
"""

import base64
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

ROOT = Path(__file__).resolve().parent.parent
NOTEBOOKS = sorted((ROOT / "examples" / "notebooks").glob("*.ipynb"))
FOLDER = "notebooks"
"""Where their pages stand."""


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Put the notebooks into the navigation."""
    for entry in config.nav:
        if isinstance(entry, dict) and "Notebooks" in entry:
            entry["Notebooks"] = [f"{FOLDER}/{path.stem}.md" for path in NOTEBOOKS]
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add a page for each notebook, its figures, and the notebook itself."""
    for path in NOTEBOOKS:
        text, figures = read_notebook(path)
        contents = {f"{path.stem}.md": text, path.name: path.read_text()} | figures
        for name, content in contents.items():
            files.append(File.generated(config, f"{FOLDER}/{name}", content=content))
    return files


def on_page_markdown(markdown: str, page: Page, **_: Any) -> str:
    """Lead links to notebooks to the pages that they become."""
    up = "../" * page.file.src_uri.count("/")
    pattern = rf"\]\({re.escape(up)}\.\./examples/notebooks/(\w+)\.ipynb"
    return re.sub(pattern, rf"]({up}{FOLDER}/\1.md", markdown)


def read_notebook(path: Path) -> tuple[str, dict[str, bytes]]:
    """A notebook as a page, and its figures by the names of their files."""
    figures: dict[str, bytes] = {}
    parts = []
    for cell in json.loads(path.read_text())["cells"]:
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(source.replace("](../../docs/", "](../"))
        else:
            parts.append(f"```python\n{source}\n```")
            parts += _shown(cell["outputs"], path.stem, figures)
    parts.append(f"[The notebook itself]({path.name}) runs in Jupyter.")
    return "\n\n".join(parts) + "\n", figures


def _shown(outputs: list[dict[str, Any]], stem: str, figures: dict[str, bytes]) -> Iterator[str]:
    """What a cell showed, in Markdown; its figures are added to `figures`."""
    for output in outputs:
        data = output.get("data", {})
        if "text" in output:
            yield f"```text\n{''.join(output['text'])}```"
        elif "image/png" in data:
            name = f"{stem}_{len(figures) + 1}.png"
            figures[name] = base64.b64decode("".join(data["image/png"]))
            yield f"![A figure that this cell draws]({name})"
        elif "text/html" in data:
            yield "".join(data["text/html"])
        else:
            yield f"```text\n{''.join(data['text/plain'])}\n```"
