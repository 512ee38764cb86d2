"""The files that a page of the documentation has its reader write.

Such a block has a title, the name of its file; where several have the same, the file changes on
the way down the page, and the last is what it ends as.
"""

import re
from pathlib import Path

BLOCK = r'^```\w+ title="([^"/]+)"\n(.*?)^```'


def page_files(page: Path) -> list[tuple[str, str]]:
    """The name and the text of each, in the order of the page."""
    return re.findall(BLOCK, page.read_text(), re.MULTILINE | re.DOTALL)


def write_page_files(page: Path, folder: Path) -> None:
    """Write them as they are at the end of the page."""
    for name, text in page_files(page):
        (folder / name).write_text(text)
