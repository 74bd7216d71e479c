"""The C++ library on 64-bit ARM: its tests, and the same state hashes as on this machine.

    apt-get install g++-aarch64-linux-gnu qemu-user     # Debian's cross compiler and user-mode emulation
    python tests/bench/bench_aarch64.py [--build FOLDER] [--tests REGEX]

Builds the library and its tests with the cross compiler, and runs the tests under emulation. Ends with 1 if
one fails, and with 2 where compiler or emulator is not installed. An emulated test takes ten times as long as
a native one; --tests runs those whose names match.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TOOLCHAIN = Path(__file__).resolve().with_name("aarch64.cmake")
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
    return 0


if __name__ == "__main__":
    sys.exit(main())
