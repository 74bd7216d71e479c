"""A value beside its limit, and tables of them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape

__all__ = [
    "Criterion",
    "criteria_html",
    "criteria_text",
    "foot_html",
    "table_html",
    "table_text",
    "without_sign_of_zero",
]

_LARGE = 1000.0  # from here on one decimal is shown
_HEAD = ("criterion", "value", "limit", "verdict")


@dataclass(frozen=True)
class Criterion:
    """What a standard asks of one value.

    Attributes
    ----------
    name : str
        What is judged, and by which standard where there are several.
    value : float or str
        In `unit`; text where it is no number.
    unit : str
    limit : str
        In the same unit, as text.
    passed : bool or None
        ``None``: the value is reported without a verdict.
    grade : str
        Class that the value falls into, as ``"A"`` or ``"preferred"``; may be empty.
    """

    name: str
    value: float | str
    unit: str
    limit: str
    passed: bool | None
    grade: str = ""

    @property
    def verdict(self) -> str:
        """``"pass"``, ``"FAIL"`` or ``"reported"``, and the grade."""
        word = "reported" if self.passed is None else "pass" if self.passed else "FAIL"
        return f"{word}: {self.grade}" if self.grade else word

    @property
    def shown(self) -> str:
        """The value with its unit, as a table shows it."""
        if isinstance(self.value, str):
            number = self.value
        else:
            number = f"{self.value:.2f}" if abs(self.value) < _LARGE else f"{self.value:,.1f}"
        return f"{number} {self.unit}".strip()


def _rows(criteria: Iterable[Criterion]) -> list[tuple[str, ...]]:
    return [(one.name, one.shown, one.limit, one.verdict) for one in criteria]


def criteria_text(criteria: Iterable[Criterion]) -> str:
    """Return criteria as a table of text, columns in line."""
    return table_text(_HEAD, _rows(criteria))


def criteria_html(title: str, criteria: Iterable[Criterion], foot: str = "") -> str:
    """Return criteria as a table that notebooks show; all texts are escaped."""
    return table_html(title, _HEAD, _rows(criteria), foot)


def table_text(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table of text, columns in line."""
    lines = [head, *rows]
    widths = [max(len(row[i]) for row in lines) for i in range(len(head))]
    texts = ["  ".join(cell.ljust(w) for cell, w in zip(row, widths, strict=True)).rstrip() for row in lines]
    return "\n".join([texts[0], "-" * max(map(len, texts)), *texts[1:]])


def table_html(title: str, head: Sequence[str], rows: Iterable[Sequence[str]], foot: str = "") -> str:
    """Return a table that notebooks show, a line of the foot below the other; all texts are escaped."""
    style = 'style="text-align:left;padding:1px 10px 1px 0"'

    def line(cells: Iterable[str], tag: str) -> str:
        return "<tr>" + "".join(f"<{tag} {style}>{escape(cell)}</{tag}>" for cell in cells) + "</tr>"

    body = "".join(line(row, "td") for row in rows)
    end = _below(foot) if foot else ""
    return (
        f'<div><div style="font-weight:600;margin-bottom:4px">{escape(title)}</div>'
        f"<table><thead>{line(head, 'th')}</thead><tbody>{body}</tbody></table>{end}</div>"
    )


def foot_html(caution: str) -> str:
    """Return a caution below tables that notebooks show."""
    return _below(f"Caution: {caution}")


def _below(text: str) -> str:
    lines = "<br>".join(map(escape, text.split("\n")))
    return f'<div style="max-width:48em;opacity:0.8">{lines}</div>'


def without_sign_of_zero(text: str) -> str:
    """Return a number as text, without the sign of what is rounded to zero."""
    return text.removeprefix("-") if not text.strip("-0.") else text
