"""All given tests beside what is computed of them: tables in results, and the page README.md.

    python tests/validation/all_tests.py              # some minutes on two processors
    python tests/validation/all_tests.py security     # some kinds of tests only; the page has all
    python tests/validation/all_tests.py --page       # the page from the tables; nothing is computed

Every kind of test is a module ``kind_*.py`` beside this file.
"""

from __future__ import annotations

import argparse
import importlib
import sys
import time
import warnings
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from types import ModuleType

FOLDER = Path(__file__).parent
sys.path[:0] = [str(FOLDER), str(FOLDER.parent / "bench")]

from all_tests_page import page  # noqa: E402
from comparison import Row, read, write  # noqa: E402

KINDS = (
    "full_width_wall",
    "side_pole",
    "finite_element",
    "finite_element_truck",
    "small_overlap",
    "redirection",
    "lateral_load",
    "security",
)


def kind(name: str) -> ModuleType:
    """The module of a kind of test."""
    return importlib.import_module(f"kind_{name}")


def computed(job: tuple[str, str]) -> list[Row]:
    """The rows of one task of a kind; in a process of its own."""
    name, task = job
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of a core that is met the tables tell
        rows: list[Row] = kind(name).rows(task)
    return rows


def extra(task: str) -> tuple[str, ...]:
    """The row of an oblique impact in the table of computed figures."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        cells: tuple[str, ...] = kind("redirection").computed(task)
    return cells


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("kind", nargs="*", help=f"of {', '.join(KINDS)}; all")
    parser.add_argument("--page", action="store_true", help="compute nothing")
    options = parser.parse_args(arguments)
    for name in options.kind:
        if name not in KINDS:
            parser.error(f"kind must be one of {', '.join(KINDS)}; got {name!r}")
    if not options.page:
        _compute(options.kind or KINDS)
    modules = {name: kind(name) for name in KINDS}
    text = page(modules, {name: read(name) for name in KINDS})
    (FOLDER / "README.md").write_text(text, encoding="utf-8", newline="\n")
    return 0


def _compute(names: Sequence[str]) -> None:
    start = time.perf_counter()
    jobs = [(name, task) for name in names for task in kind(name).tasks()]
    with ProcessPoolExecutor(max_workers=2) as pool:
        answers = list(pool.map(computed, jobs))
        if "redirection" in names:
            cells = list(pool.map(extra, kind("redirection").tasks()))
            lines = ["; ".join(row) for row in cells]
            path = FOLDER / "results/redirection_computed.txt"
            path.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")
    for name in names:
        found = [row for (own, _), rows in zip(jobs, answers, strict=True) if own == name for row in rows]
        write(name, found)
    print(f"{len(jobs)} tasks in {time.perf_counter() - start:.0f} s", file=sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
