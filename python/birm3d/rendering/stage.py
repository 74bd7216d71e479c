"""The scene on stage: vehicle, barrier, ground, camera and stamps, at any instant of a run."""

from __future__ import annotations

import ctypes
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .. import units
from ..barrier.surfaces import Surface, barrier_axes, barrier_surfaces
from ..plotting.style import title
from ..result.crushed_side import crushed_direction
from ..result.element_motion import element_motion
from ..result.skin import Skin, skins_at
from ..vehicle.unit_shapes import unit_shapes
from .camera import Camera, View, check_view, driver_camera, outside_camera
from .unit_on_stage import Color, UnitOnStage, polygons

if TYPE_CHECKING:
    from ..barrier.barrier import Barrier
    from ..result.result import Result

__all__ = ["Color", "Stage"]

Floats = npt.NDArray[np.float64]

_BARRIER, _GROUND, _GRID = "#B9B4AA", "#EDEEEA", "#C9CBC6"
_OFF_SCREEN = ("libEGL.so.1", "libOSMesa.so.8", "libOSMesa.so.6")
_NO_DRAWING = (
    "this machine has no way to draw: without a display VTK needs EGL or OSMesa "
    "(Debian: apt install libegl1 libgl1-mesa-dri, or libosmesa6)"
)
_LEAST_SCALE = 0.05  # the colours of crush range over this at least, m
_BAR = 0.12  # share of the picture's width that the bar of colours or the names of zones take
_AROUND = 8.0  # the ground goes on so far past what is shown, m, so that no edge is in the foreground
_NEAR = 1.5  # posts as near to the vehicle as this are shown whole, m
_SEEN_THROUGH = 0.22  # opacity of a barrier that the camera stands behind


