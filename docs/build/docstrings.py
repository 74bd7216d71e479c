"""Docstrings are written in reStructuredText's inline marks; pages are Markdown."""

from __future__ import annotations

import re
from typing import Any

import griffe

ROLE = re.compile(r":(?:class|meth|func|attr|mod|data|exc|obj|ref):`~?([^`<]+?)`")


def as_markdown(text: str) -> str:
    """Return text with roles and double backticks as Markdown's code."""
    text = ROLE.sub(lambda match: f"`{match.group(1).removeprefix('birm3d.')}`", text)
    return re.sub(r"``([^`]+)``", r"`\1`", text).replace("::\n\n    ", ":\n\n    ")


class InlineMarks(griffe.Extension):
    """Rewrites every docstring that is collected."""

    def on_instance(self, *, obj: Any, **_: Any) -> None:
        if obj.docstring is not None:
            obj.docstring.value = as_markdown(obj.docstring.value)


def on_config(config: Any) -> Any:
    """Give the extension to the reader of docstrings."""
    options = config.plugins["mkdocstrings"].config.handlers["python"]["options"]
    options["extensions"] = [f"{__file__}:InlineMarks"]
    return config
