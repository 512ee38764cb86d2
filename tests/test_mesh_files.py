"""Mesh files that MuJoCo does not read, and files that changed."""

import json
import os

import numpy as np
import pytest
import trimesh
from typer.testing import CliRunner

from buoyancy_mj import ModelError
from buoyancy_mj.cli import app
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.scenes import mesh_files
from buoyancy_mj.scenes.specs import compile_spec, read_spec

# a wedge, which shows turns and mirrors
WEDGE = trimesh.convex.convex_hull(
    [[0, 0, 0], [0.4, 0, 0], [0, 0.3, 0], [0, 0, 0.2], [0.4, 0, 0.1]]
)
MODEL = """<mujoco><asset><mesh name="hull" file="{file}" {more}/></asset><worldbody>
<body name="boat"><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
<geom name="hull" type="mesh" mesh="hull"/></body></worldbody></mujoco>"""


def write(folder, file, kind, solid=WEDGE, more=""):
    """A boat whose hull is a file, which is written too."""
    path = folder / "boat.xml"
    path.write_text(MODEL.format(file=file, more=more))
    (folder / file).parent.mkdir(parents=True, exist_ok=True)
    solid.export(folder / file, file_type=kind)
    return path


def read(path):
    """The hull of a boat, in its frame."""
    (hull,) = find_hulls(compile_spec(read_spec(path), path))
    return hull.mesh_in_body


@pytest.mark.parametrize(
    ("file", "kind"),
    [
        ("hull.stl", "stl_ascii"),
        ("HULL.STL", "stl_ascii"),
        ("meshes/hull.ply", "ply"),
        ("hull.off", "off"),
        ("hull.glb", "glb"),
        ("hull.dae", "dae"),
        ("hull.stl", "stl"),
        ("hull.obj", "obj"),
    ],
)
def test_a_mesh_is_the_same_in_every_format(tmp_path, file, kind):
    if kind == "dae":
        pytest.importorskip("collada")
    mesh = read(write(tmp_path, file, kind))
    assert mesh.volume == pytest.approx(WEDGE.volume, rel=1e-6)
    assert mesh.centroid == pytest.approx(WEDGE.center_mass, abs=1e-7)
    assert mesh.bounds == pytest.approx(WEDGE.bounds, abs=1e-7)


def test_scale_and_place_of_a_mesh_stay(tmp_path):
    more = 'scale="2 1 3" refpos=".1 0 0"'
    mesh = read(write(tmp_path, "hull.ply", "ply", more=more))
    assert mesh.volume == pytest.approx(6.0 * WEDGE.volume, rel=1e-6)
    twin = read(write(tmp_path, "hull.stl", "stl", more=more))
    assert mesh.centroid == pytest.approx(twin.centroid, abs=1e-7)
    assert mesh.bounds == pytest.approx(twin.bounds, abs=1e-7)


def test_the_unit_of_a_collada_file_counts(tmp_path):
    pytest.importorskip("collada")
    path = write(tmp_path, "hull.dae", "dae")
    text = (tmp_path / "hull.dae").read_text()
    unit = '<unit name="decimeter" meter="0.1"/><up_axis>'
    (tmp_path / "hull.dae").write_text(text.replace("<up_axis>", unit))
    assert read(path).volume == pytest.approx(1e-3 * WEDGE.volume, rel=1e-6)


def test_parts_of_a_scene_stand_where_it_has_them(tmp_path):
    scene = trimesh.Scene()
    for x in (0.0, 1.0):
        scene.add_geometry(WEDGE, transform=trimesh.transformations.translation_matrix([x, 0, 0]))
    mesh = read(write(tmp_path, "hull.glb", "glb", scene))
    assert mesh.volume == pytest.approx(2.0 * WEDGE.volume, rel=1e-6)
    assert mesh.extents == pytest.approx([1.4, 0.3, 0.2], rel=1e-6)


def test_an_stl_of_more_triangles_than_mujoco_reads_is_read(tmp_path, monkeypatch):
    # with a smaller bound, since the true one takes seconds
    path = write(tmp_path, "hull.stl", "stl")
    monkeypatch.setattr(mesh_files, "_MOST_FACES", 5)
    spec = read_spec(path)
    assert spec.meshes[0].file == ""
    assert compile_spec(spec, path).mesh_facenum.tolist() == [len(WEDGE.faces)]


