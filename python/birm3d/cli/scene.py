"""Command line: the options that say what is run, shared by all commands that run something."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from .. import units
from ..barrier.kinds import KINDS
from ..base.near_names import did_you_mean

if TYPE_CHECKING:
    from ..barrier.barrier import Barrier
    from ..simulation.simulation import Simulation

__all__ = ["QuantityOption", "barrier_of", "scene_options", "simulation_of"]

Command = TypeVar("Command", bound=Callable[..., Any])


class QuantityOption(click.ParamType):  # type: ignore[type-arg,unused-ignore]
    """A number with a unit, such as 50mph; without one SI, angles in degrees. A speed must have its unit."""

    def __init__(self, quantity: str) -> None:
        self.name = quantity

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Return the value in SI; degrees for angles."""
        if isinstance(value, float):
            return value
        try:
            return units.parse(value, self.name, plain=self.name != "speed")
        except ValueError as error:
            self.fail(str(error), param, ctx)


class KindChoice(click.Choice):  # type: ignore[type-arg,unused-ignore]
    """A choice that says which name was most likely meant."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the choice."""
        try:
            return super().convert(value, param, ctx)
        except click.BadParameter as error:
            self.fail(error.message + did_you_mean(str(value), map(str, self.choices), " Did"), param, ctx)


_FOUNDATION = (
    ("moment", "moment", 'that it resists about its centre of rotation: "450 kN m".'),
    ("rotation_depth", "length", "centre of rotation below the ground.  [default: 0 m]"),
    ("mass", "mass", "what turns below the ground, for its inertia.  [default: 0 kg]"),
)
"""Arguments of :class:`birm3d.Foundation`: name, quantity, help."""

_TYPES: dict[str, Any] = {
    "count": int,
    "length": QuantityOption("length"),
    "density": QuantityOption("density"),
    "pressure": QuantityOption("pressure"),
}


def _size_options() -> Iterator[Callable[[Command], Command]]:
    """Yield the options of all sizes that kinds of barriers have."""
    sizes = {size.name: size for kind in KINDS.values() for size in kind.sizes}
    for name, size in sizes.items():
        titles = [kind.title for kind in KINDS.values() if any(other.name == name for other in kind.sizes)]
        hints = dict.fromkeys(
            other.hint for kind in KINDS.values() for other in kind.sizes if other.name == name and other.hint
        )
        text = f"Of {' or '.join(titles)}{''.join(', ' + hint for hint in hints)}."
        option = f"--{name.replace('_', '-')}"
        if size.quantity == "foundation":
            for part, quantity, meaning in _FOUNDATION:
                text = f"Foundation of {' or '.join(titles)} that yield: {meaning}"
                yield click.option(
                    f"{option}-{part.replace('_', '-')}", type=QuantityOption(quantity), help=text
                )
        elif size.quantity == "flag":
            yield click.option(option, is_flag=True, default=None, help=text)
        elif size.quantity == "choice":
            yield click.option(option, type=click.Choice(size.choices), help=text)
        else:
            yield click.option(option, type=_TYPES[size.quantity], help=text)


_BY_DEFAULT = (click.core.ParameterSource.DEFAULT, click.core.ParameterSource.DEFAULT_MAP)

