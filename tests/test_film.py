"""Films and pictures: what is in a frame, and what becomes of files."""

import errno
import json
import os
import sys

import av
import numpy as np
import pytest
from PIL import Image

from buoyancy_mj import (
    BuoyancyWarning,
    DrawingError,
    JonswapSea,
    LevelOscillation,
    RecordingError,
    RegularWave,
    Simulation,
    Water,
    read_scene,
)
from buoyancy_mj.cli import app
from buoyancy_mj.drawing import film_file
from buoyancy_mj.drawing.classic.graphics import open_gl
from buoyancy_mj.drawing.filament import graphics
from buoyancy_mj.drawing.filament.graphics import open_context
from buoyancy_mj.drawing.film import Film, Still
from buoyancy_mj.drawing.film_file import FilmFile
from buoyancy_mj.drawing.hud import Hud
from buoyancy_mj.drawing.pictures import Pictures
from buoyancy_mj.drawing.sea_state import describe_sea
from buoyancy_mj.scenes import catalog

SIZE = (160, 90)
WHITE = 255


def simulation(*settings, scene="auv_drop_still"):
    return Simulation(read_scene(catalog.scene_path(scene), list(settings)))


@pytest.fixture(scope="module", params=["filament", "classic"])
def renderer(request):
    """A renderer that draws here."""
    try:
        open_gl() if request.param == "classic" else open_context()
    except DrawingError as error:
        pytest.skip(str(error))
    return request.param


def length(path):
    """Number of frames of a film, its time, and the mean brightness of each."""
    with av.open(str(path)) as film:
        frames = [frame.to_ndarray(format="rgb24") for frame in film.decode(video=0)]
        shades = np.array([frame.mean() for frame in frames])
        # a film that is not finished does not say how long it is
        return len(frames), (film.duration or 0) / 1e6, shades


def add_all(film, pictures):
    for picture in pictures:
        film.add(picture)


class Shades:
    """Pictures that cost nothing: each frame has a shade of its own."""

    def __init__(self, size=SIZE):
        self.size, self.name, self.drawn = size, "shades", []

    def follow(self, frame):
        pass

    def draw(self, frame):
        self.drawn.append(frame.time)
        return np.full((self.size[1], self.size[0], 3), 40 + int(60 * frame.time), np.uint8)


# what is in a frame -------------------------------------------------------------------------------


def test_sea_sky_and_vehicle_are_where_they_belong(renderer):
    sim = simulation("start.position=[0,0,-0.1]", "start.roll=0")
    pictures = Pictures(sim, size=SIZE, renderer=renderer, has_hud=False)
    frame = sim.frame()
    shot = pictures.follow(frame)
    pixels = pictures.draw(frame).astype(int)
    ids = pictures._frames.draw(frame.data, shot, frame.centre_of_mass, segments=True)
    is_sea, is_sky = (ids == WHITE).all(axis=2), (ids == 0).all(axis=2)
    is_vehicle = ~is_sea & ~is_sky

    # the sky is above and the sea below, parted by a level horizon
    rows = np.flatnonzero(is_sea.any(axis=1))
    horizon = rows[0]
    assert 0 < horizon < SIZE[1] // 2
    assert is_sky[:horizon][:, 100:].all()
    assert not is_sky[horizon + 1 :].any()
    # the vehicle is in the left third, whole, and cut by the water
    where = np.argwhere(is_vehicle)
    assert where.min() > 0
    assert where[:, 1].mean() == pytest.approx(SIZE[0] / 3.0, abs=12)

    # their colours: the sky is bright, the sea dark and blue, the foam yellow
    sky, sea = pixels[is_sky].mean(axis=0), pixels[is_sea].mean(axis=0)
    assert sky.sum() > 1.2 * sea.sum()
    assert sea[2] > sea[0] + 20
    red, green, blue = np.moveaxis(pixels, 2, 0)
    assert np.count_nonzero((red > 1.6 * blue) & (green > 1.3 * blue) & is_vehicle) > 10


