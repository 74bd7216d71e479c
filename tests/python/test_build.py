"""The C++ library as a C++ user meets it: build, test, install, and use from a separate project."""

import os
import platform
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import birm3d
import pytest

ROOT = Path(__file__).resolve().parents[2]
JOBS = str(os.cpu_count() or 1)


def tool(name: str) -> str:
    """Path of a build tool, first among the scripts of this environment, which need not be activated."""
    found = shutil.which(name, path=sysconfig.get_path("scripts")) or shutil.which(name)
    assert found, f"{name} is missing; pip install '.[test]' brings it"
    return found


def run(*command: str | Path) -> str:
    """Output of a command; its full text if it fails."""
    words = [str(c) for c in command]
    done = subprocess.run(
        words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    if done.returncode != 0:
        pytest.fail(f"{' '.join(words)}\nexit status {done.returncode}\n{done.stdout}", pytrace=False)
    return done.stdout


def configure(source: Path, build: Path, *options: str) -> None:
    # Python_EXECUTABLE: Eigen may be the wheel of this environment.
    run(
        tool("cmake"), "-S", source, "-B", build, "-G", "Ninja",
        f"-DCMAKE_MAKE_PROGRAM={tool('ninja')}", f"-DPython_EXECUTABLE={sys.executable}", *options,
    )  # fmt: skip


@pytest.fixture(scope="module")
def build_tree(tmp_path_factory: pytest.TempPathFactory) -> Path:
    build = tmp_path_factory.mktemp("core") / "build"
    configure(ROOT, build)
    run(tool("cmake"), "--build", build, "--parallel", JOBS)
    return build


@pytest.fixture(scope="module")
def prefix(build_tree: Path) -> Path:
    target = build_tree.parent / "prefix"
    run(tool("cmake"), "--install", build_tree, "--prefix", target)
    return target


def test_cpp_tests_pass(build_tree: Path) -> None:
    output = run(
        tool("ctest"), "--test-dir", build_tree, "--output-on-failure", "--no-tests=error", "--parallel", JOBS
    )
    assert "100% tests passed" in output


def test_install_holds_exactly_the_library(prefix: Path) -> None:
    installed = {p.relative_to(prefix).as_posix() for p in prefix.rglob("*") if p.is_file()}
    headers = {p.relative_to(ROOT / "cpp").as_posix() for p in (ROOT / "cpp/include").rglob("*.hpp")}
    assert headers <= installed
    others = {p.split("/", 1)[1] for p in installed - headers}  # lib or lib64
    assert {p for p in others if not p.startswith("cmake/birm3d/")} == {"libbirm3d_core.a"}
    assert "cmake/birm3d/birm3dConfig.cmake" in others


def test_installed_files_name_no_path_of_this_machine(prefix: Path) -> None:
    for path in prefix.rglob("*.cmake"):
        text = path.read_text(encoding="utf-8")
        for place in (ROOT, prefix.parent, Path(sys.prefix)):
            assert str(place) not in text, f"{path.name} names {place}"


def test_example_uses_the_installed_library(prefix: Path, tmp_path: Path) -> None:
    source = shutil.copytree(ROOT / "examples/cpp", tmp_path / "example")  # away from the source tree
    build = tmp_path / "build"
    configure(source, build, f"-DCMAKE_PREFIX_PATH={prefix}")
    run(tool("cmake"), "--build", build)
    assert run(build / "birm3d_example").strip()
    car, semi = ("passenger_car", 0.3, 15.0, 60.0), ("semi_truck", 0.05, 8.0, 20.0)
    for name, density, speed, angle in (car, semi, ("cargo_truck", 0.2, 12.0, 60.0)):
        vehicle = birm3d.Vehicle.preset(name, mesh_density=density)
        vehicle.export_core(tmp_path / name)
        ours = birm3d.Simulation(vehicle, birm3d.Barrier.rigid_wall(), speed, angle).run()
        printed = run(build / "birm3d_from_file", tmp_path / name, str(speed), str(angle))
        assert f"state hash {ours.state_hash:016x}" in printed


@pytest.mark.skipif(shutil.which("doxygen") is None, reason="doxygen is no package of Python's")
def test_doxygen_reads_the_public_headers(tmp_path: Path) -> None:
    """A warning is an error."""
    settings = (ROOT / "docs/Doxyfile").read_text(encoding="utf-8")
    (tmp_path / "Doxyfile").write_text(f"{settings}OUTPUT_DIRECTORY = {tmp_path}\n", encoding="utf-8")
    assert run("sh", "-c", f"cd '{ROOT}' && doxygen '{tmp_path / 'Doxyfile'}'") == ""
    page = (tmp_path / "html/structbirm3d_1_1Settings.html").read_text(encoding="utf-8")
    assert "tyre-pavement friction coefficient" in page  # a comment behind a member


def test_library_inside_another_project_brings_no_tests(tmp_path: Path) -> None:
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.24)\n"
        "project(outer LANGUAGES CXX)\n"
        f'add_subdirectory("{ROOT.as_posix()}" birm3d)\n'
        "if(BIRM3D_BUILD_TESTS OR NOT TARGET birm3d::core)\n"
        '  message(FATAL_ERROR "tests are on, or birm3d::core is missing")\n'
        "endif()\n",
        encoding="utf-8",
    )
    configure(tmp_path, tmp_path / "build")


def test_flags_for_one_machine_leave_every_instruction_set_its_name(tmp_path: Path) -> None:
    """CXXFLAGS=-march=native adds instructions to all files; which of them a file is for, the build says."""
    if platform.machine() not in ("x86_64", "AMD64"):
        pytest.skip("there is one instruction set")
    made = tmp_path / "rows.o"
    compiler = [
        tool("c++"),
        "-std=c++20",
        "-c",
        "-mavx512f",
        f"-I{ROOT / 'cpp/include'}",
        f"-I{ROOT / 'cpp/src'}",
    ]
    kernels = {
        "crush": "press_flat",
        "detect": "ask_prism",
        "friction": "find_friction",
        "indentation": "find_indentation",
    }
    for kernel, function in kernels.items():
        source = ROOT / f"cpp/src/kernels/{kernel}_simd.cpp"
        for definition, name in (("-DOTHER", "baseline"), ("-DBIRM3D_INSTRUCTION_SET=avx2", "avx2")):
            run(*compiler, definition, source, "-o", made)
            symbols = run(tool("nm"), "-C", made).splitlines()
            assert any(f" T birm3d::{name}::{function}(" in symbol for symbol in symbols)
            # What files for several instruction sets share, the linker takes from one of them.
            assert [s for s in symbols if " W " in s and f"birm3d::{name}::" not in s] == []
