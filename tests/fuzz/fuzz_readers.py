"""Every reader, fed damaged files: it reads them, or raises its own error, soon and in little memory.

    python tests/fuzz/fuzz_readers.py --seconds 600
    python tests/fuzz/fuzz_readers.py --seconds 60 --reader result --seed 7

A table follows: files tried, read, refused, and the slowest. What a reader may not do ends the program with
exit status 1 and the changes that lead there: raise anything but a ``FileFormatError`` (a store also a
``ValueError``, for another study), take more than ten seconds or a gigabyte, give values that its file's
checksum does not cover.
"""

from __future__ import annotations

import argparse
import resource
import signal
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from hypothesis import HealthCheck, Phase, given, seed, settings
from mutations import Change, changes
from readers import READERS, Reader

LONGEST = 10.0
"""What a reader may take for a file [s]."""

MOST_MEMORY = 2**30
"""By which the memory of the process may grow [bytes]."""


class HangError(BaseException):
    """A reader takes too long; no reader may take it for an error of its file."""


@dataclass
class Tally:
    """What came of the files of one reader."""

    read: int = 0
    refused: int = 0
    slowest: float = 0.0
    reasons: dict[str, int] = field(default_factory=dict)


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Raise HangError in the block if it takes longer."""

    def ring(number: int, frame: object) -> None:
        raise HangError(f"no answer within {seconds:g} s")

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def peak_memory() -> int:
    """Return the greatest size that this process has had [bytes]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def try_one(reader: Reader, folder: Path, applied: list[Change], tally: Tally) -> None:
    """Damage the reader's good file, read it, and judge what comes."""
    path = reader.damage(folder, applied)
    memory, start = peak_memory(), time.perf_counter()
    try:
        with time_limit(LONGEST):
            found = reader.read(path)
    except HangError:
        raise
    except reader.errors as error:
        tally.refused += 1
        if path.parent.name not in str(error):
            raise AssertionError(f"the message must name the file, got {error}") from error
        found = None
    else:
        tally.read += 1
    tally.slowest = max(tally.slowest, time.perf_counter() - start)
    grown = peak_memory() - memory
    assert grown < MOST_MEMORY, f"memory grew by {grown / 2**20:.0f} MB"
    if found is not None and reader.content is not None:
        assert reader.same(found, reader.content), "values were changed and accepted"


def fuzz(reader: Reader, folder: Path, examples: int, start: int | None, tally: Tally) -> None:
    """Try so many damaged files; `start` seeds them, None: the same ones in every run."""

    @given(changes())
    @settings(
        max_examples=examples,
        deadline=None,
        database=None,
        derandomize=start is None,
        phases=(Phase.generate,),
        suppress_health_check=list(HealthCheck),
        report_multiple_bugs=False,
    )
    def run(applied: list[Change]) -> None:
        try_one(reader, folder, applied, tally)

    (run if start is None else seed(start)(run))()


def main(arguments: list[str] | None = None) -> int:
    """Fuzz for a time and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--seconds", type=float, default=60.0, help="in all, shared by the readers")
    parser.add_argument("--reader", choices=[reader.name for reader in READERS], action="append")
    parser.add_argument("--seed", type=int, default=0, help="of the first files")
    given_ = parser.parse_args(arguments)
    chosen = [r for r in READERS if not given_.reader or r.name in given_.reader]
    share = given_.seconds / len(chosen)
    print(f"{'reader':<24}{'files':>8}{'read':>8}{'refused':>9}{'slowest [s]':>13}")
    failed = False
    for reader in chosen:
        tally = Tally()
        with tempfile.TemporaryDirectory(prefix="fuzz-") as place:
            folder = Path(place)
            reader.prepare(folder)
            until, round_ = time.monotonic() + share, given_.seed
            try:
                while time.monotonic() < until:
                    fuzz(reader, folder, 50, round_, tally)
                    round_ += 1
            except (Exception, HangError) as error:
                failed = True
                print(f"{reader.name}, seed {round_}: {type(error).__name__}: {error}", file=sys.stderr)
                for note in getattr(error, "__notes__", ()):
                    print(note, file=sys.stderr)
        count = tally.read + tally.refused
        print(
            f"{reader.name:<24}{count:>8}{tally.read:>8}{tally.refused:>9}{tally.slowest:>13.2f}", flush=True
        )
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