def test_under_water_there_is_haze_and_no_sky(renderer):
    sim = simulation("start.position=[0,0,-8]")
    pictures = Pictures(sim, size=SIZE, renderer=renderer, has_hud=False)
    frame = sim.frame()
    shot = pictures.follow(frame)
    assert shot.eye[2] < 0.0
    pixels = pictures.draw(frame).astype(int)
    ids = pictures._frames.draw(frame.data, shot, frame.centre_of_mass, segments=True)
    is_vehicle = (ids != WHITE).any(axis=2) & (ids != 0).any(axis=2)
    assert is_vehicle.sum() > 100
    water = pixels[~is_vehicle]
    # all around is the colour of water, but for what is blurred along edges
    assert np.mean(water[:, 2] > water[:, 0] + 40) > 0.97
    assert pixels[is_vehicle].std() > water.std(axis=0).max()


def test_the_drawn_waterline_is_that_of_the_water(renderer):
    sim = simulation("duration=1", scene="sphere_decay")
    pictures = Pictures(sim, size=(320, 180), renderer=renderer, has_hud=False)
    frame = sim.frame()
    shot = pictures.follow(frame)
    ids = pictures._frames.draw(frame.data, shot, frame.centre_of_mass, segments=True)
    # the sphere shows from its top down to the nearest point of its waterline, as seen from here
    centre, radius = frame.data.geom_xpos[0], sim.model.geom_rbound[0]
    ring = np.sqrt(radius**2 - centre[2] ** 2)
    ray = shot.eye - centre
    ray[2] = 0.0
    nearest = centre + ring * ray / np.linalg.norm(ray)
    nearest[2] = 0.0
    _, y = shot.project(nearest, 320 / 180)
    row = (1.0 - y) * 90.0
    column = round((1.0 + shot.project(nearest, 320 / 180)[0]) * 160.0)
    is_sphere = (ids[:, column] != WHITE).any(axis=1) & (ids[:, column] != 0).any(axis=1)
    assert np.flatnonzero(is_sphere)[-1] == pytest.approx(row, abs=1.5)


def test_the_text_over_a_picture_is_at_its_edges_and_the_scale_as_long_as_it_says():
    bare = np.full((90, 160, 3), 90, np.uint8)
    written = Hud(SIZE, "still water").write(bare, 3.2, 0.04)
    changed = np.argwhere((written != bare).any(axis=2))
    assert len(changed) > 50
    assert not ((changed[:, 0] > 25) & (changed[:, 0] < 60)).any()
    # 1 m of 4 cm each
    row = written[90 - 9].astype(int).sum(axis=1)
    bar = np.flatnonzero(row[80:] == 3 * WHITE)
    assert bar[-1] - bar[0] == pytest.approx(25, abs=1)


@pytest.mark.parametrize(
    ("water", "text"),
    [
        (Water(), "still water"),
        (Water(waves=RegularWave(0.3, period=2.0)), "waves 0.60 m, 2.0 s"),
        (Water(waves=LevelOscillation(0.1, 0.5)), "level up and down 0.20 m, 2.0 s"),
        (Water(waves=JonswapSea(0.3, peak_period=3.5)), "Hs 0.30 m, Tp 3.5 s"),
        (Water(current=(0.3, 0.4, 0.0)), "still water, current 0.5 m/s"),
        (
            Water(waves=(RegularWave(0.1, period=2.0), RegularWave(0.1, period=4.0))),
            "Hs 0.40 m, Tm 2.7 s",
        ),
    ],
)
def test_the_sea_is_told_in_a_few_words(water, text):
    assert describe_sea(water) == text


# films --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("end", [".mp4", ".gif", ".webp"])
def test_a_film_decodes_to_its_length(end, tmp_path):
    sim = simulation("duration=1", "record_rate=20")
    film = Film(sim, Shades(), tmp_path / f"film{end}", fps=20)
    for frame in sim.frames():
        film.add(frame)
    path = film.close()
    assert path == tmp_path / f"film{end}"
    assert os.listdir(tmp_path) == [path.name]
    if end == ".mp4":
        count, time, shades = length(path)
        assert time == pytest.approx(21 / 20, abs=0.02)
    else:
        shades = []
        with Image.open(path) as picture:
            assert picture.info["loop"] == 0
            for row in range(picture.n_frames):
                picture.seek(row)
                shade = np.asarray(picture.convert("RGB")).mean()
                # one that is like the one before it lasts longer in its place
                shades += round(picture.info["duration"] / 50) * [shade]
        count = len(shades)
    assert count == 21
    assert np.array(shades) == pytest.approx(40.0 + 60.0 * np.arange(21) / 20.0, abs=6.0)


