"""Whether the class of a published test, and so its penetration, is computed as it was published."""

from __future__ import annotations

import re
from typing import Literal, TypeAlias

from ..assessment import Rating

__all__ = ["Judgement", "class_of", "judged_class"]

Judgement: TypeAlias = Literal["right", "wrong", "not published"]


def class_of(rating: Rating) -> str:
    """Return the class of penetration of a rating; of a roadside standard its verdict with its classes."""
    row = next((one for one in rating.criteria if one.name == "penetration class"), None)
    return rating.verdict if row is None else str(row.value)


def judged_class(published: str, rating: Rating) -> Judgement:
    """Return whether all that was published of a class is computed.

    Parameters
    ----------
    published
        As ``"P2"``, or ``"pass; severity B"``, of which each part counts; ``""``: nothing.
    rating
        Of the scene that stands for the test.
    """
    if not published:
        return "not published"
    return "right" if _parts(published) <= _parts(class_of(rating)) else "wrong"


def _parts(text: str) -> set[str]:
    return set(re.split("[;,] ", text))