class Stage:
    """A pyvista plotter with one result on it; :meth:`move_to` shows another instant.

    Parameters
    ----------
    result
        What is shown.
    times
        Instants that will be shown, shape (k,) [s]: the camera and the colours take all of them in.
    view
        See :data:`birm3d.rendering.VIEWS`.
    color
        Of the skin: ``"crush"`` (distance of each node from its uncrushed place), ``"zone"`` or ``"plain"``.
    size
        Width and height of the picture, pixels.
    follow
        Whether an outer camera moves along with the first unit.
    off_screen
        Without a window.

    Raises
    ------
    ImportError
        Without pyvista.
    ValueError
        If an instant is outside the run, or a view, a colour or a size is not one.
    RuntimeError
        If this machine has no way to draw.
    """

    def __init__(
        self,
        result: Result,
        times: npt.ArrayLike,
        *,
        view: View = "three_quarter",
        color: Color = "crush",
        size: tuple[int, int] = (1280, 720),
        follow: bool = False,
        off_screen: bool = True,
    ) -> None:
        check_view(view)
        if color not in ("crush", "zone", "plain"):
            raise ValueError(f"color must be one of crush, zone, plain; got {color!r}")
        if len(size) != 2 or not all(isinstance(n, int) and 16 <= n <= 8192 for n in size):
            raise ValueError(f"size must be two whole numbers of 16 to 8192 pixels, got {size}")
        self._pv = _pyvista()
        _check_drawing()
        self._result, self._view, self._color, self._follow = result, view, color, follow
        self.times = np.atleast_1d(np.asarray(times, float))
        self._skins = skins_at(result, self.times)
        self._size = size
        self._camera: Camera | None = None
        self._crushed = crushed_direction(result, self._skins[-1])
        with _quiet():
            self.plotter = self._pv.Plotter(off_screen=off_screen, window_size=list(size))
            self.plotter.set_background("white", top="#DCE6EF")
            self._set()
            self.move_to(0)

    def _set(self) -> None:
        """Put everything on stage that does not move."""
        plotter, pv = self.plotter, self._pv
        world = [skin.world for units in self._skins for skin in units]
        around = np.vstack(world)
        surfaces = barrier_surfaces(self._result.scene.barrier, around)
        self._posts = _posts_near(self._result.scene.barrier, surfaces, around)
        opacity = _SEEN_THROUGH if self._is_behind() else 1.0
        self._motion = element_motion(self._result, self.times)
        self._moving: list[tuple[Any, Any]] = []  # surfaces of elements that move, and their first corners
        for element, (vertices, faces) in enumerate(surfaces):
            surface = pv.PolyData(vertices, polygons(faces))
            if element < self._motion.movable:
                self._moving.append((surface, vertices))
            look = {"show_edges": False, "smooth_shading": False, "ambient": 0.3, "opacity": opacity}
            plotter.add_mesh(surface, color=_BARRIER, **look)
        low, high = np.floor(around.min(axis=0) - _AROUND), np.ceil(around.max(axis=0) + _AROUND)
        if self._result.scene.settings.ground:
            plotter.add_mesh(_ground(pv, low, high, -0.01), color=_GROUND, lighting=False)
            plotter.add_mesh(_grid(pv, low, high, -0.005), color=_GRID, line_width=1.0, lighting=False)
        # Of what is shown: nodes on treads are no corners of it.
        corners = [np.unique(shape.quads) for shape in unit_shapes(self._result.scene.vehicle)]
        crushed = (
            float(skin.crush[shown].max(initial=0.0))
            for units in self._skins
            for skin, shown in zip(units, corners, strict=True)
        )
        greatest = max(_LEAST_SCALE, *crushed)
        font = max(6, round(self._size[1] / 60.0))
        text = {"viewport": True, "color": "black"}
        plotter.add_text(title(self._result), position=(0.02, 0.90), font_size=round(0.85 * font), **text)
        self._stamp = plotter.add_text(" ", position=(0.02, 0.03), font_size=font, **text)
        driver = self._view == "driver"
        self._parts = [
            UnitOnStage(pv, plotter, shape, self._color, greatest, font, first=unit == 0, from_inside=driver)
            for unit, shape in enumerate(unit_shapes(self._result.scene.vehicle))
        ]

    def _is_behind(self) -> bool:
        """Whether the barrier is between the camera and the vehicle, and hides more than a post would."""
        barrier = self._result.scene.barrier
        if barrier is None or self._view == "driver" or barrier.has_posts:
            return False
        camera = self._outside(self._skins)
        return float((camera.place - camera.target) @ barrier_axes(barrier)[1]) < -1e-6

    def move_to(self, k: int) -> None:
        """Show the instant ``times[k]``."""
        for part, skin in zip(self._parts, self._skins[k], strict=True):
            part.move(skin)
        for element, (surface, corners) in enumerate(self._moving):
            surface.points = self._motion.moved(k, element, corners)
        time = float(self.times[k])
        speed = float(
            np.linalg.norm([np.interp(time, self._result.time, v) for v in self._result.velocity.T])
        )
        self._stamp.SetInput(f"{time * 1e3:6.1f} ms   {speed:5.1f} m/s ({speed / units.mph:.1f} mph)")
        self._aim(k)

    def _aim(self, k: int) -> None:
        if self._view == "driver":
            self._put(driver_camera(self._result, self._skins[k]))
        elif self._follow or self._camera is None:
            self._camera = self._outside([self._skins[k]] if self._follow else self._skins)
            self._put(self._camera)
        self.plotter.reset_camera_clipping_range()

    def _outside(self, skins: Sequence[tuple[Skin, ...]]) -> Camera:
        points = np.vstack([*(skin.world for units in skins for skin in units), self._posts])
        aspect = self._size[0] / self._size[1]
        taken = 0.0 if self._color == "plain" else _BAR
        return outside_camera(self._result, self._view, points, aspect, taken, self._crushed)

    def _put(self, camera: Camera) -> None:
        self.plotter.camera.position = tuple(camera.place)
        self.plotter.camera.focal_point = tuple(camera.target)
        self.plotter.camera.up = tuple(camera.up)
        self.plotter.camera.view_angle = camera.angle
        self.plotter.camera.parallel_projection = camera.half_height is not None
        if camera.half_height is not None:
            self.plotter.camera.parallel_scale = camera.half_height

    def picture(self) -> npt.NDArray[np.uint8]:
        """Return what the camera sees, shape (height, width, 3), red, green, blue."""
        with _quiet():
            self.plotter.render()  # a screenshot alone shows the last drawing
            image = np.asarray(self.plotter.screenshot(return_img=True))
        if image.ndim != 3 or image.std() == 0.0:
            raise RuntimeError(_NO_DRAWING)
        return np.ascontiguousarray(image[..., :3], np.uint8)

    def close(self) -> None:
        """Free what the machine draws with."""
        self.plotter.close()

    def __enter__(self) -> Stage:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()


