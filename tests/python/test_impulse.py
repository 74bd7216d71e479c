"""Impact of two rigid bodies (paper Eq. 1)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from birm3d import _core
from hypothesis import given
from hypothesis import strategies as st

XI = pytest.mark.parametrize("restitution", [0.0, 0.25, 0.5, 1.0])


class Impact:
    """Two bodies before and after; `a` is hit along `normal`, which points from b to a."""

    def __init__(self, restitution: float, seed: int | None = None, **given: Any) -> None:
        rng = np.random.default_rng(seed)

        def inertia() -> np.ndarray:
            turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
            return turn @ np.diag([2.0, 3.0, 4.0] * rng.uniform(0.5, 0.6, 3)) @ turn.T

        normal = rng.normal(size=3)
        self.before: dict[str, Any] = {
            "mass_a": rng.uniform(1.0, 5.0),
            "inertia_a": inertia(),
            "velocity_a": rng.normal(size=3),
            "spin_a": rng.normal(size=3),
            "mass_b": rng.uniform(1.0, 5.0),
            "inertia_b": inertia(),
            "velocity_b": rng.normal(size=3),
            "spin_b": rng.normal(size=3),
            "arm_a": rng.normal(size=3),
            "arm_b": rng.normal(size=3),
            "normal": normal / np.linalg.norm(normal),
        }
        self.before.update({key: np.asarray(value, float) for key, value in given.items()})
        self.restitution = restitution
        if self.separation(self.before) > 0.0:  # approaching is what Eq. 1 is about
            self.before["normal"] = -self.before["normal"]
        b = self.before
        self.impulse, *after = _core.collide(**b, restitution=restitution)
        self.after = {**b, **dict(zip(("velocity_a", "spin_a", "velocity_b", "spin_b"), after, strict=True))}

    @staticmethod
    def separation(s: dict[str, Any]) -> float:
        a = s["velocity_a"] + np.cross(s["spin_a"], s["arm_a"])
        b = s["velocity_b"] + np.cross(s["spin_b"], s["arm_b"])
        return float((a - b) @ s["normal"])

    def equation_1(self) -> float:
        b, n = self.before, self.before["normal"]
        denominator = 1.0 / b["mass_a"] + 1.0 / b["mass_b"]
        for body in "ab":
            arm = b[f"arm_{body}"]
            denominator += n @ np.cross(np.linalg.solve(b[f"inertia_{body}"], np.cross(arm, n)), arm)
        return -(1.0 + self.restitution) * self.separation(b) / denominator

    @staticmethod
    def momentum(s: dict[str, Any]) -> np.ndarray:
        return s["mass_a"] * s["velocity_a"] + s["mass_b"] * s["velocity_b"]

    @staticmethod
    def angular_momentum(s: dict[str, Any]) -> np.ndarray:
        """About the point of contact, where the mass centres stand at -arm."""
        total = np.zeros(3)
        for body in "ab":
            total += np.cross(-s[f"arm_{body}"], s[f"mass_{body}"] * s[f"velocity_{body}"])
            total += s[f"inertia_{body}"] @ s[f"spin_{body}"]
        return total

    @staticmethod
    def energy(s: dict[str, Any]) -> float:
        return sum(
            0.5 * s[f"mass_{b}"] * s[f"velocity_{b}"] @ s[f"velocity_{b}"]
            + 0.5 * s[f"spin_{b}"] @ s[f"inertia_{b}"] @ s[f"spin_{b}"]
            for b in "ab"
        )


CENTRAL = {
    "inertia_a": np.eye(3),
    "inertia_b": np.eye(3),
    "velocity_a": [-1.0, 0.0, 0.0],
    "spin_a": [0.0, 0.0, 0.0],
    "velocity_b": [2.0, 0.0, 0.0],
    "spin_b": [0.0, 0.0, 0.0],
    "arm_a": [-0.5, 0.0, 0.0],
    "arm_b": [0.5, 0.0, 0.0],
    "normal": [1.0, 0.0, 0.0],
}


@XI
def test_central_impact(restitution: float) -> None:
    impact = Impact(restitution, **CENTRAL, mass_a=2.0, mass_b=3.0)
    # Reduced mass 6/5, approach speed 3.
    assert impact.impulse == pytest.approx((1.0 + restitution) * 3.6, rel=1e-12)
    assert impact.after["velocity_a"] == pytest.approx([-1.0 + impact.impulse / 2.0, 0.0, 0.0], abs=1e-12)
    assert impact.after["velocity_b"] == pytest.approx([2.0 - impact.impulse / 3.0, 0.0, 0.0], abs=1e-12)
    assert np.abs([impact.after["spin_a"], impact.after["spin_b"]]).max() == 0.0


def test_equal_masses_exchange_their_velocities() -> None:
    impact = Impact(1.0, **CENTRAL, mass_a=4.0, mass_b=4.0)
    assert impact.after["velocity_a"] == pytest.approx([2.0, 0.0, 0.0], abs=1e-12)
    assert impact.after["velocity_b"] == pytest.approx([-1.0, 0.0, 0.0], abs=1e-12)


@XI
def test_eccentric_impact_of_a_rod(restitution: float) -> None:
    # A rod that falls flat on a fixed peg under its end: j = (1 + xi) m v / (1 + m arm^2 / I).
    m, arm, inertia, speed = 3.0, 0.6, 0.36, 2.0
    impact = Impact(
        restitution,
        mass_a=m,
        inertia_a=np.diag([0.1, inertia, inertia]),
        velocity_a=[0.0, 0.0, -speed],
        spin_a=np.zeros(3),
        mass_b=1e15,  # a peg that nothing moves
        inertia_b=1e15 * np.eye(3),
        velocity_b=np.zeros(3),
        spin_b=np.zeros(3),
        arm_a=[arm, 0.0, 0.0],
        arm_b=np.zeros(3),
        normal=[0.0, 0.0, 1.0],
    )
    assert impact.impulse == pytest.approx(
        (1.0 + restitution) * m * speed / (1.0 + m * arm**2 / inertia), rel=1e-12
    )
    assert impact.after["spin_a"][1] == pytest.approx(-arm * impact.impulse / inertia, rel=1e-12)


@XI
@given(seed=st.integers(0, 10**6))
def test_any_impact(restitution: float, seed: int) -> None:
    impact = Impact(restitution, seed)
    before, after = impact.before, impact.after
    assert impact.impulse == pytest.approx(impact.equation_1(), rel=1e-11)
    assert impact.separation(after) == pytest.approx(-restitution * impact.separation(before), abs=1e-12)
    assert impact.momentum(after) == pytest.approx(impact.momentum(before), abs=1e-12)
    assert impact.angular_momentum(after) == pytest.approx(impact.angular_momentum(before), abs=2e-12)
    # What an impact takes: (1 - xi^2) / 2 * v_rel^2 / (Eq. 1's denominator), nothing for xi = 1.
    loss = 0.5 * (1.0 - restitution) * -impact.separation(before) * impact.impulse
    assert impact.energy(before) - impact.energy(after) == pytest.approx(loss, abs=1e-11)


@given(seed=st.integers(0, 10**6))
def test_bodies_that_part_are_left_alone(seed: int) -> None:
    b = dict(Impact(0.5, seed).before)
    b["normal"] = -b["normal"]
    impulse, *after = _core.collide(**b, restitution=0.0)
    assert impulse == 0.0
    for name, value in zip(("velocity_a", "spin_a", "velocity_b", "spin_b"), after, strict=True):
        assert value == pytest.approx(b[name], abs=0.0)
