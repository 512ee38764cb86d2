"""What was found of meshes before is the same from the cache, and the cache may be lost."""

import os
import shutil
import subprocess
import sys
import threading
import warnings

import grimp
import mujoco
import numpy as np
import pytest
import trimesh

from buoyancy_mj import (
    Buoyancy,
    Damping,
    JonswapSea,
    MeshError,
    Panels,
    Silhouette,
    Water,
    repair,
)
from buoyancy_mj.hulls import overlaps
from buoyancy_mj.loads import exposure, silhouettes
from buoyancy_mj.meshes import cache, cache_files, cache_version, shapes
from buoyancy_mj.meshes import repair as repairs
from buoyancy_mj.submersion import exact

WAVES = Water(waves=JonswapSea(0.3, 4.0, components=8))


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """The folder of what is kept, of each test alone, in a process that knows nothing yet."""
    monkeypatch.setenv("BUOYANCY_MJ_CACHE", str(tmp_path / "kept"))
    monkeypatch.setattr(cache, "_known", {})
    return tmp_path / "kept" / "meshes"


@pytest.fixture(scope="module")
def model():
    """A body of a ball with a hole, a box through it, two boxes in one mesh, and a capsule."""
    ball = trimesh.creation.icosphere(subdivisions=3, radius=0.5)
    corners = shapes.box((0.1, 0.1, 0.1))
    spec = mujoco.MjSpec()
    spec.add_mesh(name="ball", uservert=ball.vertices.ravel(), userface=ball.faces[1:].ravel())
    twins = np.vstack([corners.vertices, corners.vertices + [0.2, 0.2, 0.0]])
    faces = np.vstack([corners.faces, corners.faces + 8])
    spec.add_mesh(name="twins", uservert=twins.ravel(), userface=faces.ravel())
    body = spec.worldbody.add_body(name="hull")
    body.add_freejoint()
    kind = mujoco.mjtGeom
    body.add_geom(name="ball", type=kind.mjGEOM_MESH, meshname="ball")
    body.add_geom(name="box", type=kind.mjGEOM_BOX, size=(0.7, 0.1, 0.1))
    body.add_geom(name="twins", type=kind.mjGEOM_MESH, meshname="twins", pos=(0.0, 0.0, 0.55))
    body.add_geom(name="mast", type=kind.mjGEOM_CAPSULE, size=(0.05, 0.3, 0.0), pos=(0, 0, 2))
    for mesh in spec.meshes:
        mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
    return spec.compile()


