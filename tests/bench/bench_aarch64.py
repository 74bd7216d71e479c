"""The C++ library on 64-bit ARM: its tests, and the same state hashes as on this machine.

    apt-get install g++-aarch64-linux-gnu qemu-user     # Debian's cross compiler and user-mode emulation
    python tests/bench/bench_aarch64.py [--build FOLDER] [--tests REGEX]

Builds the library, its tests and the C++ examples with the cross compiler, and runs the tests under
emulation. Then vehicles prepared in Python run into a wall with both: the installed module on this machine,
and the example under emulation. Their state hashes must be equal. Ends with 1 if a test fails or a hash
differs, and with 2 where compiler or emulator is not installed. An emulated test takes ten times as long as a
native one; --tests runs those whose names match.
"""

from __future__ import annotations

import argparse
import os
import platform
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Sequence
from pathlib import Path

import birm3d

ROOT = Path(__file__).resolve().parents[2]
TOOLCHAIN = Path(__file__).resolve().with_name("aarch64.cmake")
EMULATOR = ("qemu-aarch64", "-L", "/usr/aarch64-linux-gnu")
SCENES = (
    ("passenger_car", 0.3, 15.0, 60.0),
    ("pickup", 0.2, 20.0, 90.0),
    ("cargo_truck", 0.1, 12.0, 25.0),
    ("semi_truck", 0.05, 8.0, 20.0),
)
"""Preset, mesh density, speed [m/s], angle to the wall [deg]."""
NEEDED = ("aarch64-linux-gnu-g++", "qemu-aarch64", "cmake", "ninja")


def run(*command: str | Path) -> None:
    """Run a command; where it fails, stop with its status."""
    print("+", *command, flush=True)
    done = subprocess.run(command, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        sys.exit(1)


def build(folder: Path, *options: str) -> None:
    """Build library and tests in a folder."""
    eigen = Path(sysconfig.get_path("purelib"), "cmeel.prefix")
    run(
        *("cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release"),
        *("-DBIRM3D_BUILD_TESTS=ON", f"-DCMAKE_PREFIX_PATH={eigen}", *options),
    )
    run("cmake", "--build", folder, "--parallel", str(os.cpu_count() or 1))


def compare_hashes(folder: Path) -> int:
    """Run the same scenes on both processors; return how many differ."""
    prefix, examples = folder / "prefix", folder / "examples"
    run("cmake", "--install", folder, "--prefix", prefix, "--component", "core")
    eigen = Path(sysconfig.get_path("purelib"), "cmeel.prefix")
    options = (f"-DCMAKE_TOOLCHAIN_FILE={TOOLCHAIN}", f"-DCMAKE_PREFIX_PATH={prefix};{eigen}")
    run("cmake", "-S", ROOT / "examples/cpp", "-B", examples, "-G", "Ninja", *options)
    run("cmake", "--build", examples)
    different = 0
    for name, density, speed, angle in SCENES:
        vehicle = birm3d.Vehicle.preset(name, mesh_density=density)
        file = folder / f"{name}.txt"
        vehicle.export_core(file)
        here = birm3d.Simulation(vehicle, birm3d.Barrier.rigid_wall(), speed, angle).run().state_hash
        program = [*EMULATOR, str(examples / "birm3d_from_file"), str(file), repr(speed), repr(angle)]
        printed = subprocess.run(program, capture_output=True, text=True, check=True).stdout
        there = int(printed.rsplit(maxsplit=1)[-1], 16)
        different += here != there
        print(f"{name:15s} {platform.machine()} {here:016x}  aarch64 {there:016x}")
    return different


def main(arguments: Sequence[str] | None = None) -> int:
    """Build, run, compare."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--build", type=Path, help="folder to keep the build in (default: a temporary one)")
    parser.add_argument("--tests", default=".", help="regular expression of the tests to run (default: all)")
    options = parser.parse_args(arguments)
    missing = [name for name in NEEDED if shutil.which(name) is None]
    if missing:
        print(f"not installed: {', '.join(missing)}")
        return 2
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.build or Path(temporary)
        build(folder, f"-DCMAKE_TOOLCHAIN_FILE={TOOLCHAIN}")
        run("ctest", "--test-dir", folder, "--output-on-failure", "--timeout", "3000", "-R", options.tests)
        different = compare_hashes(folder)
    print("the same bits" if not different else f"DIFFERENT in {different} scenes")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
