"""Exudyn: a rigid body on n spring connectors (W1), and our law as a user force in NumPy (W2).

Its connectors are elastic or have one slope and one unloading slope, so that the second segment of W2 is
a user function; a Python function for each of n springs would be slower than one for all, and that is the
row. Its springs hold both ways, which does not matter before the body has left, where the run ends.
Velocity Verlet, one thread, nothing written. GeneralContact is left out: its small spheres lose a wall
that comes deeper than their radius, and large ones are dear.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy_reference

from .definition import STEPS, AbsentError, Answer, Case, Run, block


def engine() -> Any:
    try:
        import exudyn
    except ImportError as error:
        raise AbsentError(f"exudyn is not installed ({error})") from None
    return exudyn


class Watch:
    """What is kept of each step: one coordinate and its rate; stops where the body has left."""

    def __init__(self, mass: float, speed: float) -> None:
        self.mass = mass
        self.crush = self.change = 0.0
        self.speed = self.fastest = speed
        self.steps = 0

    def __call__(self, mbs: Any, t: float) -> bool:
        now = mbs.systemData.GetODE2Coordinates_t()[0]
        self.crush = max(self.crush, mbs.systemData.GetODE2Coordinates()[0])
        self.change = max(self.change, self.speed - now)
        self.fastest = min(self.fastest, now)
        self.steps += 1
        gone = now < 0.0 and now >= self.speed
        self.speed = now
        return not gone


def solve(mbs: Any, watch: Watch, step: float) -> Answer:
    exu = engine()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = int(0.4 / step)
    settings.timeIntegration.endTime = settings.timeIntegration.numberOfSteps * step
    settings.timeIntegration.verboseMode = 0
    settings.solutionSettings.writeSolutionToFile = False
    settings.solutionSettings.sensorsWritePeriod = 1.0
    settings.parallel.numberOfThreads = 1
    begin = time.perf_counter()
    mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.VelocityVerlet)
    taken = time.perf_counter() - begin
    return Answer(watch.crush, watch.change * watch.mass / step, -watch.fastest, watch.steps, taken)


class Connectors:
    name = "Exudyn, spring connectors"
    setup = "rigid body (Lie group node), n Cartesian springs, velocity Verlet, one thread"
    does_more = "joints, flexible bodies, implicit integrators"
    settings = STEPS
    wrong: Mapping[str, str] = {
        "W2": "its connectors have no second slope with an unloading slope of its own",
        "W3": "its connectors know no wall",
    }

    def build(self, case: Case, n: int) -> Run:
        exu = engine()
        from exudyn.utilities import RigidBodyInertia

        body = block(case, n)
        inertia = RigidBodyInertia(mass=body.mass, inertiaTensor=np.diag(body.inertia))

        def run(setting: float) -> Answer:
            # A system is solved once: built anew, which is not timed.
            mbs = exu.SystemContainer().AddSystem()
            free = mbs.CreateRigidBody(
                inertia=inertia,
                nodeType=exu.NodeType.RotationRotationVector,
                referencePosition=[0.0, 0.0, 0.0],
                initialVelocity=[case.speed, 0.0, 0.0],
            )
            ground = mbs.CreateGround()
            for place in body.nodes.tolist():
                pair = [
                    mbs.AddMarker(exu.utilities.MarkerBodyPosition(bodyNumber=number, localPosition=place))
                    for number in (ground, free)
                ]
                mbs.AddObject(
                    exu.utilities.CartesianSpringDamper(
                        markerNumbers=pair, stiffness=[body.k_initial, 0.0, 0.0], damping=[0.0, 0.0, 0.0]
                    )
                )
            watch = Watch(body.mass, case.speed)
            mbs.SetPostStepUserFunction(watch)
            mbs.Assemble()
            return solve(mbs, watch, setting)

        return run


class UserForce:
    name = "Exudyn, our law as a NumPy user force"
    setup = "mass point, one user force for all nodes (lean NumPy), velocity Verlet, one thread"
    does_more = Connectors.does_more
    settings = STEPS
    wrong: Mapping[str, str] = {"W3": "its body can not turn"}

    def build(self, case: Case, n: int) -> Run:
        exu = engine()
        body = block(case, n)
        law = numpy_reference.Run(body, case.speed, STEPS[0], lean=True)
        normal = np.array([-1.0, 0.0, 0.0])
        front = float(body.nodes[:, 0].max())

        def run(setting: float) -> Answer:
            law.start()
            mbs = exu.SystemContainer().AddSystem()
            free = mbs.CreateMassPoint(
                physicsMass=body.mass,
                referencePosition=[0.0, 0.0, 0.0],
                initialVelocity=[case.speed, 0.0, 0.0],
            )
            node = mbs.GetObject(free)["nodeNumber"]
            place = exu.OutputVariableType.Position

            def force(mbs: Any, t: float, load: Any) -> list[float]:
                offset = float(mbs.GetNodeOutput(node, place)[0]) - front
                return [-law.press(normal, offset)[0], 0.0, 0.0]

            marker = mbs.AddMarker(exu.utilities.MarkerNodePosition(nodeNumber=node))
            mbs.AddLoad(
                exu.utilities.LoadForceVector(
                    markerNumber=marker, loadVector=[0.0, 0.0, 0.0], loadVectorUserFunction=force
                )
            )
            watch = Watch(body.mass, case.speed)
            mbs.SetPostStepUserFunction(watch)
            mbs.Assemble()
            answer = solve(mbs, watch, setting)
            return numpy_reference.Answer(
                float(law.peak.max()), answer.peak_normal_force, answer.exit_speed, answer.steps,
                answer.run_time,
            )  # fmt: skip

        return run


RIVALS = (Connectors(), UserForce())
