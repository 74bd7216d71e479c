"""Renderings: what is in the picture, where the camera stands, how many frames a movie has."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from birm3d import Barrier, Result, Simulation, Vehicle, rendering, scenes
from birm3d.barrier.kinds import RigidWall
from birm3d.rendering import stage as stage_module
from birm3d.rendering.camera import VIEWS, driver_camera, outside_camera
from birm3d.rendering.stills import with_slider
from birm3d.result.skin import skins_at
from PIL import Image

SIZE = (240, 136)


@pytest.fixture(scope="module", autouse=True)
def _drawing() -> None:
    try:
        stage_module._check_drawing()
    except RuntimeError as error:
        pytest.skip(str(error))


@pytest.fixture(scope="module")
def result() -> Result:
    car = Vehicle.preset("passenger_car", mesh_density=0.15)
    return Simulation(car, Barrier.rigid_wall(), 26.7, 24.0).run(frames=7)


def share(picture: np.ndarray, condition: np.ndarray) -> float:
    return float(condition.sum()) / (picture.shape[0] * picture.shape[1])


def reds(picture: np.ndarray) -> np.ndarray:
    """Where the picture is as red as crushed skin, left of the bar of colours."""
    r, g, b = (picture[:, : int(0.85 * picture.shape[1]), i].astype(int) for i in range(3))
    return (r > 100) & (r > 1.6 * g) & (r > 1.6 * b)


def test_one_picture(result: Result) -> None:
    picture = result.render(0.0, size=SIZE)
    assert picture.shape == (136, 240, 3)
    assert picture.dtype == np.uint8
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 200
    # The wheels, almost black, and the barrier's grey-brown.
    assert 0.0005 < share(picture, (picture < 60).all(axis=-1)) < 0.1
    spread = np.ptp(picture.astype(int), axis=-1)
    assert share(picture, (spread < 25) & (picture.max(axis=-1) > 110) & (picture.max(axis=-1) < 190)) > 0.05


def test_pictures_of_several_instants(result: Result, tmp_path: Path) -> None:
    times = [0.0, 0.1, 0.29]
    end = result.render(tmp_path / "end.png", size=SIZE)  # a path alone, as animate takes it
    assert end.shape == (SIZE[1], SIZE[0], 3)
    assert (tmp_path / "end.png").read_bytes().startswith(b"\x89PNG")
    with pytest.raises(ValueError, match="path must be given once"):
        result.render("a.png", "b.png")
    pictures = result.render(times, tmp_path / "strip.png", size=SIZE)
    assert pictures.shape == (3, 136, 240, 3)
    with Image.open(tmp_path / "strip.png") as image:
        assert image.size == (240, 3 * 136)
        assert np.array_equal(np.asarray(image), np.vstack(list(pictures)))
    assert np.mean(pictures[0] != pictures[1]) > 0.02
    assert np.mean(pictures[1] != pictures[2]) > 0.02
    # Crush is red, and there is none at the start.
    assert not reds(pictures[0]).any()
    assert reds(pictures[2]).sum() > 5  # measured: 10 pixels


def test_same_picture_again(result: Result) -> None:
    """With other instants before it, and from frames that are taken when they are asked for."""
    with rendering.Stage(result, [0.0, 0.1], size=SIZE) as stage:
        stage.move_to(1)
        stage.move_to(0)
        first = stage.picture()
        stage.move_to(1)
        stage.picture()
        stage.move_to(0)
        assert np.array_equal(stage.picture(), first)


@pytest.mark.parametrize("color", ["zone", "plain"])
def test_colors(result: Result, color: rendering.Color) -> None:
    picture = result.render(0.29, size=SIZE, color=color)
    assert picture.std() > 10.0
    assert np.mean(picture != result.render(0.29, size=SIZE)) > 0.02


def test_views_differ(result: Result) -> None:
    pictures = [result.render(0.1, size=SIZE, view=view) for view in VIEWS]
    for i, one in enumerate(pictures):
        assert one.std() > 10.0
        for other in pictures[:i]:
            assert np.mean(one != other) > 0.1


@pytest.mark.parametrize("view", VIEWS[:-1])
@pytest.mark.parametrize("angle", [24.0, 90.0, 150.0])
def test_outer_cameras_see_everything(view: rendering.View, angle: float) -> None:
    """Projected by hand, all points are inside the picture, less the share that is kept free, and fill it."""
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    result = Simulation(car, Barrier.rigid_wall(heading=40.0), 15.0, angle, duration=0.05).run()
    points = np.vstack([skin.world for units in skins_at(result, [0.0, 0.05]) for skin in units])
    aspect, taken = 16.0 / 9.0, 0.12
    camera = outside_camera(result, view, points, aspect, taken)
    ahead = camera.target - camera.place
    ahead /= np.linalg.norm(ahead)
    up = camera.up - (camera.up @ ahead) * ahead
    up /= np.linalg.norm(up)
    offsets = (points - camera.place) @ np.stack([np.cross(ahead, up), up, ahead]).T
    depth = offsets[:, 2] * np.tan(np.radians(0.5 * camera.angle))
    scale = depth if camera.half_height is None else np.full_like(depth, camera.half_height)
    x, y = offsets[:, 0] / scale / aspect, offsets[:, 1] / scale
    assert offsets[:, 2].min() > 0.0
    assert np.abs(y).max() < 1.0
    assert x.min() > -1.0
    assert x.max() < 1.0 - 2.0 * taken
    assert max(np.ptp(x) / (1.0 - taken), np.ptp(y)) > 1.0  # half of the picture at least
    # From the side that the wall does not hide.
    if view == "side":
        assert (camera.place - camera.target) @ result.scene.barrier.core.normal > -1e-6


@pytest.mark.parametrize(
    ("barrier", "angle", "yaw", "seen"),
    [
        (Barrier.rigid_wall(), 90.0, 0.0, (1.0, 0.0)),  # the front
        (Barrier.pole(), 90.0, 0.0, (1.0, 0.0)),
        (Barrier.rigid_wall(), 24.0, 0.0, (0.7, -0.7)),  # the right front corner
        (Barrier.rigid_wall(), 156.0, 0.0, (0.7, 0.7)),  # the left one
        (Barrier.pole(), 90.0, 90.0, (0.0, -1.0)),  # the right side
        (Barrier.pole(), 90.0, -90.0, (0.0, 1.0)),
    ],
)
def test_camera_sees_the_crushed_side(
    barrier: Barrier, angle: float, yaw: float, seen: tuple[float, float]
) -> None:
    """Within 50 degrees of where the crush is from the vehicle's middle, body axes forward and left."""
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    result = Simulation(car, barrier, 12.0, angle, impact_yaw=yaw).run()
    with rendering.Stage(result, [result.time[-1]], size=SIZE) as stage:
        place = np.array(stage.plotter.camera.position) - np.array(stage.plotter.camera.focal_point)
        forward, left = stage._skins[-1][0].rotation[:2, 0], stage._skins[-1][0].rotation[:2, 1]
        look = place[:2] / np.linalg.norm(place[:2])
        assert look @ (seen[0] * forward + seen[1] * left) / np.hypot(*seen) > np.cos(np.radians(50.0))
        # One looks through a barrier that is in the way, and not through posts.
        opacities = [actor.prop.opacity for actor in stage.plotter.actors.values() if hasattr(actor, "prop")]
        behind = look @ barrier.core.normal[:2] < 0.0
        assert (min(opacities) < 0.5) == (behind and isinstance(barrier, RigidWall))