def test_a_film_by_the_command_shows_something(renderer, tmp_path, capsys):
    video, still = tmp_path / "a.mp4", tmp_path / "a.png"
    arguments = [
        "run", "auv_waves", "--duration", "0.2", "--no-record", "--video", str(video),
        "--screenshot", str(still), "--at", "0.1", "--size", "160x90", "--renderer", renderer,
        "--json",
    ]  # fmt: skip
    app(arguments, standalone_mode=False)
    values = json.loads(capsys.readouterr().out)
    assert (values["video"], values["screenshot"]) == (str(video), str(still))
    count, _, shades = length(video)
    assert count == 7
    assert shades.min() > 40.0
    with Image.open(still) as picture:
        assert picture.size == SIZE


def test_a_film_leaves_the_numbers_of_a_run_as_they_are(tmp_path):
    ends = []
    for is_filmed in (False, True):
        sim = simulation("duration=0.5")
        film = Film(sim, Shades(), tmp_path / "a.mp4") if is_filmed else None
        for frame in sim.frames():
            if film is not None:
                film.add(frame)
        ends.append(sim.data.qpos.tobytes() + sim.data.qvel.tobytes())
        if film is not None:
            film.close()
    assert ends[0] == ends[1]


def test_pictures_repeat_where_frames_are_rare(tmp_path):
    sim, shades = simulation("duration=1", "record_rate=5"), Shades()
    film = Film(sim, shades, tmp_path / "a.mp4", fps=20)
    for frame in sim.frames():
        film.add(frame)
    assert length(film.close())[0] == 21
    assert len(shades.drawn) == 6


def test_a_film_that_broke_off_plays_and_is_gone_on_with(tmp_path):
    path = tmp_path / "a.mp4"
    whole = Film(simulation("duration=1"), Shades(), tmp_path / "whole.mp4")
    sim = simulation("duration=1")
    broken = Film(sim, Shades(), path)
    for frame in sim.frames():
        whole.add(frame)
        if frame.time < 0.5:
            broken.add(frame)
    whole_path = whole.close()
    partial = broken.close(complete=False)
    assert partial == tmp_path / "a.partial.mkv"
    assert not path.exists()
    assert length(partial)[0] == 15

    sim, shades = simulation("duration=1"), Shades()
    again = Film(sim, shades, path)
    assert again.kept == pytest.approx(0.5)
    for frame in sim.frames():
        again.add(frame)
    assert min(shades.drawn) >= 0.5
    assert again.close() == path
    assert sorted(os.listdir(tmp_path)) == ["a.mp4", "whole.mp4"]
    (count, time, brightness), other = length(path), length(whole_path)
    assert (count, time) == other[:2]
    assert brightness == pytest.approx(other[2], abs=2.0)


