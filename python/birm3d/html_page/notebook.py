"""What notebooks show of results and studies: a compact table and a small picture."""

from __future__ import annotations

import base64
import math
from collections.abc import Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from ..result.event import outcome_words
from ..result.summary import HEADLINES, headline_rows, shown_as
from ..scene.text import scene_text
from ..study.counted import counted, is_count
from ..study.shown_columns import shown_column

if TYPE_CHECKING:
    from ..result.result import Result
    from ..study.table import Study

__all__ = ["card", "figure_html", "result_html", "study_html", "table_html", "text_html"]

_MOST_METRICS = 8
_MOST_PARAMETERS = 12
_CELL = "text-align:left;padding:1px 10px 1px 0"


def table_html(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table; all texts are escaped."""

    def line(cells: Sequence[str], tag: str) -> str:
        return "<tr>" + "".join(f'<{tag} style="{_CELL}">{escape(cell)}</{tag}>' for cell in cells) + "</tr>"

    top = f"<thead>{line(head, 'th')}</thead>" if any(head) else ""
    return f"<table>{top}<tbody>{''.join(line(row, 'td') for row in rows)}</tbody></table>"


def figure_html(figure: Any, name: str, dpi: float = 80.0) -> str:
    """Return a figure of matplotlib as an image inside the text."""
    import io

    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=dpi)
    image = base64.b64encode(stream.getvalue()).decode("ascii")
    return f'<img alt="{escape(name)}" style="max-width:100%" src="data:image/png;base64,{image}">'


def result_html(result: Result) -> str:
    """Return outcome, headline numbers with their units, and a plan view of start and end."""
    from ..plotting import plot_thumbnail

    rows = [(label, f"{value} {unit}".strip()) for label, value, unit in headline_rows(result)]
    picture = figure_html(plot_thumbnail(result), "plan view of start and end")
    return card(scene_text(result.scene), table_html(("", ""), rows), picture)


def study_html(study: Study) -> str:
    """Return the outcomes, what was varied, the spread of the headline metrics, and a scatter of one."""
    from ..plotting.studies import plot_small

    rows = [("runs", f"{len(study):,}")]
    rows += [
        (outcome_words(word), f"{count:,} ({count / len(study):.0%})")
        for word, count in study.outcomes.items()
    ]
    rows += [(f"with {one.words}", f"{one.runs:,} ({one.runs / one.n:.0%})") for one in counted(study)]
    if study.failed:
        rows.append(("failed", f"{len(study.failed):,} (reasons in .failed)"))
    for name, values in list(study.parameters.items())[:_MOST_PARAMETERS]:
        column = shown_column(name, study.units.get(name, ""))
        rows.append((column.label, _range(values / column.divisor if values.dtype.kind == "f" else values)))
    if len(study.parameters) > _MOST_PARAMETERS:
        rows.append(("more parameters", str(len(study.parameters) - _MOST_PARAMETERS)))
    tables = table_html(("", ""), rows) + _spread_table(study)
    figure = plot_small(study)
    picture = "" if figure is None else figure_html(figure, "scatter of the runs")
    return card(study.scene_title, tables, picture)


def text_html(text: str, figure: Any, name: str) -> str:
    """Return a text as it is, and a figure below it."""
    words = f'<pre style="white-space:pre-wrap">{escape(text)}</pre>'
    return words if figure is None else words + figure_html(figure, name)


def _spread_table(study: Study) -> str:
    summary = study.summary()
    names = [name for name in HEADLINES if name in summary]
    names = names or [name for name in summary if not is_count(name)]
    rows = []
    for name in names[:_MOST_METRICS]:
        found = summary[name]
        label, size, unit = shown_as(name)
        numbers = (found.mean, found.standard_deviation, found.p05, found.median, found.p95)
        rows.append((f"{label}{_in(unit)}", *("" if x is None else f"{x / size:.4g}" for x in numbers)))
    return table_html(("metric", "mean", "st. dev.", "5 %", "median", "95 %"), rows) if rows else ""


def card(head: str, tables: str, picture: str = "") -> str:
    """Return a card: a heading, tables, and a picture beside them."""
    return (
        f'<div><div style="font-weight:600;margin-bottom:4px">{escape(head)}</div>'
        '<div style="display:flex;flex-wrap:wrap;gap:16px;align-items:flex-start">'
        f"<div>{tables}</div><div>{picture}</div></div></div>"
    )


def _in(unit: str) -> str:
    return f" [{unit}]" if unit else ""


def _range(values: Any) -> str:
    if values.dtype.kind == "f":
        low, high = float(np.min(values)), float(np.max(values))
        if math.isclose(low, high):
            return f"{low:.4g}"
        return f"{low:.4g} to {high:.4g}"
    kinds = list(dict.fromkeys(values.tolist()))
    return ", ".join(kinds[:4]) + (f" and {len(kinds) - 4} more" if len(kinds) > 4 else "")
