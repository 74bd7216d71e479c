"""One unit of a vehicle on stage: its skin and its wheels."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ..base.plain_words import plain_words
from ..pictures import Color
from ..result.skin import Skin
from ..vehicle.unit_shapes import UnitShape

__all__ = ["Color", "UnitOnStage", "polygons"]

_PLAIN, _WHEEL, _TRUSS = "#9DB8CF", "#2B2B2B", "#35618A"
# Tell zones apart, also for colour-blind readers: Okabe and Ito's colours, lightened, then greys.
_ZONES = (
    "#56B4E9", "#E69F00", "#7CC9A9", "#F0E442", "#6FA0CE",
    "#E59A6B", "#DDA9C9", "#BBBBBB", "#888888", "#DDDDDD",
)  # fmt: skip
# Of crush: grey where there is none, so that little of it shows too.
_CRUSH = ("#DCE2E8", "#FFE08A", "#FDAE4B", "#E8502E", "#B0101A", "#5E0008")
_WHEEL_WIDTH = 0.6  # of the radius; drawn, not modelled


class UnitOnStage:
    """Makes the actors of a unit once; :meth:`move` puts them where they are at an instant.

    A unit without a skin is drawn as its trusses.

    Parameters
    ----------
    pv, plotter
        pyvista and the plotter.
    shape
        The unit.
    color
        Of the skin.
    greatest
        Crush that has the darkest colour [m].
    font
        Size of texts, points.
    first
        Whether this unit shows the bar of colours.
    from_inside
        Whether the eye is inside: then one looks through what is seen from behind, and wheels are left out.
    """

    def __init__(
        self,
        pv: Any,
        plotter: Any,
        shape: UnitShape,
        color: Color,
        greatest: float,
        font: int,
        *,
        first: bool,
        from_inside: bool,
    ) -> None:
        self._shape = shape
        self._wheels: list[Any] = []
        if not from_inside:
            for *center, radius in shape.wheels:
                height = _WHEEL_WIDTH * radius
                wheel = pv.Cylinder(
                    center=center, direction=(0.0, 1.0, 0.0), radius=radius, height=height, resolution=36
                )
                self._wheels.append(plotter.add_mesh(wheel, color=_WHEEL, smooth_shading=False))
        if len(shape.quads) == 0:
            n = len(shape.nodes)
            pairs = np.stack([np.arange(n), np.arange(n) + n], axis=1)
            self._mesh = pv.PolyData(np.vstack([shape.nodes, shape.anchors]), lines=polygons(pairs))
            plotter.add_mesh(self._mesh, color=_TRUSS, line_width=1.5)
            return
        self._mesh = pv.PolyData(shape.nodes.copy(), polygons(shape.quads))
        look: dict[str, Any] = {"color": _PLAIN}
        if color == "crush":
            self._mesh.point_data["crush"] = np.zeros(len(shape.nodes))
            look = {"scalars": "crush", "cmap": _crush_colors(), "clim": (0.0, greatest)}
            look |= {"show_scalar_bar": first, "scalar_bar_args": _bar(font)}
        elif color == "zone" and len(shape.zone_names):
            n = len(shape.zone_names)
            # The four nodes of an element share one zone.
            self._mesh.cell_data["zone"] = shape.zone_of_node[shape.quads[:, 0]].astype(float)
            look = {"scalars": "zone", "cmap": [_ZONES[i % len(_ZONES)] for i in range(n)]}
            look |= {"clim": (-0.5, n - 0.5), "n_colors": n, "show_scalar_bar": first}
            look["annotations"] = {float(i): plain_words(name) for i, name in enumerate(shape.zone_names)}
            look["scalar_bar_args"] = {**_bar(font), "title": "zone\n ", "n_labels": 0}
        plotter.add_mesh(
            self._mesh,
            show_edges=True,
            edge_color="#404040",
            edge_opacity=0.35,
            line_width=0.6,
            smooth_shading=False,
            ambient=0.25,
            culling="back" if from_inside else None,
            **look,
        )

    def move(self, skin: Skin) -> None:
        """Put the unit where it is at an instant."""
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = skin.rotation, skin.center
        for wheel in self._wheels:
            wheel.user_matrix = pose
        if len(self._shape.quads) == 0:
            self._mesh.points = skin.center + np.vstack([skin.nodes, self._shape.anchors]) @ skin.rotation.T
            return
        self._mesh.points = skin.world
        if "crush" in self._mesh.point_data:
            self._mesh.point_data["crush"][:] = skin.crush
            self._mesh.Modified()


def _crush_colors() -> Any:
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("crush", _CRUSH)


def polygons(corners: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Return faces or lines (m, k) as VTK has them: the number of corners before each."""
    return np.column_stack([np.full(len(corners), corners.shape[1]), corners]).ravel()


def _bar(font: int) -> dict[str, Any]:
    return {
        "title": "crush [m]\n ",
        "vertical": True,
        "height": 0.5,
        "width": 0.045,
        "position_x": 0.9,
        "position_y": 0.25,
        "color": "black",
        "n_labels": 5,
        "fmt": "%.2f",
        "title_font_size": round(1.4 * font),
        "label_font_size": round(1.3 * font),
    }
