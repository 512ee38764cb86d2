"""The examples in docstrings run and give what they say."""

import doctest
import importlib
import pkgutil
import shutil

import mujoco
import pytest

import buoyancy_mj
from buoyancy_mj.scenes import catalog

FINDER = doctest.DocTestFinder(exclude_empty=True)
WITH_FILES = {"buoyancy_mj.loads.coefficients"}
"""Modules whose examples read files that no user has yet; the guide's own are run by test_docs."""

DRIVEN = tuple(
    f"buoyancy_mj.{room}."
    for room in ("vehicle.allocation", "vehicle.control", "vehicle.thrusters", "viz.recorder")
)
"""Where examples are of a vehicle in its water that can be driven."""


def find_examples():
    """Docstrings with examples, by where they stand."""
    for module in pkgutil.walk_packages(buoyancy_mj.__path__, "buoyancy_mj."):
        if module.name.endswith("__main__") or module.name in WITH_FILES:
            continue
        for test in FINDER.find(importlib.import_module(module.name)):
            if test.examples:
                yield pytest.param(test, id=test.name)


EXAMPLES = list(find_examples())


@pytest.fixture
def names(tmp_path, monkeypatch, example):
    """What a reader of an example has: public names, a model, its data and 'vehicle.xml'."""
    driven = example.name.startswith(DRIVEN)
    path = catalog.models()["bluerov2_heavy" if driven else "hourglass"]
    shutil.copytree(path.parent, tmp_path, dirs_exist_ok=True)
    (tmp_path / path.name).rename(tmp_path / "vehicle.xml")
    monkeypatch.chdir(tmp_path)
    spec = mujoco.MjSpec.from_file(str(path))
    if driven:
        spec.body("bluerov2_heavy").add_site(name="stern")
        buoyancy_mj.add_water(spec)
    model = spec.compile()
    public = {name: getattr(buoyancy_mj, name) for name in dir(buoyancy_mj) if name[0] != "_"}
    own = {"mujoco": mujoco, "spec": spec, "model": model, "data": mujoco.MjData(model)}
    return public | own


def test_examples_are_found():
    assert len(EXAMPLES) > 10


@pytest.mark.parametrize("example", EXAMPLES)
def test_the_examples_of_docstrings_are_true(example, names):
    own = importlib.import_module(example.globs["__name__"])
    example.globs = names | vars(own)
    failed, tried = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(example)
    assert (failed, tried > 0) == (0, True)