def test_a_film_that_was_cut_in_a_picture_is_gone_on_with(tmp_path):
    film = FilmFile(tmp_path / "a.mp4", SIZE, 30, "mark")
    noise = np.random.default_rng(0).integers(0, 255, (40, SIZE[1], SIZE[0], 3), np.uint8)
    add_all(film, noise)
    partial = film.close(complete=False)
    whole = partial.read_bytes()
    partial.write_bytes(whole[: len(whole) // 2 + 7])
    again = FilmFile(tmp_path / "a.mp4", SIZE, 30, "mark")
    assert 10 < again.kept < 30
    while again.count < 40:
        again.add(noise[again.count])
    assert length(again.close(complete=True))[0] == 40


def test_a_film_of_another_run_is_not_gone_on_with(tmp_path):
    first = Film(simulation("duration=1"), Shades(), tmp_path / "a.mp4")
    sim = simulation("duration=1")
    first.add(sim.frame())
    left = first.close(complete=False)
    other = Film(simulation("duration=1", "start.roll=0.1"), Shades(), tmp_path / "a.mp4")
    assert other.kept == 0.0
    other.discard()
    assert left.exists()


def leave_a_film(path, size=SIZE, count=10):
    """Pictures that a run which was killed has left under the name of a film."""
    film = FilmFile(path, size, 30, "mark")
    add_all(film, np.full((count, size[1], size[0], 3), 90, np.uint8))
    return film.close(complete=False)


def test_a_film_of_another_kind_is_not_gone_on_with(tmp_path):
    left = leave_a_film(tmp_path / "a.mp4")
    other = FilmFile(tmp_path / "a.gif", SIZE, 30, "mark")
    assert other.kept == 0
    other.discard()
    assert left.exists()


def test_a_film_that_is_being_drawn_is_not_taken_over(tmp_path):
    leave_a_film(tmp_path / "a.mp4")
    first = FilmFile(tmp_path / "a.mp4", SIZE, 30, "mark")
    with pytest.raises(RecordingError) as caught:
        FilmFile(tmp_path / "a.mp4", SIZE, 30, "mark")
    place = tmp_path / "a.partial-2.mkv"
    assert str(caught.value) == (
        f"another run is writing '{place}'; choose another place (--video)"
    )
    assert first.close(complete=True) == tmp_path / "a.mp4"
    assert os.listdir(tmp_path) == ["a.mp4"]


def test_a_film_that_broke_off_stays_where_the_next_run_never_begins(tmp_path):
    leave_a_film(tmp_path / "a.mp4")
    never = FilmFile(tmp_path / "a.mp4", SIZE, 30, "mark")
    assert never.kept == 10
    never.discard()
    again = FilmFile(tmp_path / "a.mp4", SIZE, 30, "mark")
    assert again.kept == 10
    again.close(complete=True)
    assert os.listdir(tmp_path) == ["a.mp4"]


def test_a_film_with_brackets_in_its_name_is_gone_on_with(tmp_path):
    leave_a_film(tmp_path / "a[1].mp4")
    again = FilmFile(tmp_path / "a[1].mp4", SIZE, 30, "mark")
    assert again.kept == 10
    again.discard()


def test_a_full_disk_ends_a_film_that_plays(tmp_path, monkeypatch):
    film = FilmFile(tmp_path / "a.mp4", SIZE, 30, "mark")
    noise = np.random.default_rng(0).integers(0, 255, (60, SIZE[1], SIZE[0], 3), np.uint8)
    real, room = os.write, 300_000

    def write(descriptor, piece):
        nonlocal room
        room -= len(piece)
        if room < 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        return real(descriptor, piece)

    monkeypatch.setattr(os, "write", write)
    with pytest.raises(RecordingError) as caught:
        add_all(film, noise)
    partial = tmp_path / "a.partial.mkv"
    seconds = f"{film.count / 30:.2f}"
    assert str(caught.value) == (
        f"the film ends after {seconds} s: No space left on device; what there is plays, "
        f"'{partial}'; make room, and the same command goes on with it"
    )
    assert film.closed
    monkeypatch.undo()
    assert 5 < length(partial)[0] <= film.count


def test_a_picture_is_a_png(tmp_path):
    with pytest.raises(RecordingError) as caught:
        Still(Shades(), tmp_path / "a.jpg")
    assert str(caught.value) == f"the picture is '{tmp_path}/a.jpg'; its name ends in .png"


def test_a_picture_that_cannot_be_written_is_refused_before_the_run(tmp_path):
    (tmp_path / "folder.png").mkdir()
    (tmp_path / "file").touch()
    for name in ("folder.png", "file/a.png"):
        with pytest.raises(RecordingError, match=r"cannot write .*; choose another place"):
            Still(Shades(), tmp_path / name)


def test_the_last_frame_is_the_picture_where_no_time_is_given(tmp_path):
    sim, shades = simulation("duration=0.3"), Shades()
    still = Still(shades, tmp_path / "a.png")
    for frame in sim.frames():
        still.add(frame)
    assert shades.drawn == []
    assert still.close() == tmp_path / "a.png"
    assert shades.drawn == [pytest.approx(0.3)]


# what cannot be -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "size", "fps", "message"),
    [
        (
            "a.avi", SIZE, 30,
            "the film is '{}/a.avi', and its name does not end as a film's; possible: .gif, .mp4, "
            ".webp",
        ),
        (
            "a.mp4", (161, 90), 30,
            "the size is 161x90, and MP4 takes even numbers of pixels; take 162x90",
        ),
        (
            "a.gif", SIZE, 60,
            "fps is 60, and a GIF shows 50 pictures in a second at most; take 50 or less",
        ),
        ("a.mp4", SIZE, 0, "fps is 0; it must be a whole number from 1 to 240"),
    ],
)  # fmt: skip
def test_a_film_that_cannot_be_is_refused(name, size, fps, message, tmp_path):
    with pytest.raises(RecordingError) as caught:
        Film(simulation(), Shades(size), tmp_path / name, fps)
    assert str(caught.value) == message.format(tmp_path)
    assert os.listdir(tmp_path) == []


def test_without_the_encoder_the_extra_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "av", None)
    monkeypatch.delitem(sys.modules, "buoyancy_mj.drawing.film_file")
    with pytest.raises(RecordingError) as caught:
        Film(simulation(), Shades(), tmp_path / "a.mp4")
    assert str(caught.value) == (
        "a film needs av, which is not installed: pip install 'buoyancy_mj[video]'"
    )
    assert film_file is not None


