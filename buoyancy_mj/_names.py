"""Public names, and the modules where they are: `from MODULE import NAME as NAME` says both."""

import ast
from pathlib import Path


def read_homes(file: str) -> dict[str, str]:
    """Modules by the public names that a file imports from them.

    Type checkers read the same lines, so no second list can differ from them.
    """
    tree = ast.parse(Path(file).read_text(encoding="utf-8"))
    return {
        alias.name: node.module
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.module
        for alias in node.names
        if alias.asname == alias.name and not alias.name.startswith("_")
    }