def _pyvista() -> Any:
    try:
        import pyvista
    except ImportError as error:
        raise ImportError("3-D pictures need pyvista: pip install 'birm3d[render]'") from error
    return pyvista


def check_drawing() -> None:
    """Refuse an installation without pyvista, and a machine that can not draw.

    Raises
    ------
    ImportError
        Without pyvista.
    RuntimeError
        Without a display and the libraries that stand in for one.
    """
    _pyvista()
    _check_drawing()


def _check_drawing() -> None:
    """Refuse a machine on which VTK would crash: without a display it needs one of these libraries."""
    if not sys.platform.startswith("linux") or os.environ.get("DISPLAY"):
        return
    for library in _OFF_SCREEN:
        try:
            ctypes.CDLL(library)
        except OSError:
            continue
        return
    raise RuntimeError(_NO_DRAWING)


@contextmanager
def _quiet() -> Iterator[None]:
    """Let VTK look for a display, without its warning that there is none; errors are still printed."""
    if not sys.platform.startswith("linux") or os.environ.get("DISPLAY"):
        yield
        return
    from vtkmodules.vtkCommonCore import vtkLogger

    before = vtkLogger.GetCurrentVerbosityCutoff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)
    try:
        yield
    finally:
        vtkLogger.SetStderrVerbosity(before)


def _posts_near(barrier: Barrier | None, surfaces: Sequence[Surface], around: Floats) -> Floats:
    """Return the corners (k, 3) of the posts beside what is shown: they are to be seen whole."""
    near = [np.empty((0, 3))]
    if barrier is not None and barrier.has_posts:
        low, high = around.min(axis=0)[:2] - _NEAR, around.max(axis=0)[:2] + _NEAR
        axes = [(v.min(axis=0) + v.max(axis=0))[:2] / 2.0 for v, _ in surfaces]
        inside = [((low <= axis) & (axis <= high)).all() for axis in axes]
        near += [v for (v, _), seen in zip(surfaces, inside, strict=True) if seen]
    return np.vstack(near)


def _ground(pv: Any, low: Floats, high: Floats, z: float) -> Any:
    corners = np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])
    return pv.PolyData(np.column_stack([corners, np.full(4, z)]), polygons(np.array([[0, 1, 2, 3]])))


def _grid(pv: Any, low: Floats, high: Floats, z: float) -> Any:
    """Return lines 1 m apart."""
    ends: list[Sequence[float]] = []
    for x in np.arange(low[0], high[0] + 0.5):
        ends += [(x, low[1], z), (x, high[1], z)]
    for y in np.arange(low[1], high[1] + 0.5):
        ends += [(low[0], y, z), (high[0], y, z)]
    n = len(ends) // 2
    lines = np.column_stack([np.full(n, 2), np.arange(0, 2 * n, 2), np.arange(1, 2 * n, 2)]).ravel()
    return pv.PolyData(np.array(ends), lines=lines)