def build(model, damping):
    """What acts on a model, as a list of arrays, and what was told."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        buoyancy = Buoyancy(model, WAVES, damping=damping)
    arrays = list(list_arrays(buoyancy._acting.load_model.arrays))
    names = [hull.name for hull in buoyancy.hulls]
    return arrays, names, [str(one.message) for one in caught]


def list_arrays(value):
    if isinstance(value, tuple):
        for one in value:
            yield from list_arrays(one)
    else:
        yield np.asarray(value)


def check_same(one, two):
    """Check that what acts is the same to the last bit, for all that depends on meshes."""
    assert one[1:] == two[1:]
    assert len(one[0]) == len(two[0])
    for a, b in zip(one[0], two[0], strict=True):
        assert (a.dtype, a.shape, a.tobytes()) == (b.dtype, b.shape, b.tobytes())


def forbid(*_):
    raise AssertionError("it is found anew")


def forbid_all(monkeypatch):
    """From now on nothing is found anew."""
    for place, name in (
        (repairs, "_repair"),
        (overlaps, "_join_hulls"),
        (silhouettes, "_measure"),
        (exposure, "count_windings"),
        (exact, "build_tree"),
        (shapes, "capsule"),
    ):
        monkeypatch.setattr(place, name, forbid)


# the same


@pytest.mark.parametrize("viscous", [Silhouette(), Panels()], ids=["silhouettes", "panels"])
def test_what_acts_is_the_same_from_disk_from_memory_and_without_a_cache(
    model, folder, monkeypatch, viscous
):
    damping = Damping(viscous=viscous)
    # the two boxes, which share an edge, count as what no union takes
    join = overlaps.to_manifold
    monkeypatch.setattr(overlaps, "to_manifold", lambda v, f: None if len(f) == 24 else join(v, f))
    monkeypatch.setenv("BUOYANCY_MJ_CACHE", "")
    without = build(model, damping)
    assert without[1] == ["ball + box", "twins", "mast"]
    assert any("1 hole with 3 edges" in text for text in without[2])
    assert any(text.startswith("geom 'twins': more than two faces") for text in without[2])
    assert not folder.exists()
    cache.forget()
    monkeypatch.setenv("BUOYANCY_MJ_CACHE", str(folder.parent))
    first = build(model, damping)
    check_same(first, without)
    forbid_all(monkeypatch)
    check_same(build(model, damping), without)
    cache.forget()
    check_same(build(model, damping), without)


def test_a_refusal_is_told_again_with_the_name_of_the_mesh_at_hand():
    tub = shapes.box((0.5, 0.5, 0.5))
    told = []
    for name in ("tub", "bath", "tub"):
        with pytest.raises(MeshError) as error:
            repair(tub.vertices, tub.faces[:-2], name)
        told.append(str(error.value))
        cache.forget()
    assert told[0] == told[2] == told[1].replace("bath", "tub", 1)
    assert told[1].startswith("bath: it is open: 1 hole with 4 edges")
    assert told[1].endswith("; close the mesh, or take its convex hull instead")


def test_no_array_of_a_result_can_be_written_to():
    ball = shapes.sphere(0.5)
    for _ in range(2):
        mesh, _ = repair(ball.vertices, ball.faces)
        for array in (mesh.vertices, mesh.faces, mesh.centroid):
            with pytest.raises(ValueError, match="read-only"):
                array[0] = 0
        cache.forget()


# lost, damaged, or nowhere


def damage(path, how):
    content = path.read_bytes()
    if how == "cut":
        path.write_bytes(content[: len(content) // 2])
    elif how == "empty":
        path.write_bytes(b"")
    elif how == "other":
        path.write_text("this is no array")
    else:
        flipped = bytearray(content)
        flipped[len(content) // 2] ^= 16
        path.write_bytes(flipped)


@pytest.mark.parametrize("how", ["cut", "empty", "other", "flipped"])
def test_a_damaged_file_is_made_anew_without_a_word(folder, how):
    ball = shapes.sphere(0.5)
    sound, _ = repair(ball.vertices, ball.faces)
    (path,) = folder.glob("*.npy")
    content = path.read_bytes()
    damage(path, how)
    cache.forget()
    again, _ = repair(ball.vertices, ball.faces)
    assert again.checksum == sound.checksum
    assert path.read_bytes() == content


def test_the_folder_may_be_deleted_at_any_time(folder):
    arrays = {"numbers": np.arange(2000.0), "flags": np.ones((3, 5), bool)}
    done = threading.Event()

    def delete():
        while not done.is_set():
            shutil.rmtree(folder, ignore_errors=True)

    deleting = threading.Thread(target=delete)
    deleting.start()
    try:
        for number in range(200):
            cache_files.write_arrays(folder, b"%d" % (number % 4), arrays)
            read = cache_files.read_arrays(folder, b"%d" % (number % 4))
            if read is not None:
                assert all(np.array_equal(read[name], arrays[name]) for name in arrays)
    finally:
        done.set()
        deleting.join()
    cache_files.write_arrays(folder, b"last", arrays)
    assert cache_files.read_arrays(folder, b"last") is not None


@pytest.mark.parametrize("place", ["file", "nothing", "no home"])
def test_where_nothing_can_be_kept_all_is_found_anew_in_silence(tmp_path, monkeypatch, place):
    if place == "file":
        (tmp_path / "kept").write_text("a file of somebody")
    elif place == "nothing":
        monkeypatch.setenv("BUOYANCY_MJ_CACHE", "")
    else:
        monkeypatch.delenv("BUOYANCY_MJ_CACHE")
        for name in ("HOME", "XDG_CACHE_HOME", "LOCALAPPDATA"):
            monkeypatch.setenv(name, str(tmp_path / "file" / "home"))
        (tmp_path / "file").write_text("where a home would be")
    before = sorted(tmp_path.rglob("*"))
    box = shapes.box((0.5, 0.5, 0.5))
    assert repair(box.vertices, box.faces)[0].volume == pytest.approx(1.0)
    assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.slow
def test_one_process_finds_what_another_has_kept(monkeypatch):
    code = (
        "from buoyancy_mj import repair; from buoyancy_mj.meshes import shapes; "
        "ball = shapes.sphere(0.5); repair(ball.vertices, ball.faces)"
    )
    subprocess.run([sys.executable, "-P", "-c", code], check=True)
    forbid_all(monkeypatch)
    ball = shapes.sphere(0.5)
    assert repair(ball.vertices, ball.faces)[0].volume == pytest.approx(ball.volume, rel=1e-12)


def test_a_file_is_an_array_that_numpy_reads_without_pickles(folder):
    box = shapes.box((0.5, 0.5, 0.5))
    mesh, _ = repair(box.vertices, box.faces)
    (path,) = folder.iterdir()
    record = np.load(path, allow_pickle=False)
    assert np.array_equal(record["vertices"], mesh.vertices)
    assert np.array_equal(record["faces"], mesh.faces)


# versions


def test_the_version_covers_all_the_code_that_finds_what_is_kept():
    package = cache_version._PACKAGE
    named = {path for pattern in cache_version.SOURCES for path in package.glob(pattern)}
    graph = grimp.build_graph("buoyancy_mj")
    for root in (
        "meshes.repair",
        "meshes.shapes",
        "meshes.convex",
        "hulls.overlaps",
        "loads.exposure",
        "loads.silhouettes",
        "meshes.tree",
        "meshes.refinement",
    ):
        name = f"buoyancy_mj.{root}"
        for module in graph.find_upstream_modules(name) | {name}:
            path = package.joinpath(*module.split(".")[1:])
            assert path.with_suffix(".py") in named or path / "__init__.py" in named, module


def test_other_code_reads_nothing_that_was_kept(tmp_path, monkeypatch, folder):
    copy = tmp_path / "package"
    for pattern in cache_version.SOURCES:
        for path in cache_version._PACKAGE.glob(pattern):
            target = copy / path.relative_to(cache_version._PACKAGE)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(path, target)
    find_version = cache_version.find_version.__wrapped__
    old = find_version()
    monkeypatch.setattr(cache_version, "_PACKAGE", copy)
    assert find_version() == old is not None

    # one line more, which this process would not have run
    source = copy / "meshes" / "holes.py"
    source.write_text(source.read_text() + "\n# another way\n")
    os.utime(source, (0, 0))
    new = find_version()
    assert new not in (None, old)
    os.utime(source, (2e10, 2e10))
    assert find_version() is None

    # of one version the other finds nothing, and without one nothing is kept
    box = shapes.box((0.5, 0.5, 0.5))
    for version, count in ((old, 1), (new, 2), (new, 2), (old, 2), (None, 2)):
        cache.forget()
        monkeypatch.setattr(cache, "find_version", lambda version=version: version)
        repair(box.vertices, box.faces)
        assert len(list(folder.iterdir())) == count


def test_a_version_is_known_here():
    assert cache_version.find_version() is not None


# sizes


def test_what_was_not_used_longest_goes_when_the_folder_is_too_large(folder, monkeypatch):
    numbers = {"numbers": np.zeros(20_000)}
    monkeypatch.setattr(cache_files, "MOST", 1_000_000)
    monkeypatch.setattr(cache_files, "_LOOK", 100_000)
    for number in range(6):
        cache_files.write_arrays(folder, b"%d" % number, numbers)
        for path in folder.iterdir():
            status = path.stat()
            os.utime(path, (status.st_atime - 1000, status.st_mtime - 1000))
    # the first is used again, so that the second is the one that was not used longest
    assert cache_files.read_arrays(folder, b"0") is not None
    cache_files.write_arrays(folder, b"6", numbers)
    kept = [n for n in range(7) if cache_files.read_arrays(folder, b"%d" % n) is not None]
    assert kept == [0, 2, 3, 4, 5, 6]


def test_what_is_too_large_for_a_file_is_not_written(folder, monkeypatch):
    monkeypatch.setattr(cache_files, "LARGEST", 1000)
    cache_files.write_arrays(folder, b"large", {"numbers": np.zeros(126)})
    cache_files.write_arrays(folder, b"small", {"numbers": np.zeros(125)})
    assert len(list(folder.iterdir())) == 1


def test_a_process_forgets_what_it_did_not_use_longest(monkeypatch):
    monkeypatch.setenv("BUOYANCY_MJ_CACHE", "")
    form = cache.Form("numbers", lambda value: {"value": value}, lambda arrays: arrays["value"])
    monkeypatch.setattr(cache, "MOST_IN_MEMORY", 3 * 8000)
    found = []

    def recall(number):
        cache.recall(form, (number,), lambda: found.append(number) or np.zeros(1000))

    for number in (0, 1, 2, 0, 3, 0, 2, 1):
        recall(number)
    # 1 was forgotten for 3, and found once more
    assert found == [0, 1, 2, 3, 1]


def test_checksums_tell_kinds_shapes_and_values_apart():
    parts = [
        (1, 2),
        (2, 1),
        (1.0, 2.0),
        ("12",),
        ("1", "2"),
        (b"1", 2),
        (np.zeros(4),),
        (np.zeros((2, 2)),),
        (np.zeros(4, np.int64),),
        (np.zeros((0, 3)),),
        (np.zeros((0, 2)),),
        (),
    ]
    assert len({cache.take_checksum(*some) for some in parts}) == len(parts)
    turned = np.arange(6.0).reshape(2, 3)
    assert cache.take_checksum(turned.T) == cache.take_checksum(turned.T.copy())
