"""Equations: blocks of LaTeX become MathML, which browsers draw without a script."""

from __future__ import annotations

from typing import Any

from latex2mathml.converter import convert


def _equation(source: str, *_: Any, **__: Any) -> str:
    return f'<div class="equation">{convert(source.strip(), display="block")}</div>'


def on_config(config: Any) -> Any:
    """Register the block ``math`` with the Markdown extension for fenced blocks."""
    fences = config.mdx_configs.setdefault("pymdownx.superfences", {})
    fences["custom_fences"] = [{"name": "math", "class": "equation", "format": _equation}]
    return config
