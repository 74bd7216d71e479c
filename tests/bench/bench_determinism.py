"""The same bits from every compiler, optimisation, instruction set, number of threads and order of runs.

    python tests/bench/bench_determinism.py [--clang COMMAND] [--native] [--save]
    python tests/bench/bench_determinism.py --quick

Builds the Python module anew for each compiler with -O3 and -O0, and with -O3 for each instruction set to
choose from; runs the same scenes with each, alone, as ensembles on one and two threads and backwards, and
interrupted and restored at random instants (twenty; with -O0 three); and compares the hashes of their last
states. Ends with 1 if any differs. With --native a build for this very machine is timed against the one that
is shipped, in turns; its bits may differ. --quick builds nothing: three scenes with the module that
is installed.

Where there is no clang, that of the Python package ziglang will do, told to make what is shipped:

    --clang "python -m ziglang c++ -target x86_64-linux-gnu -mcpu=x86_64 -fno-sanitize=undefined"
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).parents[2]
RESULTS = Path(__file__).parent / "results/determinism"
HEAD = ("build", "way", "scene", "hash")
PORTABLE = "-O3"
COMPILERS = ("gcc", "clang")
# How it is built: in which tree, with what (those that share a tree build anew only what differs); and at how
# many instants each scene is restored. With -O0, where a step takes many times as long, it is the arithmetic
# that is compared.
BUILDS = {
    PORTABLE: ("release", ["-DBIRM3D_FASTEST_PATH=avx512"], 20),
    f"{PORTABLE}, up to avx2": ("release", ["-DBIRM3D_FASTEST_PATH=avx2"], 20),
    f"{PORTABLE}, up to baseline": ("release", ["-DBIRM3D_FASTEST_PATH=baseline"], 20),
    "-O0": ("debug", ["-DCMAKE_BUILD_TYPE=Debug"], 3),
}

# What is run with each build; a program of its own, as each has a module of its own.
PROGRAM = """
import json, random, sys
from concurrent.futures import ThreadPoolExecutor
import birm3d
from birm3d import Barrier, Simulation, Vehicle, scenes
from birm3d.study.triangulated import triangulated

def car(name, density=0.2):
    return Vehicle.preset(name, mesh_density=density)

made = {
    "w2": lambda: scenes.w2(1000),
    "oblique car": lambda: scenes.oblique_car(mesh_density=0.3),
    "pickup, bollards": lambda: Simulation(car("pickup"), Barrier.bollards(), 20.0, 80.0, 0.2),
    "car, Jersey": lambda: Simulation(car("passenger_car"), Barrier.jersey(length=30.0), 25.0, 25.0),
    "semi, wall": lambda: Simulation(car("semi_truck"), Barrier.rigid_wall(), 15.0, 15.0, duration=0.5),
    "truck, pole of triangles": lambda: Simulation(
        car("cargo_truck"), triangulated(Barrier.pole()), 12.0, 90.0, duration=0.3),
    "free-standing": lambda: Simulation(
        car("passenger_car"), Barrier.jersey(length=18.0, segments=6, free_standing=True), 20.0, 25.0),
}
made = dict(list(made.items())[: int(sys.argv[2])])
hashes = {"alone": {name: f"{make().run().state_hash:016x}" for name, make in made.items()}}
def ensemble(names, threads):
    with ThreadPoolExecutor(threads) as pool:
        study = birm3d.ensemble([made[name] for name in names], metrics=["steps"], executor=pool)
    return dict(zip(names, study.state_hash))
names = list(made)
hashes["one thread"] = ensemble(names, 1)
hashes["two threads"] = ensemble(names, 2)
hashes["backwards"] = ensemble(names[::-1], 2)
restored = {}
for name, make in made.items():
    simulation = make()
    steps = simulation.run().statistics.steps
    found = set()
    for at in sorted(random.Random(1).sample(range(steps), min(int(sys.argv[1]), steps))):
        simulation.reset()
        for _ in range(at):
            simulation.step()
        checkpoint = simulation.snapshot()
        for _ in range(3):
            simulation.step()
        other = make()
        other.restore(checkpoint)
        found.add(f"{other.run().state_hash:016x}")
    restored[name] = "/".join(sorted(found))
hashes["restored"] = restored
print(json.dumps(hashes))
"""
# The shortest of many, as the machine has other things to do.
TIMED = """
import json
from birm3d import scenes, Settings
cases = {f"W2, N = {n:,}": scenes.w2(n, Settings(gravity=0.0, ground=False, tolerance=0.1))
         for n in (1000, 10000)}
