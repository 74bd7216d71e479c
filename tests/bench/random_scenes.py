"""Random scenes in any pose: what one is drawn from, how it is judged, and the table of many.

Presets, some of them laden, at 0.01 to 120 m/s, in any direction, on their wheels, side or roof, on the
ground, with tolerances of 1 to 1e-7, against low, thin and endless walls, Jersey barriers, bollards, thin
posts, poles and meshes. From seed 10,000,000 on all are posts that yield. Called by bench_random_impacts.py;
the scene of a seed is the same on every machine.
"""

from __future__ import annotations

import csv
import math
import time
import warnings
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import asdict, dataclass, fields, replace
from functools import cache
from pathlib import Path

import numpy as np
from birm3d import BalanceWarning, Barrier, Foundation, Settings, Simulation, Vehicle
from birm3d.barrier.kinds import Bollards
from birm3d.base.progress import progress_bar
from birm3d.metrics import relative_to_start
from birm3d.result.energy_balance import ENERGY_LIMIT, FALL_LIMIT, warn_if_open

KINDS = ("low wall", "thin wall", "jersey", "bollards", "thin posts", "pole", "mesh", "wall")
PRESETS = ("passenger_car", "minivan", "pickup", "cargo_truck", "semi_truck", "paper_pickup")
YIELDING = 10_000_000  # seeds from here on
OFTEN = (0.25, 0.15, 0.25, 0.15, 0.05, 0.15)
DEEP = 0.05  # m, of the rigid body inside a barrier
CHUNK = 20


@dataclass(frozen=True)
class Drawn:
    """What a seed stands for; SI, degrees."""

    seed: int
    kind: str
    vehicle: str
    density: float
    load: float  # share of the gross mass that is added
    speed: float
    angle: float
    offset: float
    yaw: float
    roll: float
    friction: float
    tolerance: float
    restitution: float
    braking: float


@dataclass(frozen=True)
class Row(Drawn):
    """How its run went; energies relative to that at its disposal, see birm3d.result.energy_balance."""

    steps: int = 0
    seconds: float = 0.0
    energy: float = math.nan
    fall: float = math.nan
    falls: str = ""
    depth: float = math.nan
    warned: bool = False
    finished: bool = False
    refused: str = ""  # by a documented limit, which the message names
    fault: str = ""


@cache
def vehicle(name: str, density: float) -> Vehicle:
    return Vehicle.preset(name, mesh_density=density)


def _box(random: np.random.Generator, friction: float) -> Barrier:
    x, y, z = random.uniform(0.1, 0.6), random.uniform(0.3, 4.0), random.uniform(0.2, 1.5)
    slope = random.uniform(0.0, 0.3) * x
    vertices = [
        [(0.0 if i == 0 else x) + (0.0 if up == 0 else slope if i == 0 else -slope), side, (-1.0, z)[up]]
        for up in (0, 1)
        for side in (-y, y)
        for i in (0, 1)
    ]
    faces = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 4, 2), (2, 4, 6)]
    faces += [(1, 3, 5), (3, 7, 5), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7)]
    return Barrier.from_mesh(vertices, faces, friction=friction)


def _barrier(kind: str, random: np.random.Generator, friction: float) -> Barrier:
    def uniform(low: float, high: float) -> float:
        return float(random.uniform(low, high))

    if kind == "low wall":
        return Barrier.rigid_wall(
            width=uniform(0.5, 8.0),
            height=uniform(0.1, 0.6),
            thickness=uniform(0.05, 1.0),
            segments=int(random.integers(1, 4)),
            friction=friction,
        )
    if kind == "thin wall":
        thickness = 10.0 ** uniform(-2.5, -1.0)
        return Barrier.rigid_wall(
            width=uniform(0.5, 8.0), height=uniform(0.2, 2.0), thickness=thickness, friction=friction
        )
    if kind == "jersey":
        return Barrier.jersey(
            length=uniform(4.0, 30.0), segments=int(random.integers(1, 5)), friction=friction
        )
    if kind in ("bollards", "thin posts"):
        thin = kind == "thin posts"
        diameter = uniform(0.02, 0.1) if thin else uniform(0.1, 0.5)
        clear = uniform(0.1, 0.6) if thin else uniform(0.2, 1.5)
        return Barrier.bollards(
            count=int(random.integers(2, 15 if thin else 7)),
            diameter=diameter,
            height=uniform(0.2, 1.2),
            spacing=diameter + clear,
            friction=friction,
        )
    if kind == "pole":
        return Barrier.pole(diameter=uniform(0.1, 0.6), friction=friction)
    if kind == "mesh":
        return _box(random, friction)
    return Barrier.rigid_wall(friction=friction)


