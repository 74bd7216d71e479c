"""Bullet by pybullet: one compound body of n spheres on a plane, contact stiffness. Elastic: W1 only."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Mapping
from pathlib import Path

from .definition import STEPS, AbsentError, Answer, Case, Run, block

RADIUS = 0.01  # m
ITERATIONS = 10


def urdf(mass: float, inertia: tuple[float, float, float], points: str) -> str:
    x, y, z = inertia
    return f"""<robot name="vehicle"><link name="base"><inertial><mass value="{mass}"/>
    <inertia ixx="{x}" iyy="{y}" izz="{z}" ixy="0" ixz="0" iyz="0"/></inertial>
    {points}</link></robot>"""


class Bullet:
    name = "Bullet (pybullet)"
    setup = f"one compound body, split impulse off, {ITERATIONS} iterations, warm start, no friction"
    does_more = "general collision search, joints, friction between many bodies"
    settings = STEPS
    wrong: Mapping[str, str] = {
        "W2": "its contact is elastic",
        "W3": "its contact is elastic",
    }

    def build(self, case: Case, n: int) -> Run:
        try:
            import pybullet
        except ImportError as error:
            raise AbsentError(f"pybullet is not installed ({error})") from None
        from pybullet_utils.bullet_client import BulletClient

        body = block(case, n)
        world = BulletClient(pybullet.DIRECT)
        points = "".join(
            f'<collision><origin xyz="{x - RADIUS} {y} {z}"/><geometry><sphere radius="{RADIUS}"/></geometry>'
            "</collision>\n"  # its reader takes lines of 1,024 characters
            for x, y, z in body.nodes
        )
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "vehicle.urdf")
            file.write_text(urdf(body.mass, body.inertia, points), encoding="utf-8")
            flags = pybullet.URDF_USE_INERTIA_FROM_FILE
            vehicle = world.loadURDF(str(file), flags=flags, useMaximalCoordinates=1)
        shape = world.createCollisionShape(pybullet.GEOM_PLANE, planeNormal=[-1.0, 0.0, 0.0])
        wall = world.createMultiBody(0.0, shape, useMaximalCoordinates=1)
        plain = {"lateralFriction": 0.0, "restitution": 0.0, "contactDamping": 0.0}
        world.changeDynamics(vehicle, -1, contactStiffness=body.k_initial, linearDamping=0.0,
                             angularDamping=0.0, **plain)  # fmt: skip
        world.changeDynamics(wall, -1, contactStiffness=1e18, **plain)
        world.setGravity(0.0, 0.0, 0.0)
        front = float(body.nodes[:, 0].max())

        def run(setting: float) -> Answer:
            world.setPhysicsEngineParameter(
                fixedTimeStep=setting,
                numSolverIterations=ITERATIONS,
                useSplitImpulse=0,
                numSubSteps=0,
                contactBreakingThreshold=1e-3,
            )
            world.resetBasePositionAndOrientation(vehicle, [-front, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0])
            world.resetBaseVelocity(vehicle, [case.speed, 0.0, 0.0], [0.0, 0.0, 0.0])
            crush = force = 0.0
            steps, last = 0, case.speed
            begin = time.perf_counter()
            while steps * setting < 1.0:
                world.stepSimulation()
                steps += 1
                now = world.getBaseVelocity(vehicle)[0][0]
                crush = max(crush, world.getBasePositionAndOrientation(vehicle)[0][0] + front)
                force = max(force, last - now)
                if now < 0.0 and abs(now - last) < 1e-12:
                    break
                last = now
            taken = time.perf_counter() - begin
            return Answer(crush, force * body.mass / setting, -now, steps, taken)

        return run


RIVALS = (Bullet(),)
