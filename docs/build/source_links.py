"""Links from a page to a function: ``[`crush`](../../cpp/src/kernels/crush.cpp#add_crush)``.

A link that leaves the folder of pages names a file of the repository and, after ``#``, a symbol in it. The
site gets a copy of the file with numbered lines, and the link leads to the line that defines the symbol. A
file or a symbol that does not exist is a warning, and so an error of the strict build.
"""

from __future__ import annotations

import html
import logging
import posixpath
import re
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
PAGES = ROOT / "docs/pages"
LINK = re.compile(r"(?<!!)\[([^\]\[]+)\]\(((?:\.\./)+[^)\s#]+)(?:#([\w.-]+))?\)")
_log = logging.getLogger("mkdocs.hooks.source_links")
_used: set[str] = set()


def line_of(text: str, symbol: str) -> int | None:
    """Return the number of the line that defines a symbol, from 1; None where no line does."""
    name = re.escape(symbol)
    patterns = (
        rf"^\s*(?:async def|def|class)\s+{name}\b",  # Python
        rf"^(?:inline |constexpr )*(?:struct|class|enum class)\s+(?:alignas\(\d+\) )?{name}\b[^;]*$",
        rf"^[A-Za-z][^;=]*(?<![\w.>]){name}\([^;]*$",  # a function's head in C++
        rf"^[A-Za-z].*(?<![\w.>]){name}\(",  # its declaration
        rf"^\s*(?:[\w:<>,&*\[\]]+\s+)+{name}\b\s*[=;({{]",  # a member or a constant
        rf"^\s*{name}\b\s*[:=,({{]",
    )
    lines = text.splitlines()
    for pattern in patterns:
        for number, line in enumerate(lines, 1):
            if re.search(pattern, line) and not line.lstrip().startswith(("//", "#", "return ")):
                return number
    return None


def heading_of(text: str, anchor: str) -> int | None:
    """Return the number of the line of a heading by its anchor; None where there is none."""
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("#") and re.sub(r"[^\w]+", "-", line.strip("# ").lower()).strip("-") == anchor:
            return number
    return None


def resolved(page: Path, target: str, symbol: str | None) -> tuple[str, int | None]:
    """Return path in the repository and line of a link on a page; ValueError where there is none."""
    file = (page.parent / target).resolve()
    if not file.is_relative_to(ROOT) or not file.exists():
        raise ValueError(f"{page.name}: no file {target}")
    path = file.relative_to(ROOT).as_posix()
    if symbol is None:
        return path, None
    find = heading_of if file.suffix == ".md" else line_of
    line = find(file.read_text(encoding="utf-8"), symbol)
    if line is None:
        raise ValueError(f"{page.name}: {path} does not define {symbol}")
    return path, line


def links_of(page: Path) -> list[tuple[str, str, str | None]]:
    """Return text, target and symbol of every link of a page that leaves the folder of pages."""
    found = []
    for text, target, symbol in LINK.findall(page.read_text(encoding="utf-8")):
        if not (page.parent / target).resolve().is_relative_to(PAGES):
            found.append((text, target, symbol or None))
    return found


def on_page_markdown(markdown: str, *, page: Any, **_: Any) -> str:
    """Turn the links of a page into links to numbered copies."""
    place = Path(page.file.abs_src_path or PAGES / page.file.src_uri)

    def linked(match: re.Match[str]) -> str:
        text, target, symbol = match.groups()
        if (place.parent / target).resolve().is_relative_to(PAGES):
            return match.group(0)
        try:
            path, line = resolved(place, target, symbol)
        except ValueError as error:
            _log.warning("%s", error)
            return match.group(0)
        shown = re.sub(r"`([^`]+)`", r"<code>\1</code>", html.escape(text, quote=False))
        if (ROOT / path).is_dir():
            return f"<span class='source' title='{path}'>{shown}</span>"
        _used.add(path)
        anchor = f"#line-{line}" if line else ""
        where = f"{path}:{line}" if line else path
        url = posixpath.relpath(f"source/{path}.html", posixpath.dirname(page.url) or ".")
        return f'<a class="source" href="{url}{anchor}" title="{where}">{shown}</a>'

    return LINK.sub(linked, markdown)


def on_post_build(config: Any, **_: Any) -> None:
    """Write the numbered copies."""
    from pygments import highlight
    from pygments.formatters import HtmlFormatter
    from pygments.lexers import get_lexer_for_filename
    from pygments.lexers.special import TextLexer
    from pygments.util import ClassNotFound

    for path in sorted(_used):
        try:
            lexer = get_lexer_for_filename(path)
        except ClassNotFound:
            lexer = TextLexer()
        page = HtmlFormatter(full=True, title=path, linenos="inline", lineanchors="line", anchorlinenos=True)
        target = Path(config.site_dir, "source", f"{path}.html")
        target.parent.mkdir(parents=True, exist_ok=True)
        text = highlight((ROOT / path).read_text(encoding="utf-8"), lexer, page)
        target.write_text(text, encoding="utf-8")
    _used.clear()