def test_unknown_renderers_and_sizes_are_refused():
    sim = simulation()
    with pytest.raises(DrawingError) as caught:
        Pictures(sim, renderer="filement")
    assert str(caught.value) == (
        "there is no renderer 'filement'; did you mean 'filament'? possible: classic, filament"
    )
    with pytest.raises(DrawingError) as caught:
        Pictures(sim, size=(8, 90))
    assert str(caught.value) == "the width is 8; it must be a whole number from 16 to 8192"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--video", "a.mp4", "--size", "big"],
         "--size is 'big'; write WIDTHxHEIGHT in pixels, as in 1280x720"),
        (["--at", "1"], "--at is given without --screenshot; give both"),
        (["--fps", "30"], "--fps is given without --video; give both"),
        (["--no-hud"], "--no-hud is given without --video and --screenshot; give one of them"),
        (["--screenshot", "a.png", "--at", "30"],
         "--at is 30, and the scene lasts from 0 to 8 s; take a time in it"),
        (["--screenshot", "a.jpg"], "--screenshot is 'a.jpg'; a picture's name ends in .png"),
    ],
)  # fmt: skip
def test_flags_that_make_no_sense_are_refused(arguments, message, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit):
        app(["run", "auv_drop_still", "--no-record", *arguments])
    assert capsys.readouterr().err == f"error: {message}\n"
    assert os.listdir(tmp_path) == []


def test_without_vulkan_the_classic_renderer_draws_and_says_why(monkeypatch):
    try:
        open_gl()
    except DrawingError as error:
        pytest.skip(str(error))
    monkeypatch.setattr(graphics, "count_devices", lambda: 0)
    sim = simulation()
    with pytest.warns(BuoyancyWarning, match="^the classic renderer draws: Filament draws through"):
        pictures = Pictures(sim, size=SIZE, has_hud=False)
    assert pictures.draw(sim.frame()).std() > 10.0


def test_without_graphics_both_renderers_say_what_to_install(monkeypatch):
    monkeypatch.setattr(graphics, "count_devices", lambda: 0)
    monkeypatch.setattr("ctypes.util.find_library", lambda _: None)
    for name in ("MUJOCO_GL", "DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    sim = simulation()
    vulkan = (
        "Filament draws through Vulkan, and there is none here; install a driver, which may be one "
        "for the processor alone (apt install libvulkan1 mesa-vulkan-drivers), or draw with the "
        "classic renderer"
    )
    gl = (
        "the classic renderer draws through OpenGL, and there is none here: neither EGL nor OSMesa "
        "nor a display; install EGL or OSMesa (apt install libegl1 libgl1-mesa-dri, or libosmesa6)"
    )
    for name, message in (
        ("filament", vulkan),
        ("classic", gl),
        (None, f"nothing can draw here: {vulkan}; {gl}"),
    ):
        with pytest.raises(DrawingError) as caught:
            Pictures(sim, size=SIZE, renderer=name)
        assert str(caught.value) == message


@pytest.mark.skipif(sys.platform != "linux", reason="GLFW needs a display on Linux alone")
def test_glfw_without_a_display_is_refused(monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "glfw")
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    with pytest.raises(DrawingError, match="MUJOCO_GL=glfw needs a display"):
        open_gl()
