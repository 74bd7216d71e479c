"""``python -m birm3d`` is the command ``birm3d``, for machines where that is not on the path."""

from __future__ import annotations

from .cli import main

if __name__ == "__main__":
    main()
