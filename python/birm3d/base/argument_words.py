"""Words about arguments that are refused: of what kind they must be, what was given, what was meant."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NoReturn

from .checks import shown
from .near_names import did_you_mean

__all__ = ["either", "got", "named", "plural", "refuse_unknown"]

_PACKAGE = __name__.partition(".")[0]
# Names that callers guess -> argument, and what to heed.
_MEANT = {
    "gap": ("spacing", "from axis to axis: the clear gap plus the diameter"),
    "clear_gap": ("spacing", "from axis to axis: the clear gap plus the diameter"),
    "radius": ("diameter", "twice the radius"),
    "mass": ("gvw", "the mass of the loaded vehicle"),
    "velocity": ("impact_speed", ""),
}


def named(kind: type) -> str:
    """Return what a message calls a class."""
    public = kind.__module__.partition(".")[0] == _PACKAGE
    return f"a {_PACKAGE}.{_public_name(kind)}" if public else f"a {_public_name(kind)}"


def _public_name(kind: type) -> str:
    name: str = getattr(kind, "_public_name", kind.__name__)  # of the public class that is made of it
    return name


def plural(words: str) -> str:
    """Return "numbers" for "a number", "lists of numbers" for "a list of numbers"."""
    if " or " in words:
        return " or ".join(plural(one) for one in words.split(" or "))
    if words.startswith("a list of "):
        return words.replace("a list of", "lists of")
    one = words.removeprefix("a ").removeprefix("an ")
    if one == words or " " in one or one.startswith(f"{_PACKAGE}."):  # names of classes have no plural
        return one
    return f"{one}s"


def either(words: Iterable[str]) -> str:
    """Return "a, b or c"."""
    *most, last = words
    return f"{', '.join(most)} or {last}" if most else last


def got(value: Any, by_type: bool, classes: Iterable[type]) -> str:
    """Return what was given, and how to make an instance of one of the classes from it, where that is known.

    ``_of_text`` of a class: how to make one from its name. ``_leads_to`` of the value's class: how to make
    others from it. ``by_type``: the value's class is shown, not the value.
    """
    if isinstance(value, str):
        hints = [one._of_text for one in classes if hasattr(one, "_of_text")]
        return "".join([shown(value), *(f"; {hint.format(shown(value))}" for hint in hints[:1])])
    if not by_type or value is None:
        return shown(value)
    leads_to = getattr(type(value), "_leads_to", {})
    ways = [leads_to[name] for name in map(_public_name, classes) if name in leads_to]
    return "".join([_public_name(type(value)), *(f"; {way}" for way in ways[:1])])


def refuse_unknown(
    function: Callable[..., Any], owner: type | None, name: str, own: Iterable[str]
) -> NoReturn:
    """Raise for an argument that a function does not have, with the one that was meant."""
    known = [one for one in own if one not in ("self", "cls") and not one.startswith("_")]
    called = owner.__name__ if owner is not None and function.__name__ == "__init__" else function.__name__
    instead, heed = _MEANT.get(name, ("", ""))
    if instead in known:
        near = f", did you mean {instead!r}{f' ({heed})' if heed else ''}?"
    else:
        near = did_you_mean(name, known)
    raise TypeError(f"{called}() must be given arguments among {', '.join(known)}; got {name!r}{near}")