cases["oblique car"] = scenes.oblique_car()
print(json.dumps({name: min(case.run().run_time for _ in range(30)) for name, case in cases.items()}))
"""


def build(tree: Path, package: Path, compiler: Sequence[str], *options: str) -> Path:
    """Build the module in a tree, which may be of another build, and return the folder to import from."""
    tree.mkdir(parents=True, exist_ok=True)
    wrapper = tree / "compiler"  # one word, whatever the command
    if not wrapper.exists():
        wrapper.write_text(f'#!/bin/sh\nexec {shlex.join(compiler)} "$@"\n', encoding="utf-8")
        wrapper.chmod(0o755)
    command = ["cmake", "-S", ROOT, "-B", tree, "-DBIRM3D_BUILD_PYTHON=ON", "-DBIRM3D_BUILD_TESTS=OFF"]
    command += ["-DBIRM3D_WARNINGS_AS_ERRORS=OFF", f"-DPython_EXECUTABLE={sys.executable}", *options]
    if (
        shutil.which("ninja") is not None
    ):  # make would build all of a library anew where one file's flags change
        command += ["-G", "Ninja"]
    run(command, {"CXX": str(wrapper)})
    run(["cmake", "--build", tree, "--parallel", str(os.cpu_count() or 1)])
    shutil.copytree(ROOT / "python", package, ignore=shutil.ignore_patterns("_core*.so", "__pycache__"))
    (module,) = tree.glob("bindings/_core*.so")
    shutil.copy(module, package / "birm3d")
    return package


def run(command: Sequence[str | Path], more: dict[str, str] | None = None) -> str:
    """Run a command and return what it prints; if it fails, show what it said and stop."""
    done = subprocess.run(command, env={**os.environ, **(more or {})}, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{command[0]} {command[1]} ...: {done.stdout[-3000:]}{done.stderr[-3000:]}")
    return done.stdout


def told(package: Path | None, program: str, *arguments: str) -> dict[str, dict[str, str]]:
    """Run a program with one of the builds and return what it prints."""
    more = {} if package is None else {"PYTHONPATH": str(package)}
    found: dict[str, dict[str, str]] = json.loads(run([sys.executable, "-c", program, *arguments], more))
    return found


def rows_of(build_name: str, package: Path | None, restored: int, scenes: int) -> list[tuple[str, ...]]:
    """Return build, way, scene and hash of all runs with one build."""
    found = told(package, PROGRAM, str(restored), str(scenes))
    return [(build_name, way, scene, bits) for way, of in found.items() for scene, bits in of.items()]


def compare_times(shipped: Path, native: Path) -> list[tuple[str, float, float]]:
    """Return case and the shortest times of both [s], which take turns."""
    turns = [(told(shipped, TIMED), told(native, TIMED)) for _ in range(7)]
    return [(case, *(min(float(turn[i][case]) for turn in turns) for i in (0, 1))) for case in turns[0][0]]


def write(path: Path, head: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
    """Write a table."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(head)
        writer.writerows(rows)


def main(arguments: Sequence[str] | None = None) -> int:
    """Build, run, compare, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--gcc", metavar="COMMAND", default="g++", help="the first compiler")
    parser.add_argument("--clang", metavar="COMMAND", default="clang++", help="the second")
    parser.add_argument("--only", nargs="+", choices=COMPILERS, help="not both (default: both)")
    parser.add_argument("--native", action="store_true", help="also time a build for this machine")
    parser.add_argument(
        "--quick", action="store_true", help="what is installed, three scenes, three instants"
    )
    parser.add_argument("--save", action="store_true", help=f"also write {RESULTS.relative_to(ROOT)}")
    options = parser.parse_args(arguments)

    rows: list[tuple[str, ...]] = []
    times: list[tuple[str, float, float]] = []
    if options.quick:
        rows = rows_of("installed", None, 3, 3)
    with tempfile.TemporaryDirectory() as folder:
        for name in () if options.quick else options.only or COMPILERS:
            compiler = shlex.split(getattr(options, name))
            if shutil.which(compiler[0]) is None:
                print(f"{compiler[0]} is not installed")
                continue
            packages = {}
            for way, (tree, changes, restored) in BUILDS.items():
                print(f"{name} {way} ...", flush=True)
                place = Path(folder, f"{name}{len(rows)}")
                packages[way] = build(Path(folder, name + tree), place, compiler, *changes)
                rows += rows_of(f"{name} {way}", packages[way], restored, 99)
                if options.save:  # now, in case a later build fails
                    write(RESULTS / "hashes.csv", HEAD, rows)
            if options.native and not times:
                print(f"{name} native ...", flush=True)
                change = "-DCMAKE_CXX_FLAGS=-march=native"
                native = build(Path(folder, "native"), Path(folder, "of_native"), compiler, change)
                times = compare_times(packages[PORTABLE], native)

    different = 0
    for scene in dict.fromkeys(row[2] for row in rows):
        bits = {row[3] for row in rows if row[2] == scene}
        different += len(bits) > 1
        print(f"{scene:26s} {len([1 for row in rows if row[2] == scene])} rows: {' '.join(sorted(bits))}")
    for case, ours, theirs in times:
        took = f"portable {1e3 * ours:.3f} ms, native {1e3 * theirs:.3f} ms"
        print(f"{case:16s} {took}: {ours / theirs:.2f}")
    if options.save:
        write(RESULTS / "hashes.csv", HEAD, rows)
        if times:
            cells = [(case, f"{1e3 * a:.4g}", f"{1e3 * b:.4g}", f"{a / b:.2f}") for case, a, b in times]
            write(RESULTS / "native.csv", ["case", "portable_ms", "native_ms", "ratio"], cells)
    print("the same bits" if not different else f"DIFFERENT in {different} scenes")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
