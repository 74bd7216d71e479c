"""The same bits from every compiler, optimisation, instruction set, number of threads and order of runs.

    python tests/bench/bench_determinism.py [--compilers g++ clang++] [--native] [--save]

Builds the Python module anew for each compiler that is installed with -O3 and -O0, and with -O3 for each
instruction set to choose from; runs the same scenes with each, alone, as ensembles on one and two threads and
backwards, and interrupted and restored at twenty instants; and compares the hashes of their last states. Ends
with 1 if any differs. With --native a build for this very machine is timed against the one that is shipped,
in turns; its bits are its own affair.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
RESULTS = Path(__file__).parent / "results/robustness/determinism.csv"
RESTORED = 20
PORTABLE = "-O3"

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
TIMED = """
from birm3d import scenes, Settings
cases = {f"W2, N = {n:,}": scenes.w2(n, Settings(gravity=0.0, ground=False, tolerance=0.1))
         for n in (1000, 10000)}
cases["oblique car"] = scenes.oblique_car()
import json
print(json.dumps({name: min(case.run().run_time for _ in range(15)) for name, case in cases.items()}))
"""


def build(place: Path, compiler: str, *options: str) -> Path:
    """Build the module and return the folder to import the package from."""
    tree, package = place / "build", place / "python"
    command = ["cmake", "-S", ROOT, "-B", tree, "-DBIRM3D_BUILD_PYTHON=ON", "-DBIRM3D_BUILD_TESTS=OFF"]
    command += ["-DBIRM3D_WARNINGS_AS_ERRORS=OFF", f"-DPython_EXECUTABLE={sys.executable}", *options]
    environment = {**os.environ, "CXX": compiler}
    subprocess.run(command, check=True, env=environment, stdout=subprocess.DEVNULL)
    subprocess.run(
        ["cmake", "--build", tree, "--parallel", str(os.cpu_count() or 1)],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    shutil.copytree(ROOT / "python", package, ignore=shutil.ignore_patterns("_core*.so", "__pycache__"))
    (module,) = tree.glob("bindings/_core*.so")
    shutil.copy(module, package / "birm3d")
    shutil.rmtree(tree)
    return package


def told(package: Path, program: str, *arguments: str) -> dict[str, dict[str, str]]:
    """Run a program with one of the builds and return what it prints."""
    environment = {**os.environ, "PYTHONPATH": str(package)}
    done = subprocess.run(
        [sys.executable, "-c", program, *arguments],
        check=True,
        env=environment,
        capture_output=True,
        text=True,
    )
    found: dict[str, dict[str, str]] = json.loads(done.stdout)
    return found


def main() -> int:
    """Build, run, compare, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--compilers", nargs="+", default=["g++", "clang++"])
    parser.add_argument("--native", action="store_true", help="also time a build for this machine")
    parser.add_argument("--save", action="store_true", help=f"also write {RESULTS.relative_to(ROOT)}")
    options = parser.parse_args()

    rows: list[tuple[str, str, str, str]] = []
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        for compiler in options.compilers:
            if shutil.which(compiler) is None:
                print(f"{compiler} is not installed")
                continue
            builds = {PORTABLE: [], "-O0": ["-DCMAKE_BUILD_TYPE=Debug"]}
            for path in ("avx2", "baseline"):
                builds[f"{PORTABLE}, up to {path}"] = [f"-DBIRM3D_FASTEST_PATH={path}"]
            for name, changes in builds.items():
                print(f"{compiler} {name} ...", flush=True)
                package = build(place / f"{compiler}{len(rows)}", compiler, *changes)
                for way, found in told(package, PROGRAM, str(RESTORED)).items():
                    rows += [(f"{compiler} {name}", way, scene, bits) for scene, bits in found.items()]
        if options.native:
            compiler = options.compilers[0]
            shipped = build(place / "shipped", compiler)
            native = build(place / "native", compiler, "-DCMAKE_CXX_FLAGS=-march=native")
            turns = [(told(shipped, TIMED), told(native, TIMED)) for _ in range(5)]
            for case in turns[0][0]:
                ours, theirs = (min(float(turn[i][case]) for turn in turns) for i in range(2))
                times = f"portable {1e3 * ours:.3f} ms, native {1e3 * theirs:.3f} ms"
                print(f"{case:16s} {times}: {ours / theirs:.2f}")

    different = 0
    for scene in dict.fromkeys(row[2] for row in rows):
        bits = {row[3] for row in rows if row[2] == scene}
        different += len(bits) > 1
        print(f"{scene:26s} {len([1 for row in rows if row[2] == scene])} runs: {' '.join(sorted(bits))}")
    if options.save:
        with RESULTS.open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["build", "way", "scene", "hash"])
            writer.writerows(rows)
    print("the same bits" if not different else f"DIFFERENT in {different} scenes")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
