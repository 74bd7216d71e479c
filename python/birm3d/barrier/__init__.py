"""Barriers: what a vehicle runs into."""

from __future__ import annotations

import sys

from .barrier import Barrier
from .free_standing import FreeStanding
from .yielding import Foundation

__all__ = ["Barrier", "Foundation", "FreeStanding"]

# Scripts and pickles of earlier versions look for a class of barriers in the module of its kind.
for _class in Barrier.__subclasses__():
    setattr(sys.modules[_class.__mro__[1].__module__], _class.__name__, _class)
