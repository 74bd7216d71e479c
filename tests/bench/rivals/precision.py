"""Error against time, and the time at equal error.

A setting is good for an error if it and all finer ones that were tried are within it: an error that is
small by chance at one step is no merit. Every run of a table is timed in turn (A B A B ...) and the
median is taken.
"""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from .definition import TARGETS, AbsentError, Answer, Case, RefusedError, Rival, Run

# A rival whose error is this far below the smallest target need not be tried with finer settings.
FINE_ENOUGH = 0.3 * min(TARGETS)
WRONG = 0.01
# Runs that would take longer are not run: their time follows from that of a coarser one by the steps [s].
LONGEST = 3.0


@dataclass(frozen=True)
class Point:
    """One setting of one rival."""

    setting: float
    error: float
    worst: str  # of what the error is
    steps: int
    time: float  # s, stepping only
    extrapolated: bool = False
    best: float = math.nan  # s, least of all runs: what a busy machine disturbs least


@dataclass(frozen=True)
class Entry:
    """A rival that runs, or why it does not."""

    rival: Rival
    run: Run | None
    reason: str = ""
    build_time: float = 0.0  # s


def enter(rivals: Iterable[Rival], case: Case, n: int) -> list[Entry]:
    entries = []
    for rival in rivals:
        if case.name in rival.wrong:
            entries.append(Entry(rival, None, f"wrong physics: {rival.wrong[case.name]}"))
            continue
        begin = time.perf_counter()
        try:
            run = rival.build(case, n)
        except AbsentError as error:
            entries.append(Entry(rival, None, str(error)))
        else:
            entries.append(Entry(rival, run, build_time=time.perf_counter() - begin))
    return entries


def measured(case: Case, setting: float, answer: Answer) -> Point:
    error, worst = case.error(answer)
    return Point(setting, error, worst, answer.steps, answer.run_time)


def sweep(case: Case, entries: Sequence[Entry], repeats: int) -> dict[str, list[Point]]:
    """All settings of each rival, from coarse to fine, until they are fine enough or too slow."""
    found: dict[str, list[Point]] = {}
    for entry in entries:
        if entry.run is None:
            continue
        points: list[Point] = []
        entry.run(entry.rival.settings[len(entry.rival.settings) // 2])  # warm up
        for setting in entry.rival.settings:
            if points and points[-1].time * 2.0 > LONGEST:
                break
            try:
                points.append(measured(case, setting, entry.run(setting)))
            except RefusedError:
                continue
            if all(point.error < FINE_ENOUGH for point in points[-3:]) and len(points) >= 3:
                break
        found[entry.rival.name] = points
    again = [(entry.run, point, []) for entry in entries if entry.run for point in found[entry.rival.name]]
    for _ in range(repeats - 1):
        for run, point, times in again:
            times.append(run(point.setting).run_time)
    medians = {id(point): statistics.median([point.time, *times]) for _, point, times in again}
    return {
        name: [
            Point(p.setting, p.error, p.worst, p.steps, medians[id(p)]) for p in points
        ]
        for name, points in found.items()
    }  # fmt: skip


def judge(entries: Sequence[Entry], points: dict[str, list[Point]]) -> list[Entry]:
    """Strike out rivals whose finest answer is wrong."""
    kept = []
    for entry in entries:
        tried = points.get(entry.rival.name, [])
        least = min((point.error for point in tried), default=math.nan)
        if entry.run is not None and not least <= WRONG:
            # One that converges is not wrong but slow.
            falls = len(tried) > 2 and tried[-1].error < 0.8 * tried[-3].error
            what = f"slow: in {LONGEST:g} s" if falls else "wrong:"
            reason = f"{what} its best answer is off by {least:.1%}"
            entry = Entry(entry.rival, None, reason)
        kept.append(entry)
    return kept


def setting_for(points: Sequence[Point], target: float) -> float | None:
    """The coarsest setting that is within the error, with all finer ones; None: none is."""
    good = None
    for point in reversed(points):
        if not point.error <= target:
            break
        good = point.setting
    return good


def at_equal_error(
    case: Case, entries: Sequence[Entry], points: dict[str, list[Point]], repeats: int
) -> dict[tuple[str, float], Point | None]:
    """(Rival, target) -> its time there; None: no setting reaches it. `points` choose the settings."""
    chosen: dict[tuple[str, float], Point | None] = {}
    timed: dict[tuple[str, float], tuple[Run, list[float]]] = {}  # by rival and setting
    settings: dict[tuple[str, float], float] = {}
    firsts: dict[tuple[str, float], Point] = {}
    for entry in entries:
        if entry.run is None:
            continue
        name = entry.rival.name
        # A few long steps tell what a step takes with this many nodes.
        first_setting = points[name][0].setting
        last = measured(case, first_setting, entry.run(first_setting))
        for target in sorted(TARGETS, reverse=True):
            setting = setting_for(points[name], target)
            if setting is None:
                chosen[name, target] = None
                continue
            settings[name, target] = setting
            if (name, setting) in firsts:
                continue
            tried = next(point for point in points[name] if point.setting == setting)
            ahead = last.time / last.steps * tried.steps
            if ahead > LONGEST:
                firsts[name, setting] = Point(
                    setting, tried.error, tried.worst, tried.steps, ahead, extrapolated=True
                )
                continue
            last = measured(case, setting, entry.run(setting))
            firsts[name, setting] = last
            timed[name, setting] = (entry.run, [])
    for _ in range(repeats):
        for (_, setting), (run, times) in timed.items():
            times.append(run(setting).run_time)
    for (name, target), setting in settings.items():
        first = firsts[name, setting]
        if (name, setting) in timed:
            taken = timed[name, setting][1]
            middle = statistics.median(taken)
            first = Point(setting, first.error, first.worst, first.steps, middle, best=min(taken))
        chosen[name, target] = first
    return chosen
