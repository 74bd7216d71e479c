"""MuJoCo with its own soft contact: one free body, n spheres, one plane. Elastic: W1 only.

Newton, warm start, contacts without friction (condim 1), direct stiffness. With equal impedances dd all
along, MuJoCo solves (A + R) f = aref - a0 with R = (1 - dd) / dd / m and aref = s / dd r for a solref of
(-s, 0): n nodes at a depth r share f = n s m r / (dd n + 1 - dd), which gives s of a wanted stiffness.
"""

from __future__ import annotations

import time
from collections.abc import Mapping

import numpy as np

from .definition import STEPS, Answer, Case, Run, block
from .mujoco_callback import body_xml, engine

IMPEDANCE = 0.9
RADIUS = 0.01  # m


class SoftContact:
    does_more = "general collision search and a convex solver for stacked bodies with friction"
    settings = STEPS
    wrong: Mapping[str, str] = {
        "W2": "its contact is elastic",
        "W3": "its contact is elastic",
    }

    def __init__(self, integrator: str) -> None:
        self.name = f"MuJoCo, soft contact, {integrator}"
        self.setup = f"Newton, warm start, condim 1, direct stiffness, {integrator}"
        self.integrator = integrator

    def build(self, case: Case, n: int) -> Run:
        mujoco = engine()
        body = block(case, n)
        stiffness = n * body.k_initial
        s = stiffness / body.mass * (IMPEDANCE * n + 1.0 - IMPEDANCE) / n
        contact = f'solref="{-s} 0" solimp="{IMPEDANCE} {IMPEDANCE} 1 0.5 1" condim="1"'
        points = "".join(
            f'<geom type="sphere" size="{RADIUS}" pos="{x - RADIUS} {y} {z}" conaffinity="0" {contact}/>'
            for x, y, z in body.nodes
        )
        plane = f'<geom type="plane" size="0 0 1" zaxis="-1 0 0" contype="0" conaffinity="1" {contact}/>'
        # Off-diagonal pairs are none: the spheres do not see each other.
        xml = body_xml(body.mass, body.inertia, self.integrator, 'solver="Newton"') % (plane, points)
        memory = f'<size memory="{max(10, n // 40)}M"/>'
        model = mujoco.MjModel.from_xml_string(xml.replace("<option", memory + "<option", 1))
        data = mujoco.MjData(model)
        front = float(body.nodes[:, 0].max())

        def run(setting: float) -> Answer:
            mujoco.mj_resetData(model, data)
            model.opt.timestep = setting
            data.qpos[:] = (-front, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
            data.qvel[:] = (case.speed, 0.0, 0.0, 0.0, 0.0, 0.0)
            place, speed = data.qpos, data.qvel  # views
            crush = force = 0.0
            steps, last = 0, case.speed
            step = mujoco.mj_step
            begin = time.perf_counter()
            while steps * setting < 1.0:
                step(model, data)
                steps += 1
                now = float(speed[0])
                crush = max(crush, float(place[0]) + front)
                force = max(force, last - now)
                if now < 0.0 and now == last:
                    break
                last = now
            taken = time.perf_counter() - begin
            return Answer(crush, force * body.mass / setting, -float(np.min(speed)), steps, taken)

        return run


# Runge-Kutta solves four times a step and is not better by as much.
RIVALS = (SoftContact("Euler"),)
