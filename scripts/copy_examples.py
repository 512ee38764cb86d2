"""Copy the examples, and what they print, into the pages of the recipes.

    .venv/bin/python scripts/copy_examples.py [NAME ...]

A recipe docs/recipes/NAME.md has two blocks: the code of examples/NAME.py, and what it prints.
Edit the example, run this, and read the page again: its sentences may speak of other numbers.
"""

import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
EXAMPLES = {path.stem: path for path in sorted((ROOT / "examples").glob("*.py"))}
"""The examples by their names."""


def main() -> None:
    """Copy those that are asked for, or all."""
    parser = argparse.ArgumentParser(description="Copy the examples into the pages.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(EXAMPLES)}")
    for name in parser.parse_args().names or EXAMPLES:
        command = [sys.executable, str(EXAMPLES[name])]
        # what an example leaves goes with the folder
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(
                command, check=True, stdout=subprocess.PIPE, text=True, cwd=folder
            )
        page = recipe(name)
        page.write_text(write_blocks(page.read_text(), name, done.stdout))
        print(page.relative_to(ROOT))


def recipe(name: str) -> Path:
    """The page of an example."""
    return ROOT / "docs" / "recipes" / f"{name}.md"


def read_blocks(page: str, name: str) -> tuple[str, str]:
    """The code on a page, and what it says that the code prints."""
    found = re.search(_pattern(name), page, re.DOTALL)
    if found is None:
        raise ValueError(f"the page has no block with the title examples/{name}.py")
    return found[2], found[4]


def write_blocks(page: str, name: str, printed: str) -> str:
    """The page with the code as it is in the file, and with what it prints."""
    read_blocks(page, name)
    code = EXAMPLES[name].read_text()
    return re.sub(
        _pattern(name),
        lambda found: found[1] + code + found[3] + printed + "```\n",
        page,
        flags=re.DOTALL,
    )


def _pattern(name: str) -> str:
    """A block of code with its title, and the next block of text."""
    title = re.escape(f"examples/{name}.py")
    return rf'(```python title="{title}"\n)(.*?)(```\n.*?```text\n)(.*?)```\n'


if __name__ == "__main__":
    main()
