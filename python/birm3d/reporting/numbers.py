"""Numbers as a reader of the page wants them."""

from __future__ import annotations

__all__ = ["percent"]

_LEAST = 1e-6  # a smaller share is a rounding error


def percent(share: float) -> str:
    """Return a small share in percent, with one to four decimals and never as a power of ten."""
    if abs(share) < _LEAST:
        return f"below {_LEAST:.4%}" if share else "0%"
    digits = 1 if abs(share) >= 0.01 else 2 if abs(share) >= 0.001 else 3 if abs(share) >= 1e-4 else 4
    return f"{share:.{digits}%}"
