"""Calibration: fit what a scene has to measurements, and say how far the answer can be trusted.

Start with :func:`calibrate`, :class:`Parameter`, :class:`CurveTarget` and :class:`ScalarTarget`.
"""

from __future__ import annotations

from .calibrate import calibrate
from .errors import CalibrationError, CalibrationInterruptedError
from .evaluator import Evaluation
from .parameters import Parameter
from .profile import Profile
from .quantities import QUANTITIES
from .result import CalibrationResult, FittedParameter, FittedTarget
from .storage import load
from .targets import CurveTarget, ScalarTarget, Target

__all__ = [
    "QUANTITIES",
    "CalibrationError",
    "CalibrationInterruptedError",
    "CalibrationResult",
    "CurveTarget",
    "Evaluation",
    "FittedParameter",
    "FittedTarget",
    "Parameter",
    "Profile",
    "ScalarTarget",
    "Target",
    "calibrate",
    "load",
]
