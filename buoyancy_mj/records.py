"""Classes that hold values, and what shows their fields.

In: dataclasses with a docstring under each field, classes whose attributes should stay.
Out: docstrings with those fields, attributes that cannot be assigned.
May import: nothing of this package.
"""

import ast
import dataclasses
import functools
import inspect
import itertools
import sys
import textwrap
from pathlib import Path
from typing import Any, NoReturn


def field_docs(cls: type) -> dict[str, str]:
    """The docstrings under the fields of a dataclass, by field, inherited ones first."""
    docs: dict[str, str] = {}
    for base in reversed(cls.__mro__):
        docs |= _docs_of_class(base.__module__, base.__name__)
    return {field.name: docs[field.name] for field in dataclasses.fields(cls) if field.name in docs}


def show_fields(cls: type) -> None:
    """Add the fields of a dataclass, with their docstrings, to what `help(cls)` shows.

    The source is read when somebody first asks for the docstring, so that imports stay fast.
    """
    cls.__doc__ = _DocWithFields(inspect.cleandoc(cls.__doc__ or ""))  # type: ignore[assignment]


class ReadOnly:
    """A base class of objects whose public attributes are set once, in `__init__`.

    A subclass calls `_seal` at the end of `__init__`, with a sentence that says what to do instead,
    and with itself: classes under it may add attributes of their own.

    Raises:
        AttributeError: a public attribute is assigned or deleted afterwards.
    """

    _instead = ""
    """What to do instead of assigning; empty until the object is sealed."""
    _sealed: frozenset[str] = frozenset()
    """Attributes that the object had when it was sealed."""
    _sealed_by: type | None = None
    """The class that sealed it."""

    def _seal(self, instead: str, by: type) -> None:
        """Refuse to assign any public attribute from now on.

        Args:
            instead: what to do instead, as a clause.
            by: the class that calls this; classes under it may still add attributes.
        """
        self._instead = instead
        self._sealed = frozenset(vars(self))
        self._sealed_by = by

    def __setattr__(self, name: str, value: Any) -> None:
        is_added = type(self) is not self._sealed_by and name not in self._sealed
        if self._instead and not name.startswith("_") and not is_added:
            self._refuse(name)
        super().__setattr__(name, value)

    def __delattr__(self, name: str) -> None:
        if not name.startswith("_"):
            self._refuse(name)
        super().__delattr__(name)

    def _refuse(self, name: str) -> NoReturn:
        raise AttributeError(
            f"'{name}' of a {type(self).__name__} cannot be changed, since it would change "
            f"nothing; {self._instead}"
        )


class _DocWithFields:
    """The docstring of a dataclass with its fields, made when it is first read."""

    def __init__(self, summary: str) -> None:
        self._summary = summary

    def __get__(self, _: object, owner: type) -> str:
        docs = field_docs(owner)
        lines = []
        for field in dataclasses.fields(owner):
            if field.init and not field.name.startswith("_"):
                text = " ".join(docs.get(field.name, "").split())
                lines.append(textwrap.indent(f"{field.name}: {text}", "    "))
        return "\n".join([self._summary, "", "Fields:", *lines])


@functools.cache
def _docs_of_class(module: str, name: str) -> dict[str, str]:
    """The docstrings under the fields of a class that stands in a module's own file."""
    file = getattr(sys.modules.get(module), "__file__", None)
    if file is None or not file.endswith(".py"):
        return {}
    for node in ast.parse(Path(file).read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ClassDef) and node.name == name:
            return _docs_under_fields(node)
    return {}


def _docs_under_fields(node: ast.ClassDef) -> dict[str, str]:
    """The text under each field of a class, where one stands."""
    docs = {}
    for field, doc in itertools.pairwise(node.body):
        if (
            isinstance(field, ast.AnnAssign)
            and isinstance(field.target, ast.Name)
            and isinstance(doc, ast.Expr)
            and isinstance(doc.value, ast.Constant)
            and isinstance(doc.value.value, str)
        ):
            docs[field.target.id] = inspect.cleandoc(doc.value.value)
    return docs
