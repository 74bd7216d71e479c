"""Impacts whose answer is known: closed forms of a mass on springs, and integrators written for the test."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable

import numpy as np
import pytest
from birm3d import Barrier, Result, Settings, Simulation, Vehicle, Zone, scenes
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

MASS, SPEED = 6804.0, 22.352  # 15,000 lb at 50 mph
FREE = {"gravity": 0.0, "ground": False}

# The default tolerance of Settings: the wanted relative error of the metrics.
DEFAULT = 1e-3


@pytest.mark.parametrize("n", [100, 1000, 10_000])
def test_w1_elastic_impact(n: int) -> None:
    k = 3e6
    omega = math.sqrt(k / MASS)
    result = scenes.w1(n).run()
    metrics = result.metrics
    assert metrics["dynamic_crush"] == pytest.approx(SPEED / omega, rel=DEFAULT)  # 1.0645 m
    assert metrics["peak_deceleration"] == pytest.approx(SPEED * omega, rel=DEFAULT)  # 47.9 g
    assert metrics["peak_normal_force"] == pytest.approx(SPEED * math.sqrt(k * MASS), rel=DEFAULT)
    assert result.velocity[-1] == pytest.approx([-SPEED, 0.0, 0.0], rel=DEFAULT, abs=1e-9)
    touching = np.flatnonzero(result.barrier_normal_force > 0.0)
    # The last force falls within a row of the output: its interval on top.
    duration = result.time[touching[-1]]
    assert duration == pytest.approx(math.pi / omega, abs=DEFAULT * math.pi / omega + 1e-4)  # 149.6 ms
    assert metrics["residual_crush"] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("n", [100, 1000, 10_000])
def test_w2_crush_with_a_knee(n: int) -> None:
    k1, knee, k2, ku = 3e6, 0.4, 6e6, 60e6
    # 1/2 m v^2 = 1/2 k1 knee^2 + k1 knee x + 1/2 k2 x^2, with x beyond the knee.
    rest = 0.5 * MASS * SPEED**2 - 0.5 * k1 * knee**2
    x = (-k1 * knee + math.sqrt((k1 * knee) ** 2 + 2.0 * k2 * rest)) / k2
    peak = k1 * knee + k2 * x
    metrics = scenes.w2(n).run().metrics
    assert metrics["dynamic_crush"] == pytest.approx(knee + x, rel=DEFAULT)  # 0.9256 m
    assert metrics["peak_normal_force"] == pytest.approx(peak, rel=DEFAULT)  # 4353.8 kN
    assert metrics["exit_speed"] == pytest.approx(peak / math.sqrt(ku * MASS), rel=DEFAULT)  # 6.814 m/s
    assert metrics["restitution"] == pytest.approx(peak / math.sqrt(ku * MASS) / SPEED, rel=DEFAULT)
    assert metrics["residual_crush"] == pytest.approx(knee + x - peak / ku, rel=DEFAULT)


@pytest.mark.parametrize("scene", [scenes.w1, scenes.w2])
def test_the_number_of_nodes_does_not_matter(scene: Callable[[int], Simulation]) -> None:
    few, more, many = (scene(n).run().metrics for n in (100, 1000, 10_000))
    for name in ("dynamic_crush", "peak_normal_force", "peak_deceleration", "exit_speed", "end_time"):
        # Only the rounding of sums over nodes differs, and it is amplified by no more than the step control.
        assert more[name] == pytest.approx(few[name], rel=1e-9)
        assert many[name] == pytest.approx(few[name], rel=1e-9)


@settings(max_examples=60)
@given(
    speed=st.floats(0.5, 40.0),
    log_k=st.floats(4.0, 8.0),
    log_mass=st.floats(1.0, 4.6),
)
def test_one_spring(spring_body: Callable[..., Vehicle], speed: float, log_k: float, log_mass: float) -> None:
    k, mass = 10.0**log_k, 10.0**log_mass
    omega = math.sqrt(k / mass)
    vehicle = spring_body(mass, k, length=2.0 * speed / omega)
    event = math.pi / omega
    choice = Settings(output_interval=event / 1000.0, **FREE)
    wall = Barrier.rigid_wall(friction=0.0)
    metrics = Simulation(vehicle, wall, speed, duration=1.1 * event, settings=choice).run().metrics
    assert metrics["peak_normal_force"] == pytest.approx(speed * math.sqrt(k * mass), rel=DEFAULT)
    assert metrics["dynamic_crush"] == pytest.approx(speed / omega, rel=DEFAULT)
    assert metrics["exit_speed"] == pytest.approx(speed, rel=DEFAULT)


@pytest.mark.parametrize("n", [100, 1000])
def test_fixed_steps_converge_at_second_order(n: int) -> None:
    omega = math.sqrt(3e6 / MASS)

    def error(step: float) -> float:
        choice = Settings(time_step=step, output_interval=1e-3, **FREE)
        result = scenes.w1(n, choice).run()
        contact = result.time < math.pi / omega
        t = result.time[contact]
        travel = (result.position - result.position[0])[contact, 0]
        exact = SPEED / omega * np.sin(omega * t)
        return float(np.abs(travel - exact).max())

    errors = np.array([error(step) for step in (4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4)])
    orders = np.log2(errors[:-1] / errors[1:])
    assert (orders > 1.8).all(), f"errors {errors}, orders {orders}"
    assert errors[-1] < 1e-5  # m; (omega dt)^2 / 24 of 1.06 m, times the angle pi: 4e-6


@pytest.mark.parametrize("tolerance", [1e-3, 1e-4, 1e-5])
@pytest.mark.parametrize("speed", [10.0, 16.0, SPEED])
def test_rebound_from_a_plateau(speed: float, tolerance: float) -> None:
    """A constant force leaves no error to see; the turn must not be stepped over all the same."""
    k, knee, ku = 3e6, 0.2, 60e6
    force = k * knee
    crush = knee + (0.5 * MASS * speed**2 - 0.5 * k * knee**2) / force
    block = scenes.elastic_block(4)
    vehicle = Vehicle.from_arrays(
        mass=MASS,
        inertia=block.inertia,
        nodes=block.nodes + np.array([2.0, 0.0, 0.0]),
        anchors=block.anchors,
        k_initial=k / 4,
        knee=knee,
        k_unloading=ku / 4,
    )
    choice = Settings(tolerance=tolerance, **FREE)
    metrics = Simulation(vehicle, Barrier.rigid_wall(friction=0.0), speed, settings=choice).run().metrics
    assert metrics["dynamic_crush"] == pytest.approx(crush, rel=tolerance)
    # The speed after is small beside the speed before, against which errors are judged.
    assert metrics["exit_speed"] == pytest.approx(force / math.sqrt(ku * MASS), abs=tolerance * speed)


ENVELOPE = ((0.0, 0.0), (0.1, 6e5), (0.25, 2e5), (0.5, 9e5), (0.8, 1.5e6))
K_UNLOADING = 2e7


def envelope_block(n: int = 100) -> Vehicle:
    """The block of W1 with a front that peaks, buckles and hardens; numbers of the whole front."""
    block = scenes.elastic_block(n)
    return dataclasses.replace(
        block,
        area=np.full(n, 1.0 / n),
        zone_of_node=np.zeros(n, np.int64),
        zones={"front": Zone(envelope=ENVELOPE, k_unloading=K_UNLOADING)},
        _truss_laws=None,
    )


@pytest.mark.parametrize("speed", [3.0, 6.0, 10.0, 16.0])
def test_envelope_with_a_falling_part(speed: float) -> None:
    d, f = np.array(ENVELOPE).T

    def front(x: float) -> float:
        return float(np.interp(x, d, f))

    def stop(_t: float, state: np.ndarray) -> float:
        return float(state[1])

    stop.terminal = True  # type: ignore[attr-defined]
    # Steps of 0.1 ms keep the kinks of the envelope from being stepped over unseen.
    exact = solve_ivp(
        lambda _t, s: [s[1], -front(s[0]) / MASS],
        (0.0, 1.0),
        [0.0, speed],
        method="DOP853",
        events=stop,
        rtol=1e-10,
        atol=1e-10,
        max_step=1e-4,
    )
    crush, time = float(exact.y_events[0][0, 0]), float(exact.t_events[0][0])
    # The same crush by energy: the area under the envelope is the kinetic energy.
    x = np.linspace(0.0, crush, 200_001)
    work = float(np.trapezoid(np.interp(x, d, f), x))
    assert work == pytest.approx(0.5 * MASS * speed**2, rel=1e-7)

    wall = Barrier.rigid_wall(friction=0.0)
    run = Simulation(envelope_block(), wall, speed, settings=Settings(**FREE)).run()
    metrics = run.metrics
    assert metrics["dynamic_crush"] == pytest.approx(crush, rel=DEFAULT)
    assert metrics["time_of_zero_velocity"] == pytest.approx(time, rel=2 * DEFAULT)
    assert metrics["exit_speed"] == pytest.approx(
        front(crush) / math.sqrt(K_UNLOADING * MASS), rel=2 * DEFAULT
    )
    # The envelope's sharp peak falls between two steps: half a percent at the default tolerance.
    assert metrics["peak_normal_force"] == pytest.approx(float(np.interp(x, d, f).max()), rel=5 * DEFAULT)
    assert run.energy["crushed"][-1] == pytest.approx(
        work - 0.5 * front(crush) ** 2 / K_UNLOADING, rel=2 * DEFAULT
    )


# ---- W3: oblique, staggered front, free rotation -----------------------------------------------------------


def staggered_block() -> Vehicle:
    return scenes.laboratory_block(
        100, k_initial=3e6, knee=0.4, k_hardening=6e6, k_unloading=60e6, stagger=0.05
    )


class Oracle:
    """W3 written down once more, as plain NumPy: classical Runge-Kutta, the memory of trusses kept per step.

    A node at the wall moves in body axes along the wall's normal so that it stays on it; the truss force
    follows Fig. 3; its projection on the normal, and friction, push the body.
    """

    def __init__(self, vehicle: Vehicle, friction: float) -> None:
        n = vehicle.n_nodes
        self.mass, self.inertia, self.friction = vehicle.mass, vehicle.inertia, friction
        self.inverse_inertia = np.linalg.inv(vehicle.inertia)
        self.anchor = vehicle.anchors
        self.length = np.linalg.norm(vehicle.nodes - vehicle.anchors, axis=1)
        self.k1, self.knee, self.k2, self.ku = 3e6 / n, 0.4, 6e6 / n, 60e6 / n
        self.peak = np.zeros(n)
        self.held = np.zeros(n, bool)
        self.normal = np.array([-1.0, 0.0, 0.0])  # of the wall, world axes; the wall passes through 0

    def envelope(self, d: np.ndarray) -> np.ndarray:
        return self.k1 * np.clip(d, 0.0, self.knee) + self.k2 * np.maximum(0.0, d - self.knee)

    @staticmethod
    def rotation(q: np.ndarray) -> np.ndarray:
        w, x, y, z = q / np.linalg.norm(q)
        return np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ]
        )

    def on_wall(self, position: np.ndarray, R: np.ndarray, nodes: np.ndarray) -> tuple[np.ndarray, ...]:  # noqa: N803
        """Nodes held at the wall, their force, deflection, and the wall's normal; body axes."""
        n = R.T @ self.normal
        gap = nodes @ n + position @ self.normal
        held = self.held | (gap < 0.0)
        nodes = nodes - np.where(held, gap, 0.0)[:, None] * n
        arm = nodes - self.anchor
        size = np.linalg.norm(arm, axis=1)
        d = self.length - size
        line = self.envelope(self.peak) - self.ku * (self.peak - d)
        force = np.where(held, np.where(d > self.peak, self.envelope(d), np.maximum(0.0, line)), 0.0)
        pressure = force * np.maximum(0.0, -(arm @ n) / size)
        return nodes, held, force, pressure, d, n

    def rates(self, y: np.ndarray) -> np.ndarray:
        position, q, velocity, spin_momentum = y[0:3], y[3:7], y[7:10], y[10:13]
        R = self.rotation(q)  # noqa: N806
        nodes, held, _, pressure, _, n = self.on_wall(position, R, y[13:].reshape(-1, 3))
        v = R.T @ velocity
        omega = self.inverse_inertia @ (R.T @ spin_momentum)
        force = pressure[:, None] * n
        if self.friction > 0.0:
            slide = v + np.cross(omega, nodes)
            slide = slide - (slide @ n)[:, None] * n
            speed = np.linalg.norm(slide, axis=1)
            # The core lets friction fade below a hundredth of the impact speed.
            force = force - (self.friction * pressure / np.maximum(speed, 0.01 * SPEED))[:, None] * slide
        torque = np.cross(nodes, force).sum(axis=0)
        # gap = n . x + p . N stays 0:  x' = -(n' . x + v . N) n  with  n' = -omega x n.
        gap_rate = nodes @ -np.cross(omega, n) + velocity @ self.normal
        moving = np.where(held & (pressure > 0.0), -gap_rate, 0.0)[:, None] * n
        w, x = q[0], q[1:]
        return np.concatenate(
            [
                velocity,
                0.5 * np.concatenate([[-x @ omega], w * omega + np.cross(x, omega)]),
                R @ force.sum(axis=0) / self.mass,
                R @ torque,
                moving.ravel(),
            ]
        )

    def run(self, y: np.ndarray, step: float, duration: float) -> np.ndarray:
        for _ in range(round(duration / step)):
            a = self.rates(y)
            b = self.rates(y + 0.5 * step * a)
            c = self.rates(y + 0.5 * step * b)
            d = self.rates(y + step * c)
            y = y + step / 6.0 * (a + 2.0 * b + 2.0 * c + d)
            nodes, held, force, _, deflection, _ = self.on_wall(
                y[0:3], self.rotation(y[3:7]), y[13:].reshape(-1, 3)
            )
            self.held = held & (force > 0.0)
            self.peak = np.where(self.held, np.maximum(self.peak, deflection), self.peak)
            y = np.concatenate([y[:13], nodes.ravel()])
        return y