_OPTIONS = (
    click.argument("scene", required=False, type=click.Path(exists=True, dir_okay=False, path_type=Path)),
    click.option("--vehicle", help="Preset (see `birm3d vehicles`) or vehicle file (.toml)."),
    click.option(
        "--gvw", type=QuantityOption("mass"), help="Gross vehicle weight: 4500lb, 7.5t or 1719 (kg)."
    ),
    click.option(
        "--mesh-density", type=float, default=1.0, show_default=True, help="Elements relative to the file's."
    ),
    click.option(
        "--sliding-bed",
        is_flag=True,
        help="Let the load bed slide on the frame (trucks whose file has a bed).",
    ),
    click.option(
        "--barrier",
        type=KindChoice([*KINDS, "none"]),
        default="rigid_wall",
        show_default=True,
    ),
    *_size_options(),
    click.option("--friction", type=float, default=0.2, show_default=True, help="Vehicle on barrier."),
    click.option("--speed", type=QuantityOption("speed"), help="With its unit: 50mph, 57.09km/h or 15.9m/s."),
    click.option(
        "--angle",
        type=QuantityOption("angle"),
        default=90.0,
        show_default=True,
        help="Path to barrier line, deg.",
    ),
    click.option(
        "--offset",
        type=QuantityOption("length"),
        default=0.0,
        show_default=True,
        help="Along the barrier, m; at angle 0 behind its line.",
    ),
    click.option(
        "--overlap", type=float, help="Share of the vehicle's width that meets the barrier, 0 to 1."
    ),
    click.option(
        "--overlap-side",
        type=click.Choice(["left", "right"]),
        default="left",
        show_default=True,
        help="Of the vehicle, from which the overlap is counted.",
    ),
    click.option(
        "--yaw",
        type=QuantityOption("angle"),
        default=0.0,
        show_default=True,
        help="Nose to the left of the path, deg.",
    ),
    click.option(
        "--roll",
        type=QuantityOption("angle"),
        default=0.0,
        show_default=True,
        help="To the right at impact, deg.",
    ),
    click.option("--duration", type=QuantityOption("time"), help="Default: until the outcome is decided."),
    click.option(
        "--output-interval", type=QuantityOption("time"), help="Between rows of histories.  [default: 0.1ms]"
    ),
    click.option("--tolerance", type=float, help="Wanted relative error.  [default: 0.001]"),
    click.option("--time-step", type=QuantityOption("time"), help="Fixed step.  [default: adaptive]"),
)


def scene_options(command: Command) -> Command:
    """Give a command the argument SCENE and the options that can take its place."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command


def simulation_of(scene: Path | None, options: dict[str, Any]) -> Simulation:
    """Return the simulation of a scene file, or of the options of :func:`scene_options`."""
    from ..scene.settings import Settings
    from ..simulation.simulation import Simulation
    from ..vehicle.vehicle import Vehicle

    context = click.get_current_context()
    given = [
        f"--{name.replace('_', '-')}"
        for name in options
        if context.get_parameter_source(name) not in _BY_DEFAULT
    ]
    if scene is not None:
        if given:
            raise click.UsageError(f"{', '.join(given)}: a scene file states everything itself")
        from ..simulation.scene_file import read_scene_file

        return read_scene_file(scene)
    for name in ("vehicle", "speed"):
        if options[name] is None:
            raise click.UsageError(f"give a scene file, or --vehicle and --speed: --{name} is missing")
    make = Vehicle.from_file if options["vehicle"].endswith(".toml") else Vehicle.preset
    vehicle = make(options["vehicle"], gvw=options["gvw"], mesh_density=options["mesh_density"])
    if options["sliding_bed"]:
        vehicle = vehicle.with_sliding_bed()
    barrier = barrier_of(options)
    settings = {
        name: options[name]
        for name in ("tolerance", "time_step", "output_interval")
        if options[name] is not None
    }
    return Simulation(
        vehicle,
        barrier,
        options["speed"],
        options["angle"],
        options["offset"],
        impact_yaw=options["yaw"],
        impact_roll=options["roll"],
        duration=options["duration"],
        settings=Settings(**settings),
        overlap=options["overlap"],
        overlap_side=options["overlap_side"],
    )


def barrier_of(options: dict[str, Any]) -> Barrier | None:
    """Return the barrier of the options of :func:`scene_options`."""
    from ..barrier.barrier import Barrier
    from ..barrier.yielding import Foundation

    kind = options["barrier"]
    names_of = {name: [size.name for size in made.sizes] for name, made in KINDS.items()}
    known = dict.fromkeys(name for names in names_of.values() for name in names)
    sizes: dict[str, Any] = {name: options[name] for name in known if options.get(name) is not None}
    foundation = {
        part: options[f"foundation_{part}"]
        for part, _, _ in _FOUNDATION
        if options.get(f"foundation_{part}") is not None
    }
    if foundation:
        sizes["foundation"] = foundation
    for name in sizes:
        if name not in names_of.get(kind, ()):
            option = name if name != "foundation" else f"foundation_{next(iter(foundation))}"
            kinds = " or ".join(other for other, names in names_of.items() if name in names)
            raise click.UsageError(f"--{option.replace('_', '-')}: of {kinds}, not of {kind}")
    if foundation:
        if "moment" not in foundation:
            raise click.UsageError("--foundation-moment is missing: a foundation must have one")
        sizes["foundation"] = Foundation(**foundation)
    return None if kind == "none" else getattr(Barrier, kind)(friction=options["friction"], **sizes)
