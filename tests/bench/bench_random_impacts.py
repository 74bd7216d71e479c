"""Random impacts: none missed, no ghost at internal edges, none through.

    python tests/bench/bench_random_impacts.py [--count 10000] [--threads 2] [--save] [--csv FILE]
    python tests/bench/bench_random_impacts.py --quick
    python tests/bench/bench_random_impacts.py --any-pose [--count 100000] [--first 0] [--limit 60]

Coarse presets and a laboratory block at 1 to 60 m/s and 5 to 90 deg against posts of 0.1 to 0.5 m, sloped
profiles, walls without end, finite and in segments, and meshes of walls and posts; every fifth group
with skins that posts do not indent. Watched step by step (birm3d.study.watched):

- missed: the straight path of some node leads 5 cm or more into the barrier, and nothing touched;
- ghost: the wall is flat and endless for the vehicle, friction is nil, and some force acts along it (relative
  to the greatest normal force, limit 1e-9): a whole wall has none, no more may one in segments or triangles;
- through: a node or an anchor ends a step inside, or the mass centre gets behind a high wall;
- balances: energy within 0.5 %, momentum within 1e-9.

With --any-pose the scenes are those of random_scenes.py, on two processes: a row each in the table, and
faults with the seeds that replay them. A table that is there already is gone on with. --save writes counts,
percentiles and worst values at each kind of barrier.

Ends with 1 if anything was found. The case of a seed is the same on every machine.
"""

from __future__ import annotations

import argparse
import csv
import sys
import warnings
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt
from birm3d import Barrier, CoarseSkinWarning, Settings, Simulation, Vehicle, scenes
from birm3d.base.progress import progress_bar
from birm3d.study.verification.watched import Watched, text, watch
from random_scenes import run_many, write_summary

ANY_POSE = Path(__file__).parent / "results/robustness/random_scenes.csv"
ANY_POSE_SUMMARY = ANY_POSE.with_name("random_scenes_summary.csv")
RESULTS = Path(__file__).parent / "results/robustness/random_impacts.csv"
Floats = npt.NDArray[np.float64]
GHOST = 1e-9
SURELY = 0.05  # m by which a path must lead into a barrier to count as one that must hit
WIDE = 80.0  # m, of walls whose ends no vehicle reaches
KINDS = (
    "post",
    "profile",
    "wall",
    "finite wall",
    "flat split wall",
    "flat mesh wall",
    "mesh post",
    "mesh profile",
)
VEHICLES = (*Vehicle.presets(), "block")


@dataclass(frozen=True)
class Case:
    """What a seed stands for."""

    seed: int
    vehicle: str
    kind: str
    size: float  # m: diameter of a post, height of a wall or profile
    speed: float
    angle: float
    offset: float
    indents: bool


@dataclass(frozen=True)
class Found:
    case: Case
    watched: Watched
    ghost: float
    faults: tuple[str, ...]


@cache
def vehicle(name: str, indents: bool) -> Vehicle:
    if name == "block":
        made = scenes.laboratory_block(
            96, k_initial=3e6, knee=0.4, k_hardening=6e6, k_unloading=60e6, stagger=0.05
        )
    else:
        made = Vehicle.preset(name, mesh_density=0.2)
    return made.with_indentation_length(0.65 if indents else 0.0)


def prism_mesh(profile: Floats, length: float, pieces: int) -> tuple[Floats, npt.NDArray[np.int64]]:
    """Return vertices and faces of a convex profile (x, z) [m], drawn along y in `pieces`, with ends."""
    n = len(profile)
    rings = [
        np.column_stack([profile[:, 0], np.full(n, y), profile[:, 1]])
        for y in np.linspace(-0.5, 0.5, pieces + 1) * length
    ]
    faces = []
    for ring in range(pieces):
        for i in range(n):
            a, b = ring * n + i, ring * n + (i + 1) % n
            faces += [(a, b, b + n), (a, b + n, a + n)]
    last = pieces * n
    for i in range(1, n - 1):
        faces += [(0, i + 1, i), (last, last + i, last + i + 1)]
    return np.concatenate(rings), np.array(faces)[:, ::-1]  # outwards for a profile that turns from x to z


def post_mesh(radius: float, height: float, sides: int = 32) -> tuple[Floats, npt.NDArray[np.int64]]:
    """Return a post of `sides` sides that stands 1 m in the ground; its corners are on the cylinder."""
    angle = 2.0 * np.pi * np.arange(sides) / sides
    ring = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    vertices = np.concatenate([np.column_stack([ring, np.full(sides, z)]) for z in (-1.0, height)])
    faces = [
        face
        for i in range(sides)
        for j in [(i + 1) % sides]
        for face in ((i, j, j + sides), (i, j + sides, i + sides))
    ]
    faces += [
        face for i in range(1, sides - 1) for face in ((0, i + 1, i), (sides, sides + i, sides + i + 1))
    ]
    return vertices, np.array(faces)


