"""Calibration: fit what a scene has to measurements, and say how far the answer can be trusted.

Start with :func:`calibrate`, :class:`Parameter`, :class:`CurveTarget` and :class:`ScalarTarget`.
"""

from __future__ import annotations

from .calibrate import calibrate
from .curve_target import CurveTarget
from .errors import CalibrationError, CalibrationInterruptedError
from .evaluation import Evaluation
from .fitted import FittedParameter, FittedTarget
from .parameters import Parameter
from .problem import Target
from .profile import Profile
from .quantities import QUANTITIES
from .result import CalibrationResult, load
from .scalar_target import ScalarTarget

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
