"""Warnings about a finished run whose results are not reliable."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING

from .. import _core
from ..scene.mesh_check import coarse_skins
from .core_contact import core_complaints, core_doubts
from .energy_balance import open_balances, open_rows
from .leaning_posts import leaning_posts
from .low_barrier import low_barrier
from .missed import missed_barrier
from .overlap import overlaps
from .tipping import tipping

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from ..base.complaints import Complaint
    from ..scene.scene import Scene
    from .analysis import RunAnalysis
    from .stored import Stored

__all__ = [
    "complaints_of",
    "complaints_of_run",
    "doubt_lines",
    "doubts",
    "doubts_of",
    "told_of_run",
    "warn_of_run",
    "worst_doubts",
    "worst_lines",
]


def complaints_of_run(
    scene: Scene, statistics: _core.StepStatistics, balances: _core.Balances, event: _core.Event
) -> Iterator[Complaint]:
    """Return complaints: overlap, core contact, open balances, missed and low barriers, leaning posts."""
    return chain(
        overlaps(scene, statistics),
        core_complaints(scene, statistics),
        open_balances(scene, balances),
        missed_barrier(scene, event),
        doubts(scene, statistics, event),
    )


def complaints_of(result: RunAnalysis) -> Iterator[Complaint]:
    """Yield what a run warned of, a coarse skin too; also of a result that was read from a file.

    The balances are those of the rows, see :func:`birm3d.result.energy_balance.open_rows`.
    """
    scene, statistics, event = result.scene, result.statistics, result._event
    yield from coarse_skins(scene)
    yield from overlaps(scene, statistics)
    yield from core_complaints(scene, statistics)
    yield from open_rows(result)
    yield from tipping(result)
    if event is not None:
        yield from missed_barrier(scene, event)
        yield from doubts(scene, statistics, event)


def told_of_run(result: RunAnalysis, balances: _core.Balances) -> Iterator[Complaint]:
    """Return the complaints of a run with histories, which can name the segment that tips."""
    assert isinstance(result.statistics, _core.StepStatistics)
    assert isinstance(result._event, _core.Event)
    found = complaints_of_run(result.scene, result.statistics, balances, result._event)
    return chain(found, tipping(result))


def doubts(
    scene: Scene, statistics: _core.StepStatistics | Stored, event: _core.Event | Stored
) -> Iterator[Complaint]:
    """Return complaints of low barriers and leaning posts; blows on the core and tipping are left out."""
    return chain(low_barrier(scene, event), leaning_posts(scene, statistics, event))


def doubt_lines(result: RunAnalysis) -> Iterator[str]:
    """Yield why the outcome can not be relied on, for reports, including segments that would tip."""
    yield from worst_lines([*doubts_of(result), *tipping(result)])


def doubts_of(result: RunAnalysis) -> tuple[Complaint, ...]:
    """Return why the outcome of a run can not be relied on; segments that would tip are left out.

    Low barriers, leaning posts, and blows on the core of a vehicle that comes turned.
    """
    if result._event is None:
        return ()
    scene, statistics = result.scene, result.statistics
    return (*doubts(scene, statistics, result._event), *core_doubts(scene, statistics))


def worst_doubts(results: Iterable[RunAnalysis]) -> Iterator[str]:
    """Yield why the outcomes of runs can not be relied on: of each kind the worst."""
    yield from worst_lines(doubt for result in results for doubt in doubts_of(result))


def worst_lines(found: Iterable[Complaint]) -> Iterator[str]:
    """Yield what doubts of runs say: of each kind the worst."""
    worst: dict[str, Complaint] = {}
    for doubt in found:
        if doubt.quantity not in worst or doubt.value > worst[doubt.quantity].value:
            worst[doubt.quantity] = doubt
    for doubt in worst.values():
        assert doubt.advice is not None
        yield doubt.advice()


def warn_of_run(result: RunAnalysis, balances: _core.Balances) -> None:
    """Warn of what makes the numbers of a run unreliable, or leaves it without an impact.

    Raises
    ------
    OverlapWarning
        As a warning, if the overlap was beyond :data:`birm3d.result.overlap.OVERLAP_LIMIT`.
    CoreContactWarning
        As a warning, if the barrier's force on the rigid core exceeded the vehicle's weight.
    BalanceWarning
        As a warning, see :func:`birm3d.result.energy_balance.warn_if_open`.
    MissedBarrierWarning
        As a warning, if the vehicle went past the end of the barrier and never touched it.
    LowBarrierWarning
        As a warning, if a barrier that contains a front is lower than most of it.
    LeaningPostWarning
        As a warning, if posts that lean threw the vehicle up, or lay low.
    TippingWarning
        As a warning, if a segment that stands free would begin to tip.
    """
    for complaint in told_of_run(result, balances):
        complaint.warn()