def draw(seed: int) -> tuple[Case, Barrier]:
    """Return the case of a seed and its barrier."""
    random = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    speed, angle = float(random.uniform(1.0, 60.0)), float(random.uniform(5.0, 90.0))
    friction = 0.0 if kind.startswith("flat") else float(random.uniform(0.0, 0.4))
    pieces, offset = int(random.integers(2, 40)), float(random.uniform(-3.0, 3.0))
    size = float(random.uniform(0.1, 0.5)) if "post" in kind else float(random.uniform(0.6, 1.2))
    slope = float(random.uniform(0.0, 0.25))
    profile = ((0.3, 0.0), (0.3 - slope, size))
    barrier: Barrier
    if kind == "post":
        barrier = Barrier.bollards(
            count=int(random.integers(1, 6)), diameter=size, height=1.0, spacing=size + 1.0, friction=friction
        )
    elif kind == "mesh post":
        barrier = Barrier.from_mesh(*post_mesh(0.5 * size, 1.0), friction=friction)
    elif kind == "profile":
        barrier = Barrier.jersey(profile=profile, length=20.0, segments=pieces, friction=friction)
    elif kind == "mesh profile":
        corners = np.array(
            [[0.3, -1.0], [0.3, 0.0], [0.3 - slope, size], [slope - 0.3, size], [-0.3, 0.0], [-0.3, -1.0]]
        )
        barrier = Barrier.from_mesh(*prism_mesh(corners + np.array([0.3, 0.0]), 20.0, 1), friction=friction)
    elif kind == "wall":
        barrier = Barrier.rigid_wall(friction=friction)
    elif kind == "finite wall":
        barrier = Barrier.rigid_wall(width=5.0, height=size, segments=pieces // 8 + 1, friction=friction)
    elif kind == "flat split wall":
        size = 5.0
        barrier = Barrier.rigid_wall(width=WIDE, height=size, segments=pieces, friction=0.0)
    else:
        size = 5.0
        corners = np.array([[0.0, -1.0], [0.5, -1.0], [0.5, size], [0.0, size]])
        barrier = Barrier.from_mesh(*prism_mesh(corners, WIDE, pieces), friction=0.0)
    indents = seed // len(KINDS) % 5 != 0
    name = VEHICLES[int(random.integers(len(VEHICLES)))]
    return Case(seed, name, kind, size, speed, angle, offset, indents), barrier


def must_hit(case: Case, barrier: Barrier, simulation: Simulation) -> bool:
    """Whether the straight path of some node leads well into the barrier, seen from above, below its top."""
    core = simulation._core
    direction = np.array(core.velocity(0)) / case.speed
    for unit in range(len(simulation.scene.vehicle.units)):
        place, rotation = core.pose(unit)
        nodes = place + core.nodes(unit) @ rotation.T
        if "post" in case.kind:
            nodes = nodes[nodes[:, 2] < 1.0 - SURELY]
            posts = [0.0]
            if case.kind == "post":
                count, spacing = barrier.count, barrier.spacing  # type: ignore[attr-defined]
                posts = [(i - 0.5 * (count - 1)) * spacing for i in range(count)]
            for y in posts:
                across = direction[0] * (nodes[:, 1] - y) - direction[1] * nodes[:, 0]
                if (np.abs(across) < 0.5 * case.size - 0.5 * min(SURELY, case.size)).any():
                    return True
            continue
        top = {"wall": np.inf}.get(case.kind, case.size) - SURELY
        half = {"wall": np.inf, "finite wall": 2.5}.get(
            case.kind, 0.5 * WIDE if "flat" in case.kind else 10.0
        )
        middle = 0.3 if "profile" in case.kind else SURELY
        nodes = nodes[(nodes[:, 2] < top) & (nodes[:, 2] > 0.0)]
        y = nodes[:, 1] + direction[1] / direction[0] * (middle - nodes[:, 0])
        if (np.abs(y) < half - SURELY).any():
            return True
    return False


def examine(seed: int) -> Found:
    case, barrier = draw(seed)
    duration = min(max(8.0 / case.speed, 0.15), 1.5)
    # The block has no wheels to stand on: it would fall past the foot of the barrier.
    settings = Settings(gravity=0.0, ground=False) if case.vehicle == "block" else None
    made = vehicle(case.vehicle, case.indents)
    simulation = Simulation(
        made, barrier, f"{case.speed} m/s", case.angle, case.offset, duration=duration, settings=settings
    )
    expected = must_hit(case, barrier, simulation)
    watched = watch(simulation)
    result = simulation.result()
    faults = [watched.fault] if watched.fault else []
    # A path that begins far beside the barrier may take longer than the run.
    if expected and not watched.touched and case.angle > 15.0:
        faults.append("missed")
    ghost = 0.0
    if case.kind.startswith("flat"):
        force = np.abs(result.barrier_force)
        ghost = float(force[:, 1].max() / max(force[:, 0].max(), 1.0))
        if not ghost < GHOST:
            faults.append("ghost")
    high = case.size == 5.0 or case.kind == "wall"
    if high and not (result.position[:, 0] < 0.0).all():
        faults.append("through")
    return Found(case, watched, ghost, tuple(faults))


def write(path: Path, found: Sequence[Found]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(
            [
                "kind",
                "runs",
                "touched",
                "node_depth_m",
                "anchor_depth_m",
                "energy",
                "momentum",
                "ghost",
                "faults",
            ]
        )
        for kind in KINDS:
            of = [f for f in found if f.case.kind == kind]
            if of:
                writer.writerow([text(cell) for cell in summary(kind, of)])


def summary(kind: str, of: Sequence[Found]) -> list[object]:
    worst = [
        max(getattr(f.watched, what) for f in of)
        for what in ("node_depth", "anchor_depth", "energy_residual", "momentum_residual")
    ]
    return [
        kind,
        len(of),
        sum(f.watched.touched for f in of),
        *worst,
        max(f.ghost for f in of),
        sum(bool(f.faults) for f in of),
    ]


def print_summary(found: Sequence[Found]) -> None:
    print(
        f"{'kind':18s}{'runs':>6s}{'touched':>8s}{'node':>11s}{'anchor':>11s}{'energy':>9s}{'momentum':>9s}{'ghost':>9s}{'faults':>7s}"
    )
    for kind in KINDS:
        of = [f for f in found if f.case.kind == kind]
        if not of:
            continue
        _, runs, touched, node, anchor, energy, momentum, ghost, faults = summary(kind, of)
        print(
            f"{kind:18s}{runs:6d}{touched:8d}{1e3 * float(str(node)):8.3f} mm",
            f"{1e3 * float(str(anchor)):7.3f} mm",
            end="",
        )
        print(f"{energy:9.1e}{momentum:9.1e}{ghost:9.1e}{faults:7d}")
    for fault, count in Counter(fault for f in found for fault in f.faults).most_common():
        first = [f.case.seed for f in found if fault in f.faults][:8]
        print(f"FAULT {fault}: {count}, seeds {first}")
    bad = [f for f in found if f.faults]
    for f in sorted(bad, key=lambda f: -f.watched.node_depth)[:10]:
        print(
            "worst",
            *(text(cell) for cell in asdict(f.case).values()),
            f"node {1e3 * f.watched.node_depth:.1f} mm",
            *f.faults,
        )
    print(f"{len(found)} impacts, {len(bad)} with a fault")


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--first", type=int, default=0, help="seed of the first")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--quick", action="store_true", help="48 impacts")
    parser.add_argument("--csv", type=Path, help="also write the summary there")
    parser.add_argument("--save", action="store_true", help="also write tests/bench/results/robustness")
    parser.add_argument("--any-pose", action="store_true", help="scenes in any pose, see random_scenes.py")
    parser.add_argument("--limit", type=float, default=60.0, help="s, of the run of a scene in any pose")
    asked = parser.parse_args(arguments)
    if asked.any_pose:
        table = asked.csv or ANY_POSE
        count = 48 if asked.quick else asked.count
        status = run_many(table, count, asked.first, asked.threads, asked.limit)
        if asked.save:
            write_summary(table, ANY_POSE_SUMMARY)
        return status
    # Coarse skins are what is tried here: what passes between nodes must still meet the rigid body.
    warnings.simplefilter("ignore", CoarseSkinWarning)
    seeds = range(asked.first, asked.first + (48 if asked.quick else asked.count))
    for name in VEHICLES:  # once, before threads ask for them
        for indents in (False, True):
            vehicle(name, indents)
    found = []
    with progress_bar(None, "impacts", len(seeds)) as advance, ThreadPoolExecutor(asked.threads) as pool:
        try:
            for one in pool.map(examine, seeds):
                found.append(one)
                advance(1)
        except KeyboardInterrupt:
            pool.shutdown(cancel_futures=True)
            print(f"stopped after {len(found)}", file=sys.stderr)
            return 130
    print_summary(found)
    for path in ([asked.csv] if asked.csv else []) + ([RESULTS] if asked.save else []):
        write(path, found)
    return 1 if any(f.faults for f in found) else 0


if __name__ == "__main__":
    sys.exit(main())
