"""Barriers: what a vehicle runs into."""

from __future__ import annotations

from .barrier import Barrier
from .free_standing import FreeStanding
from .yielding import Foundation

__all__ = ["Barrier", "Foundation", "FreeStanding"]
