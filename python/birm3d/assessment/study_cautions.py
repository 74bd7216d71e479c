"""Cautions of the ratings of many runs as one list: each once, with the number of runs that it holds in."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from .doubts import Doubt
from .rating import Rating

__all__ = ["cautions_of_runs"]


def cautions_of_runs(ratings: Sequence[Rating], noun: str) -> tuple[str, ...]:
    """Return the cautions of the ratings of several runs, each once, doubts first.

    A doubt says in how many of the runs it holds; of one kind the worst is told. Another caution says so
    where it does not hold in all of them.

    Parameters
    ----------
    noun
        What a run is called, in the plural: ``"runs"``.
    """
    doubts: dict[str, list[Doubt]] = {}
    others: Counter[str] = Counter()
    for rating in ratings:
        own = {doubt.sentence for doubt in rating.doubts}
        for doubt in rating.doubts:
            doubts.setdefault(doubt.kind, []).append(doubt)
        others.update(text for text in dict.fromkeys(rating.cautions) if text not in own)
    n = len(ratings)
    told = [_told(found, n, noun) for found in doubts.values()]
    rest = [text if count == n else f"In {_of(count, n, noun)}: {text}" for text, count in others.items()]
    return (*told, *rest)


def _told(found: Sequence[Doubt], n: int, noun: str) -> str:
    """Return doubts of one kind as one: of names each with its runs, of numbers the worst."""
    worst = max(found, key=lambda doubt: doubt.value)
    counts = Counter(name for doubt in found for name in doubt.names)
    if counts:
        each = (f"{name} (in {_of(count, n, noun)})" for name, count in counts.most_common())
        return worst.text.replace("{names}", ", ".join(each))
    differ = len({doubt.text for doubt in found}) > 1
    return f"In {_of(len(found), n, noun)}{', here the worst' if differ else ''}: {worst.text}"


def _of(count: int, n: int, noun: str) -> str:
    return f"{count:,} of {n:,} {noun}"
