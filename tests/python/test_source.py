"""Which code made a result: hashes of the sources, commits of checkouts and archives, and who shows them."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace

import birm3d
import pytest
from birm3d import _source
from birm3d._source import RECORD, Source, installed_source, shortened
from birm3d.io.made_with import code_to_install, facts_text, platform_facts

ROOT = Path(__file__).resolve().parents[2]
OLD_RESULT = ROOT / "tests/data/results/bollards_0_1_0.npz"
FILES = {
    "CMakeLists.txt": "project(a)\n",
    "cpp/src/a.cpp": "int a = 1;\n",
    "bindings/module.cpp": "int b = 1;\n",
    "python/birm3d/a.py": "a = 1\n",
    "python/birm3d/data/car.toml": "gvw_kg = 1.0\n",
    "README.md": "A page.\n",
    ".git_archival.txt": "commit: $Format:%H$\n",
    ".gitattributes": ".git_archival.txt export-subst\n",
}


def git(root: Path, *arguments: str) -> str:
    who = ("-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false")
    command = ["git", *who, "-C", str(root), *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A small tree of sources with the script of the package."""
    root = tmp_path / "tree"
    for name, content in FILES.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(content, encoding="utf-8")
    shutil.copy(ROOT / "python/birm3d/_source.py", root / "python/birm3d")
    return root


def record_of(root: Path) -> dict[str, str | None]:
    """What a build of a tree writes."""
    made = root.parent / "record.json"
    script = root / "python/birm3d/_source.py"
    subprocess.run([sys.executable, "-I", str(script), str(made)], check=True)
    found: dict[str, str | None] = json.loads(made.read_text(encoding="utf-8"))
    return found


@pytest.mark.parametrize(
    ("name", "changed"),
    [
        ("CMakeLists.txt", "cpp"),
        ("cpp/src/a.cpp", "cpp"),
        ("cpp/src/new.hpp", "cpp"),
        ("bindings/module.cpp", "cpp"),
        ("python/birm3d/a.py", "package"),
        ("python/birm3d/data/car.toml", "package"),
        ("README.md", None),
        ("python/birm3d/__pycache__/a.cpython-311.pyc", None),
    ],
)
def test_hash_is_that_of_the_sources(tree: Path, name: str, changed: str | None) -> None:
    before = record_of(tree)
    path = tree / name
    path.parent.mkdir(exist_ok=True)
    path.write_text("other\n", encoding="utf-8")
    after = record_of(tree)
    assert {key for key in before if before[key] != after[key]} == ({changed} if changed else set())


def test_a_moved_file_is_another_source(tree: Path) -> None:
    before = record_of(tree)
    (tree / "cpp/src/a.cpp").rename(tree / "cpp/src/b.cpp")
    assert record_of(tree)["cpp"] != before["cpp"]


def test_commit_of_a_checkout_and_of_an_archive(tree: Path, tmp_path: Path) -> None:
    assert record_of(tree)["commit"] is None
    git(tree, "init", "--quiet")
    git(tree, "add", "--all")
    git(tree, "commit", "--quiet", "--message", "a")
    commit = git(tree, "rev-parse", "HEAD")
    assert record_of(tree)["commit"] == commit
    (tree / "README.md").write_text("Another page.\n", encoding="utf-8")
    assert record_of(tree)["commit"] == commit  # is no source
    (tree / "cpp/src/a.cpp").write_text("int a = 2;\n", encoding="utf-8")
    assert record_of(tree)["commit"] == f"{commit} with changes"
    within = tree / "within"  # unpacked in the checkout of something else
    shutil.copytree(tree / "python", within / "python")
    assert record_of(within)["commit"] is None
    git(tree, "archive", "--output", str(tmp_path / "a.tar"), "HEAD")
    archive = tmp_path / "archive"
    shutil.unpack_archive(tmp_path / "a.tar", archive)
    assert record_of(archive)["commit"] == commit


@pytest.fixture
def module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A compiled module in a folder of its own, which may have a record beside it."""
    path = tmp_path / "_core.so"
    path.write_bytes(b"compiled")
    monkeypatch.setattr(_source, "find_spec", lambda name: SimpleNamespace(origin=str(path)))
    installed_source.cache_clear()
    yield path
    monkeypatch.undo()
    installed_source.cache_clear()


def written(module: Path, **changes: str | None) -> Source:
    built = {"cpp": "0" * 32, "package": _source._package_digest(_source._PACKAGE), "commit": "c" * 40}
    module.with_name(RECORD).write_text(json.dumps(built | changes), encoding="utf-8")
    installed_source.cache_clear()
    return installed_source()


def test_source_of_an_installed_package(module: Path) -> None:
    alone = installed_source()
    assert alone.commit is None
    built = written(module)
    assert built.commit == "c" * 40
    assert built.digest != alone.digest
    assert written(module, cpp="1" * 32).digest != built.digest
    assert written(module, commit=None).commit is None
    other = written(module, package="2" * 32)  # Python files were changed after the build
    assert other == (built.digest, f"{'c' * 40} with changes")
    assert str(other) == f"source {built.digest[:12]}, commit {'c' * 12} with changes"
    module.with_name(RECORD).unlink()
    module.write_bytes(b"compiled again")
    installed_source.cache_clear()
    assert installed_source().digest != alone.digest


@pytest.mark.skipif(
    Path(birm3d.__file__).parents[1] == ROOT / "python", reason="the module was put beside the sources"
)
def test_an_installed_package_knows_the_sources_of_its_build() -> None:
    path = Path(str(birm3d._core.__file__)).with_name(RECORD)
    record = json.loads(path.read_text(encoding="utf-8"))
    assert record["cpp"] == _source._cpp_digest(ROOT)
    assert record["package"] == _source._package_digest(ROOT / "python/birm3d")


def test_version_names_the_source(command: Callable[..., int], capsys: pytest.CaptureFixture[str]) -> None:
    assert command("--version") == 0
    source = installed_source()
    assert capsys.readouterr().out == f"birm3d {birm3d.__version__}, {source}\n"
    assert shortened(source.digest) == source.digest[:12]


def test_results_keep_who_computed_them(tmp_path: Path) -> None:
    result = birm3d.scenes.w1(20).run()
    assert dict(result.made_with) == platform_facts()
    assert result.made_with["source"] == installed_source().digest
    result._made_with = {**platform_facts(), "source": "5" * 32}
    del result.__dict__["made_with"]
    result.save(tmp_path / "a.npz")
    birm3d.load(tmp_path / "a.npz").save(tmp_path / "b.npz")
    again = birm3d.load(tmp_path / "b.npz")
    assert again.made_with["source"] == "5" * 32
    assert again.version == birm3d.__version__


def test_what_to_install_for_the_same_bits() -> None:
    facts = {"birm3d": "0.1.0", "source": "a" * 32, "commit": "b" * 40}
    told = code_to_install(facts)
    assert f"commit {'b' * 40}: git checkout" in told
    assert f"`birm3d --version` then says source {'a' * 12}" in told
    changed = code_to_install({**facts, "commit": f"{'b' * 40} with changes"})
    assert "with changes that were not committed" in changed
    assert "git checkout" not in changed
    assert "did not know" in code_to_install({"birm3d": "0.1.0", "source": "a" * 32})
    assert facts_text(facts) == f"birm3d 0.1.0, source {'a' * 12}, commit {'b' * 12}"


def test_an_old_file_says_that_it_does_not_know() -> None:
    old = birm3d.load(OLD_RESULT)
    assert "source" not in old.made_with
    assert code_to_install(old.made_with) == "birm3d 0.1.0; the file does not say which source"