def _yielding(posts: Bollards, random: np.random.Generator) -> Bollards:
    """Return tubes instead of rigid posts, weak and strong ones, half of them in a foundation that turns."""
    foundation = Foundation(
        10.0 ** random.uniform(3.0, 6.5), random.uniform(0.0, 1.5), random.uniform(0, 3e3)
    )
    return replace(
        posts,
        wall_thickness=posts.diameter * random.uniform(0.01, 0.5),
        yield_stress=10.0 ** random.uniform(7.5, 9.0),
        filling="concrete" if random.random() < 0.3 else None,
        foundation=foundation if random.random() < 0.5 else None,
    )


def draw(seed: int) -> tuple[Drawn, Simulation]:
    """Return the scene of a seed, and what runs it."""
    random = np.random.default_rng([seed, 18])
    yields = seed >= YIELDING
    kind = ("bollards", "thin posts")[seed % 2] if yields else KINDS[seed % len(KINDS)]
    name = str(random.choice(PRESETS, p=OFTEN))
    density = float(random.choice([0.1, 0.2, 0.3]))
    load = float(random.choice([0.0, random.uniform(0.0, 0.4)]))
    friction = float(random.choice([0.0, random.uniform(0.0, 0.6)]))
    barrier = _barrier(kind, random, friction)
    if yields:
        assert isinstance(barrier, Bollards)
        barrier = _yielding(barrier, random)
    wide = random.random() < 0.3
    speed = math.exp(random.uniform(math.log(0.01), math.log(120.0))) if wide else random.uniform(3.0, 40.0)
    drawn = Drawn(
        seed,
        kind,
        name,
        density,
        load,
        float(speed),
        angle=float(random.choice([90.0, random.uniform(5.0, 90.0)])),
        offset=float(random.uniform(-1.5, 1.5)),
        yaw=float(random.choice([0.0, 90.0, random.uniform(-180.0, 180.0)], p=[0.5, 0.1, 0.4])),
        roll=float(
            random.choice([0.0, 90.0, -90.0, 180.0, random.uniform(-180, 180)], p=[0.3, 0.2, 0.1, 0.15, 0.25])
        ),
        friction=friction,
        tolerance=1e-3 if random.random() < 0.4 else float(10.0 ** random.uniform(-7.0, 0.0)),
        restitution=float(random.choice([0.1, random.uniform(0.0, 1.0)])),
        braking=float(random.choice([0.0, 1.0])),
    )
    car = vehicle(name, density)
    settings = Settings(tolerance=drawn.tolerance, restitution=drawn.restitution, braking=drawn.braking)
    simulation = Simulation(
        car.with_gvw((1.0 + load) * car.mass) if load > 0.0 else car,
        barrier,
        f"{drawn.speed} m/s",
        drawn.angle,
        drawn.offset,
        impact_yaw=drawn.yaw,
        impact_roll=drawn.roll,
        duration=min(max(6.0 / drawn.speed, 0.2), 1.0),
        settings=settings,
    )
    return drawn, simulation


class _OutOfTimeError(Exception):
    """A scene has used the processor for as long as it may."""


def _run(simulation: Simulation, latest: float) -> tuple[bool, str, str]:
    """Run to the end or the processor time `latest` [s]; return `finished`, `refused`, `fault`."""

    def check(_time: float, _steps: int) -> None:
        if time.process_time() > latest:
            raise _OutOfTimeError

    try:
        with simulation._core:
            simulation._core.run(check)
    except _OutOfTimeError:
        return False, "", ""
    except ValueError as error:
        # The one limit that a valid scene can reach: more steps than a record holds.
        if "that a record holds" in str(error):
            return False, str(error), ""
        return False, "", f"{type(error).__name__}: {error}"
    except Exception as error:
        return False, "", f"{type(error).__name__}: {error}"
    return True, "", ""


def examine(seed: int, limit: float = 60.0) -> Row:
    """Run the scene of a seed for `limit` seconds of processor time at the most, and judge it."""
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        drawn, simulation = draw(seed)
        start = time.process_time()  # other programs on the machine leave no scene unfinished
        finished, refused, fault = _run(simulation, start + limit)
        balances, scene = simulation._core.balances, simulation.scene
        warn_if_open(scene, balances)
    energy = relative_to_start(scene, balances.energy.size, balances.at_disposal)
    term, fall = max(
        (
            (name, relative_to_start(scene, f.size, balances.at_disposal))
            for name, f in balances.falls.items()
        ),
        key=lambda pair: pair[1],
    )
    warned = any(issubclass(one.category, BalanceWarning) for one in told)
    depth = simulation._core.statistics.deepest_point
    faults = [fault] if fault else []
    if energy > ENERGY_LIMIT and not warned:
        faults.append("energy in silence")
    if fall > FALL_LIMIT:
        faults.append(f"{term} falls")
    if depth > DEEP:  # the mass centre is no part of the body: a tractor may be crushed up to it
        faults.append("through")
    return Row(
        **asdict(drawn),
        steps=simulation._core.statistics.steps,
        seconds=round(time.process_time() - start, 3),
        energy=energy,
        fall=fall,
        falls=term,
        depth=depth,
        warned=warned,
        finished=finished,
        refused=refused,
        fault="; ".join(faults),
    )


