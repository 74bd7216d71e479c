"""What a page is made of: sections of tables, figures and texts; the template lays them out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

__all__ = ["Block", "Caution", "Figure", "Items", "Listing", "Replay", "Section", "Table", "Text"]


@dataclass(frozen=True)
class Table:
    """Rows of texts under a caption; the first column names the row.

    numbers: whether the other columns hold numbers, which stand to the right.
    """

    kind: ClassVar[str] = "table"
    caption: str
    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    note: str = ""
    numbers: bool = False


@dataclass(frozen=True)
class Figure:
    """A picture with what it shows; small: not as wide as the page."""

    kind: ClassVar[str] = "figure"
    caption: str
    source: str  # data URI
    small: bool = False


@dataclass(frozen=True)
class Text:
    """A paragraph."""

    kind: ClassVar[str] = "text"
    text: str


@dataclass(frozen=True)
class Caution:
    """A paragraph that limits what may be concluded."""

    kind: ClassVar[str] = "caution"
    text: str


@dataclass(frozen=True)
class Items:
    """A list; links are (text, file beside the page)."""

    kind: ClassVar[str] = "items"
    items: Sequence[str] = ()
    links: Sequence[tuple[str, str]] = ()


@dataclass(frozen=True)
class Listing:
    """Text as it is, line by line."""

    kind: ClassVar[str] = "listing"
    text: str


@dataclass(frozen=True)
class Replay:
    """The three-dimensional replay; its numbers go into the page as JSON."""

    kind: ClassVar[str] = "replay"
    caption: str
    data: dict[str, Any]


Block = Table | Figure | Text | Caution | Items | Listing | Replay


@dataclass(frozen=True)
class Section:
    """A numbered part of the page."""

    title: str
    anchor: str
    blocks: list[Block] = field(default_factory=list)
