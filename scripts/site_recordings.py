"""Recordings that the site shows live: mkdocs calls the `on_` functions.

A picture of a recording stays the picture that it is, and gets a button that opens the recording
in its place, in Rerun's web viewer. Both come from build/live, which make_recordings.py fills;
without it, and where a page is opened as a file, there is the picture alone.
"""

import re
from pathlib import PurePosixPath
from posixpath import normpath, relpath
from typing import Any

from make_recordings import LIVE
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

VIEWER = "live/viewer/index.html"
BUTTON = "Open the recording here"


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the recordings and the viewer."""
    for path in sorted(LIVE.rglob("*")):
        if path.is_file():
            name = path.relative_to(LIVE.parent).as_posix()
            files.append(File(name, str(LIVE.parent), config.site_dir, use_directory_urls=False))
    return files


def on_page_content(content: str, page: Page, **_: Any) -> str:
    """Give pictures of recordings their button."""
    folder = PurePosixPath(page.file.dest_uri).parent.as_posix()

    def figure(found: re.Match[str]) -> str:
        picture = PurePosixPath(normpath(f"{folder}/{found[1]}"))
        recording = picture.with_suffix(".rrd").as_posix()
        if not (LIVE / recording).is_file():
            return found[0]
        url = relpath(f"live/{recording}", PurePosixPath(VIEWER).parent.as_posix())
        target = f"{relpath(VIEWER, folder)}?url={url}"
        button = f'<button type="button" data-viewer="{target}" hidden>{BUTTON}</button>'
        return f'<span class="recording">{found[0]}{button}</span>'

    return re.sub(r'<img [^>]*?src="([^":]+)"[^>]*>', figure, content)
