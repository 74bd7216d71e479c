"""Our law in NumPy as an expert would write it; numpy_reference.py says what it leaves out."""

from __future__ import annotations

from collections.abc import Mapping

import numpy_reference

from .definition import STEPS, Case, Run, block


class NumPy:
    does_more = ""
    settings = STEPS

    def __init__(self, lean: bool) -> None:
        self.lean = lean
        self.name = "NumPy, lean" if lean else "NumPy"
        self.setup = "columns, in place, leapfrog" + ("; the body can not turn, no balance" if lean else "")
        self.wrong: Mapping[str, str] = {"W3": "its body can not turn"} if lean else {}

    def build(self, case: Case, n: int) -> Run:
        body = block(case, n)
        return lambda setting: numpy_reference.Run(
            body,
            case.speed,
            setting,
            lean=self.lean,
            angle=case.angle,
            friction=case.friction,
            duration=case.duration,
        ).run()


RIVALS = (NumPy(lean=False), NumPy(lean=True))
