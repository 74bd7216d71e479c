"""Sizes of barriers that can not be: refused by name, limit and value."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from birm3d import Barrier

NAN, INF = math.nan, math.inf
CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
QUADS = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
FACES = np.array([[quad[i] for i in three] for quad in QUADS for three in ((0, 1, 2), (0, 2, 3))])

SIZES: dict[str, dict[str, tuple[Any, ...]]] = {
    "rigid_wall": {
        "width": (0.0, -1.0, NAN),
        "height": (0.0, -1.0, NAN),
        "thickness": (0.0, -1.0, NAN, INF),
        "segments": (0, -1, 1.5, NAN, INF, 2),  # the last: of a wall without end
    },
    "pole": {"diameter": (0.0, -1.0, NAN, INF)},
    "bollards": {
        "count": (0, -1, 1.5, NAN, INF),
        "diameter": (0.0, -1.0, NAN, INF),
        "height": (0.0, -1.0, NAN),
        "spacing": (0.32, -1.0, NAN, INF),  # the first: that of the posts touching
        "rows": (0, 1.5, NAN),
        "row_offset": (NAN, INF),
    },
    "planter": {
        "count": (0, -1, 1.5, NAN, INF),
        "length": (0.0, -1.0, NAN, INF),
        "width": (0.0, -1.0, NAN, INF),
        "height": (0.0, -1.0, NAN, INF),
    },
    "jersey": {
        "height": (0.0, 0.33, 1.6, NAN, INF),
        "length": (0.0, -1.0, NAN),
        "segments": (0, 1.5, NAN, 2),
    },
}
CASES = [(kind, name, value) for kind, sizes in SIZES.items() for name, of in sizes.items() for value in of]
COMMON = [
    (kind, name, value)
    for kind in SIZES
    for name, values in {"friction": (-0.1, NAN, INF), "heading": (NAN, INF)}.items()
    for value in values
]


def refused(name: str, message: str, value: str) -> None:
    assert message.startswith(name), message
    assert " must " in message, message
    assert message.rsplit("got ", 1)[1] == value, message


@pytest.mark.parametrize(("kind", "name", "value"), CASES + COMMON)
def test_sizes(kind: str, name: str, value: Any) -> None:
    with pytest.raises(ValueError, match=name) as caught:
        getattr(Barrier, kind)(**{name: value})
    refused(name, str(caught.value), str(value))


@pytest.mark.parametrize("origin", [(0.0, 0.0), (0.0, NAN, 0.0), (INF, 0.0, 0.0)])
@pytest.mark.parametrize("kind", SIZES)
def test_origins(kind: str, origin: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="origin must"):
        getattr(Barrier, kind)(origin=origin)


@pytest.mark.parametrize("value", [0.3, NAN, INF])
def test_rows_stand_apart(value: float) -> None:
    assert Barrier.bollards(row_spacing=value).rows == 1  # a single row has no use for it
    with pytest.raises(ValueError, match=r"row_spacing must .* above the diameter"):
        Barrier.bollards(rows=2, row_spacing=value)


@pytest.mark.parametrize(
    ("profile", "limit"),
    [
        ("vertical", "one of new_jersey, f_shape, single_slope"),
        (((0.3, 0.0),), "shape"),
        (((0.3, 0.0, 0.0), (0.2, 0.5, 0.0)), "shape"),
        (((0.3, 0.1), (0.2, 0.5)), "begin at height 0"),
        (((0.3, 0.0), (0.2, 0.5), (0.1, 0.5)), "rise"),
        (((0.3, 0.0), (0.0, 0.5)), "half widths > 0"),
        (((0.3, 0.0), (NAN, 0.5)), "finite"),
        (((0.3, 0.0), (0.2, INF)), "finite"),
    ],
)
def test_profiles(profile: Any, limit: str) -> None:
    with pytest.raises(ValueError, match=rf"^profile must .*{limit}.* got "):
        Barrier.jersey(profile=profile)


def test_a_profile_of_points_has_its_own_height() -> None:
    with pytest.raises(ValueError, match="height must be None"):
        Barrier.jersey(profile=((0.3, 0.0), (0.2, 0.5)), height=0.5)


@pytest.mark.parametrize(
    ("vertices", "faces", "name"),
    [
        (CUBE[:, :2], FACES, "vertices"),
        (np.empty((0, 3)), FACES, "faces"),
        (np.where(CUBE == 1.0, NAN, CUBE), FACES, "vertices"),
        (np.where(CUBE == 1.0, INF, CUBE), FACES, "vertices"),
        (CUBE, FACES[:, :2], "faces"),
        (CUBE, np.empty((0, 3), int), "faces"),
        (CUBE, FACES + 1, "faces"),
        (CUBE, -FACES, "faces"),
        (CUBE, FACES * 1.0, "faces"),
        (CUBE, [[0, 0, 1]], "faces"),
        (CUBE, FACES[:, ::-1], "faces must be counter-clockwise"),
    ],
)
def test_meshes(vertices: Any, faces: Any, name: str) -> None:
    with pytest.raises(ValueError, match=rf"^{name}.* got "):
        Barrier.from_mesh(vertices, faces)


def test_a_mesh_with_a_hole_names_an_edge_and_how_many() -> None:
    with pytest.raises(
        ValueError, match=r"close a solid, got a hole: 3 edges .* from \(0, 0, 1\) to \(0, 1, 1\) m"
    ):
        Barrier.from_mesh(CUBE, FACES[:-1])
    # Triangles with corners of their own close a solid too.
    own = np.arange(36).reshape(12, 3)
    assert len(Barrier.from_mesh(CUBE[FACES.ravel()], own).faces) == 12


def test_a_mesh_may_be_open_where_it_stands() -> None:
    foot = (CUBE[FACES][:, :, 2] == 0.0).all(axis=1)
    assert foot.sum() == 2
    assert len(Barrier.from_mesh(CUBE, FACES[~foot]).faces) == 10
    with pytest.raises(ValueError, match="got a hole: 4 edges"):
        Barrier.from_mesh(CUBE, FACES[~foot], origin=(0.0, 0.0, 0.1))
    with pytest.raises(ValueError, match="counter-clockwise"):
        Barrier.from_mesh(CUBE, FACES[~foot][:, ::-1])


def test_counts_that_can_not_be_held() -> None:
    for name, value in (("count", 1_000_000), ("count", 1e300), ("rows", 10**400)):
        with pytest.raises(ValueError, match=rf"{name} must be at most 10,000, got "):
            Barrier.bollards(**{name: value})
    with pytest.raises(ValueError, match="count must make at most 10,000 bollards with 200 rows, got 100"):
        Barrier.bollards(count=100, rows=200)
    with pytest.raises(ValueError, match="segments must be at most 10,000, got 1000000"):
        Barrier.jersey(length="1e6 m", segments=1_000_000)
