"""How a scene is computed."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

from .. import _core
from ..base.arguments import check_fields
from ..units import Quantity, quantity_in, si

__all__ = ["Settings"]


def _in(unit: str, default: float | None) -> Any:
    """Return a field whose number has a unit; others are pure numbers or choices."""
    return field(default=default, metadata={"unit": unit})


@dataclass(frozen=True)
class Settings:
    """How a scene is computed: SI units, immutable, checked when made.

    Times and gravity are also taken as text with a unit, as ``time_step="10 us"``.

    Parameters
    ----------
    time_step
        Fixed step [s]; ``None`` chooses steps by an error estimate (adaptive).
    tolerance
        Wanted relative error of the metrics with adaptive steps, 1e-9 to 1.
    output_interval
        Interval of the result's rows [s]; costs nothing while stepping and does not bound the step.
    gravity
        [m/s^2].
    ground
        Whether tyres and body meet the ground z = 0. The body of a vehicle without wheels, or with skin below
        the ground from the start, does not.
    mu_tire
        Tyre-pavement friction coefficient.
    mu_body
        Friction coefficient of the vehicle's body sliding on the ground.
    mu_tire_barrier
        Friction coefficient of tyres on a barrier, apart from that of the vehicle's body, which is the
        barrier's own ``friction``. ``None``: 0.6, and 0 at a barrier whose ``friction`` is 0, which is
        frictionless for all that meets it. Rubber that slides on dry concrete has 0.6 at some speed; tests at
        walking pace give up to 0.8. No vehicle was tested for it. A number holds at every barrier. See
        :attr:`birm3d.simulation.Scene.mu_tire_barrier`.
    braking
        Share of the tyre-pavement friction that brakes, 0 to 1: 0 wheels roll, 1 they are locked and slide.
    cornering_stiffness
        Lateral tyre force per normal load and radian of slip, at small slip [1/rad]. ``None``: that of the
        vehicle's zones of tyres, else 10. See :attr:`birm3d.simulation.Scene.cornering_stiffness`.
    restitution
        Of rigid contacts: tyres on the ground, the rigid body at the barrier (paper 5.2).
    edge_flank_factor
        Sideways force of the skin on the rounded edge of a wall that catches none of the rails, over that on
        a frictionless wedge. ``None``: that of the vehicle's file, else 1.25. See
        :attr:`birm3d.simulation.Scene.edge_flank_factor`.
    contact_model
        ``"projected"``: the truss force projected on the surface's normal, which keeps the energy;
        ``"along_truss"``: the paper's rule, for comparison.
    tire_model
        ``"slip"``: lateral force continuous in the slip angle; ``"skid"``: the paper's rule.

    Raises
    ------
    ValueError
        Naming the argument, its limit and the value received.
    """

    time_step: float | None = _in("s", None)
    tolerance: float = 1e-3
    output_interval: float = _in("s", 1e-4)
    gravity: float = _in("m/s^2", 9.80665)
    ground: bool = True
    mu_tire: float = 0.8
    mu_body: float = 0.4
    mu_tire_barrier: float | None = None
    braking: float = 0.0
    cornering_stiffness: float | None = _in("1/rad", None)
    restitution: float = 0.1
    edge_flank_factor: float | None = None
    contact_model: Literal["projected", "along_truss"] = "projected"
    tire_model: Literal["slip", "skid"] = "slip"

    if TYPE_CHECKING:  # what dataclass makes, and the text that __post_init__ reads

        def __init__(
            self,
            time_step: Quantity | None = None,
            tolerance: float = 1e-3,
            output_interval: Quantity = 1e-4,
            gravity: Quantity = 9.80665,
            ground: bool = True,
            mu_tire: float = 0.8,
            mu_body: float = 0.4,
            mu_tire_barrier: float | None = None,
            braking: float = 0.0,
            cornering_stiffness: float | None = None,
            restitution: float = 0.1,
            edge_flank_factor: float | None = None,
            contact_model: Literal["projected", "along_truss"] = "projected",
            tire_model: Literal["slip", "skid"] = "slip",
        ) -> None: ...

    def __post_init__(self) -> None:
        for one in fields(self):
            value: object = getattr(self, one.name)
            quantity = quantity_in(one.metadata.get("unit", ""))
            if isinstance(value, str) and quantity is not None:
                object.__setattr__(self, one.name, si(one.name, value, quantity))
        check_fields(self)
        _core.Settings(self.given)  # refuses what is out of range

    @cached_property
    def given(self) -> dict[str, Any]:
        """What the core is asked for, by name: all but what is the vehicle's or the barrier's."""
        contact_models = _core.ContactModel.__members__
        tire_models = _core.TireModel.__members__
        for name, value, known in (
            ("contact_model", self.contact_model, contact_models),
            ("tire_model", self.tire_model, tire_models),
        ):
            if value not in known:
                raise ValueError(f"{name} must be one of {', '.join(known)}; got {value!r}")
        given = {one.name: getattr(self, one.name) for one in fields(self)}
        given["contact_model"] = contact_models[self.contact_model]
        given["tire_model"] = tire_models[self.tire_model]
        return {name: value for name, value in given.items() if value is not None}

    def __getstate__(self) -> dict[str, object]:
        return {name: value for name, value in self.__dict__.items() if name != "given"}