def oblique_laboratory(angle: float, friction: float, tolerance: float, duration: float) -> Result:
    choice = Settings(tolerance=tolerance, output_interval=1e-4, **FREE)
    wall = Barrier.rigid_wall(friction=friction)
    return Simulation(staggered_block(), wall, SPEED, angle, duration=duration, settings=choice).run()


@pytest.mark.parametrize(
    ("angle", "friction", "duration"),
    [
        (65.0, 0.0, 0.15),  # 25 deg off head-on: crush, turn by 30 deg, separation
        (65.0, 0.2, 0.15),
        (25.0, 0.2, 0.06),  # 25 deg to the wall, up to the instant before the first truss closes
    ],
)
def test_w3_oblique_with_friction(angle: float, friction: float, duration: float) -> None:
    vehicle = staggered_block()
    oracle = Oracle(vehicle, friction)
    fine = oblique_laboratory(angle, friction, 1e-7, duration)
    half_yaw = math.radians(90.0 - angle) / 2.0
    start = [
        fine.position[0],
        [math.cos(half_yaw), 0.0, 0.0, math.sin(half_yaw)],
        fine.velocity[0],
        np.zeros(3),
    ]
    assert (vehicle.nodes @ oracle.rotation(start[1]).T + start[0]).max(axis=0)[0] == pytest.approx(
        0.0, abs=1e-9
    )
    end = oracle.run(np.concatenate([*start, vehicle.nodes.ravel()]), 1e-4, duration)
    velocity = end[7:10]
    spin = np.degrees(oracle.inverse_inertia @ oracle.rotation(end[3:7]).T @ end[10:13])

    # Measured: 4e-7 of the impact speed, 7e-6 of the spin, 1e-7 of the crush. The oracle's steps make
    # the larger part: its memory is kept per step.
    assert np.abs(fine.velocity[-1] - velocity).max() < 2e-6 * SPEED
    assert np.abs(fine.angular_velocity[-1] - spin).max() < 2e-5 * np.abs(spin).max()
    assert fine.peak_deflection.max() == pytest.approx(oracle.peak.max(), rel=2e-6)

    usual = oblique_laboratory(angle, friction, DEFAULT, duration)
    assert np.abs(usual.velocity[-1] - velocity).max() < DEFAULT * SPEED
    # A vehicle that hardly turns yet is judged against a hundredth of speed over length.
    turning = max(np.abs(spin).max(), 0.01 * math.degrees(SPEED / 2.5))
    assert np.abs(usual.angular_velocity[-1] - spin).max() < DEFAULT * turning
    assert usual.peak_deflection.max() == pytest.approx(oracle.peak.max(), rel=DEFAULT)