def test_a_model_that_another_attaches_from_its_folder_is_read_too(tmp_path):
    (tmp_path / "rov").mkdir()
    path = write(tmp_path / "rov", "hull.stl", "stl_ascii")
    path.write_text(path.read_text().replace("<freejoint/>", ""))
    joined = tmp_path / "joined.xml"
    joined.write_text(
        '<mujoco><asset><model name="rov" file="rov/boat.xml"/></asset><worldbody><body>'
        '<freejoint/><attach model="rov" body="boat" prefix="r_"/></body></worldbody></mujoco>'
    )
    assert read(joined).volume == pytest.approx(WEDGE.volume, rel=1e-6)


def test_a_repaired_model_is_written_with_them(tmp_path):
    turned = WEDGE.copy()
    turned.invert()
    path = write(tmp_path, "hull.ply", "ply", turned, more='inertia="shell"')
    out = tmp_path / "out" / "boat.xml"
    assert CliRunner().invoke(app, ["inspect", str(path), "--repair", str(out)]).exit_code == 0
    result = CliRunner().invoke(app, ["inspect", str(out), "--json"])
    (geom,) = json.loads(result.stdout)["geoms"]
    assert geom["volume"] == pytest.approx(WEDGE.volume, rel=1e-5)


@pytest.mark.parametrize(
    ("file", "content", "message"),
    [
        ("hull.ply", "ply\nnonsense", "trimesh cannot read it: "),
        ("hull.stl", "solid hull\nendsolid", "it has no triangle; save the mesh as binary STL or"),
        ("hull.off", "OFF\n1 2", "trimesh cannot read it: "),
        ("hull.glb", "nonsense", "trimesh cannot read it: "),
    ],
)
def test_a_broken_file_is_named(tmp_path, file, content, message):
    path = write(tmp_path, file, "obj")
    (tmp_path / file).write_text(content)
    with pytest.raises(ModelError) as refusal:
        read_spec(path)
    assert str(refusal.value).startswith(f"'{path}' asks for '{file}': {message}")


def test_collada_without_what_reads_it_says_what_to_install(tmp_path, monkeypatch):
    path = write(tmp_path, "hull.dae", "obj")

    def load(_file):
        raise ImportError("missing `pip install pycollada`")

    monkeypatch.setattr(trimesh, "load_scene", load)
    with pytest.raises(ModelError) as refusal:
        read_spec(path)
    assert str(refusal.value) == (
        f"'{path}' asks for 'hull.dae': it needs pycollada, which is not installed: "
        "pip install 'buoyancy_mj[meshes]', or save the mesh as STL or OBJ"
    )


def test_a_format_that_nobody_reads_is_refused_with_those_that_are_read(tmp_path):
    path = write(tmp_path, "hull.stp", "obj")
    with pytest.raises(
        ModelError,
        match=r"no decoder found .*; MuJoCo reads STL, OBJ and MSH, and dae, glb, gltf, off, ply "
        "are read here: save it as STL",
    ):
        compile_spec(read_spec(path), path)


@pytest.mark.parametrize(("file", "kind"), [("hull.obj", "obj"), ("hull.ply", "ply")])
def test_a_file_that_is_written_twice_within_a_second_is_read_twice(tmp_path, file, kind):
    second = 1_700_000_000
    volumes = []
    for number, size in enumerate((1.0, 2.0, 3.0)):
        path = write(tmp_path, file, kind, WEDGE.copy().apply_scale(size))
        # a tenth of a second apart, and long ago
        time = second * 10**9 + number * 10**8
        os.utime(tmp_path / file, ns=(time, time))
        volumes.append(read(path).volume)
    assert volumes == pytest.approx(WEDGE.volume * np.array([1.0, 8.0, 27.0]), rel=1e-6)


def test_so_is_a_height_field(tmp_path):
    path = tmp_path / "bed.xml"
    path.write_text(
        '<mujoco><asset><hfield name="bed" file="bed.bin" size="1 1 1 1"/></asset><worldbody>'
        '<geom type="hfield" hfield="bed"/></worldbody></mujoco>'
    )
    for number, heights in enumerate(([0.0, 1.0, 1.0, 1.0], [1.0, 0.0, 1.0, 1.0])):
        content = np.int32([2, 2]).tobytes() + np.float32(heights).tobytes()
        (tmp_path / "bed.bin").write_bytes(content)
        time = 1_700_000_000 * 10**9 + number
        os.utime(tmp_path / "bed.bin", ns=(time, time))
        assert compile_spec(read_spec(path), path).hfield_data.tolist() == heights


def test_a_file_is_read_once_until_it_changes(tmp_path, monkeypatch):
    path = write(tmp_path, "hull.ply", "ply")
    read(path)
    monkeypatch.setattr(trimesh, "load_scene", None)
    assert read(path).volume == pytest.approx(WEDGE.volume, rel=1e-6)
