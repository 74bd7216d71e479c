"""What each instruction set gains: run times of builds that are limited to one of them.

    python tests/bench/bench_simd.py [--repeats 5] [--save]
    python tests/bench/bench_simd.py --quick

Two groups of loops are compiled for several instruction sets. The loops of kernels/*_simd.cpp are chosen by
cpp/src/kernels/simd_table.cpp. The plain loops over a block (BIRM3D_BLOCK_LOOP) are cloned by the compiler.
Each build limits both, or leaves out the clones. Builds take turns; a time is the shortest of all runs. The
bits of all builds are the same, see bench_determinism.py. --quick builds nothing and times what is installed.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from bench_determinism import build, run, write

RESULTS = Path(__file__).parent / "results/simd/simd.csv"
HEAD = ("build", "scene", "time_ms", "times_baseline")
PLAIN = "-DCMAKE_CXX_FLAGS=-DBIRM3D_PLAIN_BLOCKS"
BUILDS = {
    "baseline": ("-DBIRM3D_FASTEST_PATH=baseline",),
    "avx2, table only": ("-DBIRM3D_FASTEST_PATH=avx2", PLAIN),
    "avx2": ("-DBIRM3D_FASTEST_PATH=avx2",),
    "avx512, table only": ("-DBIRM3D_FASTEST_PATH=avx512", PLAIN),
    "avx512": ("-DBIRM3D_FASTEST_PATH=avx512",),
}
# A program of its own for each build, as each has a module of its own.
PROGRAM = """
import json, sys
from birm3d import Barrier, Settings, Simulation, Vehicle, scenes

car = Vehicle.preset("passenger_car")
chain = Barrier.jersey(length=60.0, segments=20, free_standing=True)
cases = {
    "W2, N = 10,000": scenes.w2(10000, Settings(gravity=0.0, ground=False, tolerance=0.1)),
    "car, wall at 25 deg": scenes.oblique_car(),
    "car, Jersey barrier": Simulation(car, Barrier.jersey(length=30.0), 25.0, 25.0),
    "pickup, bollards": Simulation(Vehicle.preset("pickup"), Barrier.bollards(), 20.0, 90.0),
    "car, 20 free-standing segments": Simulation(car, chain, 20.0, 25.0),
}
cases = dict(list(cases.items())[: int(sys.argv[1])])
print(json.dumps({name: min(case.run().run_time for _ in range(6)) for name, case in cases.items()}))
"""


def shortest(packages: Mapping[str, Path | None], repeats: int, scenes: int) -> dict[str, dict[str, float]]:
    """Return the shortest time of each scene with each build [s]; builds take turns."""
    best: dict[str, dict[str, float]] = {name: {} for name in packages}
    for _ in range(repeats):
        for name, package in packages.items():
            more = {} if package is None else {"PYTHONPATH": str(package)}
            times: dict[str, float] = json.loads(run([sys.executable, "-c", PROGRAM, str(scenes)], more))
            for scene, time in times.items():
                best[name][scene] = min(time, best[name].get(scene, time))
    return best


def main(arguments: Sequence[str] | None = None) -> int:
    """Build, time, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--repeats", type=int, default=5, help="turns of all builds")
    parser.add_argument("--quick", action="store_true", help="what is installed, one scene, once")
    parser.add_argument("--save", action="store_true", help="also write tests/bench/results/simd")
    options = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as folder:
        packages: dict[str, Path | None] = {"installed": None}
        if not options.quick:
            compiler = [os.environ.get("CXX", "c++")]
            packages = {
                name: build(Path(folder, f"tree{i}"), Path(folder, f"package{i}"), compiler, *changes)
                for i, (name, changes) in enumerate(BUILDS.items())
            }
        best = shortest(packages, 1 if options.quick else options.repeats, 1 if options.quick else 99)
    first = next(iter(best))
    rows = [
        (name, scene, f"{1e3 * time:.3g}", f"{best[first][scene] / time:.2f}")
        for name, of in best.items()
        for scene, time in of.items()
    ]
    for row in rows:
        print(f"{row[0]:20s} {row[1]:32s} {row[2]:>6s} ms  {row[3]} times {first}")
    if options.save:
        write(RESULTS, HEAD, rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
