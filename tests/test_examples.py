"""The examples in docstrings run and give what they say."""

import doctest
import importlib
import pkgutil

import pytest

import buoyancy_mj

ROOMS = ("sea", "meshes", "submersion")
MODULES = [
    f"buoyancy_mj.{room}.{module.name}"
    for room in ROOMS
    for module in pkgutil.iter_modules(importlib.import_module(f"buoyancy_mj.{room}").__path__)
]
PUBLIC = {name: getattr(buoyancy_mj, name) for name in dir(buoyancy_mj) if name[0] != "_"}


@pytest.mark.parametrize("module", MODULES)
def test_the_examples_of_docstrings_are_true(module):
    failed, _ = doctest.testmod(
        importlib.import_module(module), globs=dict(PUBLIC), optionflags=doctest.ELLIPSIS
    )
    assert failed == 0