def test_posts_are_seen_whole() -> None:
    car = Vehicle.preset("passenger_car", mesh_density=0.1)
    result = Simulation(car, Barrier.bollards(count=3, height=1.1), 10.0).run()
    with rendering.Stage(result, [0.0, result.time[-1]], size=SIZE) as stage:
        assert stage._posts[:, 2].max() == pytest.approx(1.1)
        assert len(np.unique(np.round(stage._posts[:, 1], 6))) > 3
        camera = stage.plotter.camera
        ahead = np.array(camera.focal_point) - camera.position
        ahead /= np.linalg.norm(ahead)
        up = np.array(camera.up) - (camera.up @ ahead) * ahead
        up /= np.linalg.norm(up)
        offsets = (stage._posts - camera.position) @ np.stack([np.cross(ahead, up), up, ahead]).T
        scale = offsets[:, 2] * np.tan(np.radians(0.5 * camera.view_angle))
        assert np.abs(offsets[:, 1] / scale).max() < 1.0
        assert np.abs(offsets[:, 0] / scale * SIZE[1] / SIZE[0]).max() < 1.0


def test_driver_moves_with_the_vehicle(result: Result) -> None:
    (start,), (end,) = skins_at(result, [0.0, 0.29])
    eyes = [skin.rotation.T @ (driver_camera(result, [skin]).place - skin.center) for skin in (start, end)]
    assert eyes[0] == pytest.approx(eyes[1])
    car = result.scene.vehicle
    assert (car.nodes.min(axis=0) < eyes[0]).all()
    assert (car.nodes.max(axis=0) > eyes[0]).all()
    assert eyes[0][1] > 0.0  # left-hand drive


