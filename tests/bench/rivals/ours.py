"""BIRM3D, by tolerance and with fixed steps; balances, histories and 20 ms beyond the end included."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence

from birm3d import BalanceWarning, Barrier, Settings, Simulation, UnstableError

from .definition import STEPS, Answer, Case, RefusedError, Run, compared, vehicle

TOLERANCES = tuple(10.0 ** (-0.25 * i) for i in range(29))


def simulation(case: Case, n: int, **changes: float) -> Simulation:
    return Simulation(
        vehicle(case, n),
        Barrier.rigid_wall(friction=case.friction),
        case.speed,
        case.angle,
        duration=case.duration,
        settings=Settings(gravity=0.0, ground=False, **changes),
    )


class Ours:
    does_more = ""
    wrong: Mapping[str, str] = {}

    def __init__(self, name: str, keyword: str, settings: Sequence[float], setup: str) -> None:
        self.name = name
        self.setup = setup
        self.settings = settings
        self._keyword = keyword

    def build(self, case: Case, n: int) -> Run:
        scenes: dict[float, Simulation] = {}

        def run(setting: float) -> Answer:
            # Building a scene is not stepping.
            scene = scenes.setdefault(setting, simulation(case, n, **{self._keyword: setting}))
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore", BalanceWarning)  # what is off shows as the error
                    result = scene.run()
            except UnstableError as error:
                raise RefusedError(str(error)) from None
            numbers = compared(result).values()
            return Answer(*numbers, result.statistics.steps, result.run_time)

        return run


RIVALS = (
    Ours("BIRM3D", "tolerance", TOLERANCES, "adaptive steps, the tolerance is varied"),
    Ours("BIRM3D, fixed step", "time_step", STEPS, "the step is varied"),
)