def _examine_all(seeds: Sequence[int], limit: float) -> list[Row]:
    return [examine(seed, limit) for seed in seeds]


def _read(path: Path) -> list[dict[str, str]]:
    if not path.exists():
        return []
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def _chunks(seeds: Sequence[int]) -> Iterator[Sequence[int]]:
    for first in range(0, len(seeds), CHUNK):
        yield seeds[first : first + CHUNK]


def run_many(path: Path, count: int, first: int, processes: int, limit: float) -> int:
    """Append the scenes that `path` lacks, and print what was found. Return 1 if there was any fault."""
    known = {int(row["seed"]) for row in _read(path)}
    seeds = [seed for seed in range(first, first + count) if seed not in known]
    path.parent.mkdir(parents=True, exist_ok=True)
    names = [field.name for field in fields(Row)]
    with (
        path.open("a", encoding="utf-8", newline="") as file,
        progress_bar(None, "scenes", len(seeds)) as advance,
        ProcessPoolExecutor(processes) as pool,
    ):
        writer = csv.DictWriter(file, names, lineterminator="\n")
        if not known:
            writer.writeheader()
        jobs = [pool.submit(_examine_all, chunk, limit) for chunk in _chunks(seeds)]
        try:
            for job in as_completed(jobs):
                rows = job.result()
                writer.writerows(asdict(row) for row in rows)
                file.flush()
                advance(len(rows))
        except KeyboardInterrupt:
            pool.shutdown(cancel_futures=True)
            print(f"stopped; the same command goes on from {path}")
            return 130
    return print_faults(_read(path))


def summarised(rows: Sequence[dict[str, str]]) -> list[dict[str, object]]:
    """Return counts, percentiles and worst values of the scenes at each kind of barrier."""
    table: list[dict[str, object]] = []
    for kind in KINDS:
        of = [row for row in rows if row["kind"] == kind]
        if not of:
            continue
        energy, fall, depth, steps = (
            np.array([float(row[name]) for row in of]) for name in ("energy", "fall", "depth", "steps")
        )
        silent = np.array([row["warned"] == "False" for row in of])
        middle, most, nearly_all = np.percentile(energy, [50, 90, 99])
        table.append(
            {
                "kind": kind,
                "scenes": len(of),
                "warned": int(np.count_nonzero(~silent)),
                "unfinished": sum(row["finished"] == "False" and not row["refused"] for row in of),
                "refused": sum(bool(row["refused"]) for row in of),
                "faults": sum(bool(row["fault"]) for row in of),
                "energy_50": middle,
                "energy_90": most,
                "energy_99": nearly_all,
                "energy_worst_silent": energy[silent].max(initial=0.0),
                "energy_worst": energy.max(),
                "fall_worst": fall.max(),
                "depth_worst_m": depth.max(),
                "steps_50": int(np.median(steps)),
            }
        )
    return table


def write_summary(table: Path, path: Path) -> None:
    """Write the summary of a table of scenes."""
    rows = summarised(_read(table))
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        for row in rows:
            writer.writerow({k: f"{v:.3g}" if isinstance(v, float) else v for k, v in row.items()})


def print_faults(rows: Sequence[dict[str, str]]) -> int:
    print(
        f"{'kind':12s}{'scenes':>8s}{'warned':>8s}{'unfinished':>12s}{'refused':>9s}{'faults':>8s}"
        f"{'worst silent':>14s}"
    )
    for kind in KINDS:
        of = [row for row in rows if row["kind"] == kind]
        silent = [float(row["energy"]) for row in of if row["warned"] == "False"]
        print(
            f"{kind:12s}{len(of):8d}{sum(r['warned'] == 'True' for r in of):8d}"
            f"{sum(r['finished'] == 'False' and not r['refused'] for r in of):12d}"
            f"{sum(bool(r['refused']) for r in of):9d}{sum(bool(r['fault']) for r in of):8d}"
            f"{max(silent, default=0.0):14.2g}"
        )
    bad = [row for row in rows if row["fault"]]
    for fault, number in Counter(row["fault"] for row in bad).most_common():
        seeds = [row["seed"] for row in bad if row["fault"] == fault][:8]
        print(f"FAULT {fault}: {number}, seeds {', '.join(seeds)}")
    print(f"{len(rows)} scenes, {len(bad)} with a fault; --any-pose --count 1 --first SEED replays one")
    return 1 if bad else 0