def test_vehicle_without_a_skin_and_without_a_barrier() -> None:
    block = scenes.laboratory_block(16, k_initial=3e6, k_unloading=3e6)
    picture = Simulation(block, None, 10.0, duration=0.01).run().render(size=SIZE)
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 50


def test_bad_arguments(result: Result, tmp_path: Path) -> None:
    for options, message in (
        ({"view": "below"}, "view must be one of three_quarter"),
        ({"color": "red"}, "color must be one of crush"),
        ({"size": (10, 10)}, "size must be two whole numbers"),
        ({"time": 9.0}, "time must be"),
        ({"path": tmp_path / "a.xyz"}, "path must end in"),
    ):
        with pytest.raises(ValueError, match=message):
            result.render(**options)
    for name, options, message in (
        ("a.txt", {}, "path must end in .gif"),
        ("a.gif", {"frames": 1}, "frames must be a whole number >= 2"),
        ("a.gif", {"fps": 0.0}, "fps must be"),
        ("a.mp4", {"size": (101, 100)}, "size must be even"),
        ("none/a.gif", {}, "folder that exists"),
    ):
        with pytest.raises(ValueError, match=message):
            result.animate(tmp_path / name, **options)
    assert list(tmp_path.iterdir()) == []


# ---- movies ------------------------------------------------------------------------------------------------


def test_gif(result: Result, tmp_path: Path) -> None:
    result.animate(tmp_path / "crash.gif", frames=6, fps=10.0, size=SIZE, follow=True)
    with Image.open(tmp_path / "crash.gif") as movie:
        assert movie.n_frames == 6
        assert movie.size == SIZE
        assert movie.info["duration"] == 100
        first = np.asarray(movie.convert("RGB"))
        movie.seek(5)
        last = np.asarray(movie.convert("RGB"))
    assert np.mean(first != last) > 0.05


def test_mp4(result: Result, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    import imageio_ffmpeg

    result.animate(tmp_path / "crash.mp4", frames=12, fps=24.0, size=SIZE, progress=True)
    frames, seconds = imageio_ffmpeg.count_frames_and_secs(tmp_path / "crash.mp4")
    assert frames == 12
    assert seconds == pytest.approx(0.5, abs=0.05)
    out, err = capsys.readouterr()
    assert out == ""
    assert "12/12" in err


@pytest.mark.parametrize("name", ["crash.gif", "crash.mp4"])
def test_stopped_movie_leaves_nothing(
    result: Result, tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ctrl-C at the third frame."""
    picture = rendering.Stage.picture
    count = iter(range(100))

    def interrupted(stage: rendering.Stage) -> np.ndarray:
        if next(count) == 2:
            raise KeyboardInterrupt
        return picture(stage)

    monkeypatch.setattr(rendering.Stage, "picture", interrupted)
    with pytest.raises(KeyboardInterrupt):
        result.animate(tmp_path / name, frames=6, size=SIZE)
    assert list(tmp_path.iterdir()) == []


# ---- window and extras -------------------------------------------------------------------------------------


def test_slider(result: Result) -> None:
    stage, slider = with_slider(result, view="three_quarter", color="crush", off_screen=True)
    with stage:
        before = stage.picture()
        slider.GetRepresentation().SetValue(200.0)
        slider.InvokeEvent("InteractionEvent")
        slider.InvokeEvent("EndInteractionEvent")
        assert np.mean(stage.picture() != before) > 0.02


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="other systems always have a display")
def test_window_needs_a_display(result: Result, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    with pytest.raises(RuntimeError, match="needs a display"):
        result.show()


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="libraries of linux")
def test_machine_that_can_not_draw(result: Result, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.setattr(stage_module, "_OFF_SCREEN", ("libnone.so.1",))
    with pytest.raises(RuntimeError, match=r"no way to draw.*EGL or OSMesa"):
        result.render(size=SIZE)


def test_without_the_extra(result: Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(ImportError, match=r"imageio-ffmpeg: pip install 'birm3d\[render\]'; .gif does not"):
        result.animate(tmp_path / "a.mp4", size=SIZE)
    monkeypatch.setitem(sys.modules, "pyvista", None)
    for picture in (result.render, result.show, lambda: result.animate(tmp_path / "a.gif")):
        monkeypatch.setenv("DISPLAY", ":0")
        with pytest.raises(ImportError, match=r"pyvista: pip install 'birm3d\[render\]'"):
            picture()
    assert list(tmp_path.iterdir()) == []


def test_nothing_is_loaded_before_it_is_needed() -> None:
    import subprocess

    code = (
        "import sys, birm3d; birm3d.scenes.w2(16).run(); "
        "print([m for m in ('matplotlib', 'pyvista', 'vtkmodules', 'plotly', 'PIL') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
