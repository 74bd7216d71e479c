"""The code on the how-to pages runs, from top to bottom of each page."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import birm3d
import pytest
from birm3d.assessment import class_bands
from birm3d.study import limit_class

ROOT = Path(__file__).parents[2]
PAGES = sorted((ROOT / "docs/pages/how-to").glob("*.md"))
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.S | re.M)
FILE = re.compile(r"^```toml\n# (\w+\.toml)\n(.*?)^```$", re.S | re.M)  # a comment names it

BEFORE = """
import birm3d
from birm3d import units
from scipy import stats
"""
CAR_AT_WALL = """
car = birm3d.Vehicle.preset("passenger_car")
wall = birm3d.Barrier.rigid_wall()
"""
TRUCK_AT_POSTS = """
truck, posts = birm3d.Vehicle.preset("cargo_truck"), birm3d.Barrier.bollards()
simulation = birm3d.Simulation(truck, posts, "50 mph")
crash = simulation.run()
"""
# What the reader of a page has already.
GIVEN = {
    "barrier": CAR_AT_WALL
    + """
import trimesh
box = trimesh.creation.box((0.5, 2.0, 1.0))
vertices, faces = box.vertices + [0.25, 0.0, 0.5], box.faces
sim = birm3d.Simulation(car, wall, 10.0)
""",
    "calibrate": CAR_AT_WALL,
    "compare": CAR_AT_WALL
    + """
result = birm3d.Simulation(car, wall, "30 mph").run()
rows = zip(1e3 * result.time, 1e-3 * result.barrier_normal_force)
with open("test.csv", "w") as file:
    print("time [ms],wall force [kN]", *(f"{t:.4f},{f:.4f}" for t, f in rows), sep="\\n", file=file)
""",
    "design-loads": TRUCK_AT_POSTS
    + """
truck_crash = simulation
car_crash = birm3d.Simulation(birm3d.Vehicle.preset("passenger_car"), posts, "50 mph")
""",
    "export": "",
    "mesh": """
import trimesh
from keyword_decks import car_parts, skin_of, write_deck
from pathlib import Path
write_deck(Path("car.k"), car_parts())
points, triangles = skin_of(birm3d.Vehicle.preset("minivan"))
trimesh.Trimesh(1e3 * points, triangles).export("body.stl")
""",
    "rating": TRUCK_AT_POSTS
    + """
my_bus = birm3d.Vehicle.preset("bus_13t")
pulse = birm3d.Simulation(birm3d.Vehicle.preset("passenger_car"), birm3d.Barrier.rigid_wall(), 12.0).run()
ax, ay, az = (pulse.sensor((-1.0, 0.0, 0.5)).channel(axis) for axis in "xyz")
rate = None
""",
    "result": CAR_AT_WALL
    + """
simulation = birm3d.Simulation(car, wall, 10.0)
slow, fast = simulation.run(), birm3d.Simulation(car, wall, 14.0).run()
with open("wall.csv", "w") as file:
    print("time [ms]", *(f"{row}{n} [kN]" for row in "ABC" for n in (1, 2, 3, 4)), sep=",", file=file)
    for ms in range(101):
        print(ms, *[ms * (100 - ms) / 100] * 12, sep=",", file=file)
""",
    "studies": """
car, wall = birm3d.Vehicle.preset("pickup", gvw=2300.0), birm3d.Barrier.rigid_wall()
""",
    "vehicle": """
inertia, n = [[9e3, 0, 0], [0, 3e4, 0], [0, 0, 3e4]], 2
nodes, anchors = [[3.0, 0.5, 0.0], [3.0, -0.5, 0.0]], [[1.0, 0.5, 0.0], [1.0, -0.5, 0.0]]
""",
}
# Packages that a page asks for.
EXTRAS = {
    "barrier": ("trimesh",),
    "mesh": ("trimesh",),
    **dict.fromkeys(("design-loads", "result", "studies"), ("pandas",)),
}


def test_what_is_given_is_given_to_a_page() -> None:
    assert GIVEN.keys() | EXTRAS.keys() <= {page.stem for page in PAGES}


@pytest.fixture
def coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    """Presets of few nodes, few vehicles of a class, unless a page asks for more: this is about the calls."""
    preset = birm3d.Vehicle.preset

    def of_few_nodes(name: str, **changes: Any) -> birm3d.Vehicle:
        return preset(name, **{"mesh_density": 0.1, **changes})

    monkeypatch.setattr(birm3d.Vehicle, "preset", of_few_nodes)
    monkeypatch.setattr(limit_class, "_USUAL_DRAWS", 8)
    monkeypatch.setattr(class_bands, "_DRAWS", 8)


# Of coarse skins, and of scenes that are chosen to be short.
@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_page_runs(page: Path, coarse: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = page.read_text(encoding="utf-8")
    blocks = BLOCK.findall(text)
    assert blocks
    for name, content in FILE.findall(text):
        (tmp_path / name).write_text(content, encoding="utf-8")
    for extra in EXTRAS.get(page.stem, ()):
        pytest.importorskip(extra)
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    for k, code in enumerate([BEFORE, GIVEN.get(page.stem, ""), *blocks]):
        exec(compile(code, f"{page.name}, block {k - 1}", "exec"), names)
