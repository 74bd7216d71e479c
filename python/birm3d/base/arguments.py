"""Arguments of public functions: refused by name where they are of another kind than the annotation says."""

from __future__ import annotations

import functools
import inspect
import os
import sys
import types
import typing
from collections import abc
from collections.abc import Callable, Container
from pathlib import Path
from typing import Any, Literal, NamedTuple, NoReturn, TypeVar, Union

import numpy as np

from .argument_words import either, got, named, plural, refuse_unknown
from .checks import is_number, is_whole

__all__ = ["WrongTypeError", "caller_level", "check_fields", "checked"]

Checked = TypeVar("Checked", bound=Callable[..., Any])


class WrongTypeError(ValueError, TypeError):
    """An argument is of a kind that can not be used; the message names it, what it must be and the value."""


class Kind(NamedTuple):
    """What an annotation asks for: its words, and whether a value is of that kind."""

    words: str
    holds: Callable[[Any], bool]
    by_type: bool = False  # whether a message shows the type of a value and not the value
    item: Any = None  # kind of the items of a list, of which a message names the first that is wrong
    classes: tuple[type, ...] = ()  # of this package, that a value may be an instance of


def checked(public: Checked) -> Checked:
    """Check the arguments of a function, or of all public methods of a class, before each call.

    Only the type that an annotation names is checked; the function itself checks limits. Left out are
    annotations that do not resolve at run time, and ``Quantity``, which :func:`birm3d.units.si` reads.

    Raises
    ------
    WrongTypeError
        By the wrapped function, naming the argument, what it must be and the value.
    """
    if not isinstance(public, type):
        return typing.cast(Checked, _checked_function(public))
    for name, member in list(vars(public).items()):
        if name.startswith("_") and name != "__init__":
            continue
        if isinstance(member, (staticmethod, classmethod)):
            setattr(public, name, type(member)(_checked_function(member.__func__, public)))
        elif inspect.isfunction(member):
            setattr(public, name, _checked_function(member, public))
    return public


def caller_level() -> int:
    """Return the ``stacklevel`` by which a warning points at the line that called this package."""
    package = __name__.partition(".")[0]
    frame, level = sys._getframe(1), 1
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] == package:
        frame, level = frame.f_back, level + 1
    return level


def _checked_function(function: Callable[..., Any], owner: type | None = None) -> Callable[..., Any]:
    parameters = inspect.signature(function).parameters
    if not parameters.keys() - {"self", "cls"}:
        return function
    places = [p.name for p in parameters.values() if p.kind in _BY_PLACE]
    kinds: dict[str, Kind | None] | None = None
    by_place: list[Kind | None] = []

    @functools.wraps(function)
    def call(*args: Any, **kwargs: Any) -> Any:
        nonlocal kinds, by_place
        if kinds is None:
            found = _kinds_of(function, owner)  # not before: annotations may name what is imported later
            by_place = [found.get(name) for name in places]
            kinds = found  # last: another thread may look
        for place, (kind, value) in enumerate(zip(by_place, args, strict=False)):
            if kind is not None and not kind.holds(value):
                _refuse(places[place], kind, value)
        for name, value in kwargs.items():
            if name not in kinds and "**" not in kinds:
                refuse_unknown(function, owner, name, list(kinds))
            kind = kinds[name] if name in kinds else kinds.get("**")
            if kind is not None and not kind.holds(value):
                _refuse(name, kind, value)
        return function(*args, **kwargs)

    return call


_BY_PLACE = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)


def check_fields(instance: Any, texts: Container[str] = ()) -> None:
    """Check the fields of a dataclass as :func:`checked` does, where its constructor reads texts with units.

    ``texts`` names the fields that may be text now, or a list of it.
    """
    owner: type = type(instance)
    for name, kind in _field_kinds(type(instance).__init__, owner):
        value = getattr(instance, name)
        if not kind.holds(value) and not (name in texts and (isinstance(value, str) or _is_list(value))):
            _refuse(name, kind, value)


def _refuse(name: str, kind: Kind, value: Any) -> NoReturn:
    """Raise for a value that is not of the kind, or for its first item that is not."""
    if kind.item is not None and _is_list(value) and not isinstance(value, np.ndarray):
        for i, item in enumerate(value):
            if not kind.item.holds(item):
                _refuse(f"{name}[{i}]", kind.item, item)
    raise WrongTypeError(f"{name} must be {kind.words}, got {got(value, kind.by_type, kind.classes)}")


@functools.cache
def _field_kinds(constructor: Callable[..., Any], owner: type) -> tuple[tuple[str, Kind], ...]:
    kinds = _kinds_of(constructor, owner).items()
    return tuple((name, kind) for name, kind in kinds if name != "self" and kind is not None)


@functools.cache
def _kinds_of(function: Callable[..., Any], owner: type | None) -> dict[str, Kind | None]:
    """Return the kind of each argument; that of all others that a function takes is called "**"."""
    found: dict[str, Kind | None] = {}
    names = _names_for(function, owner)
    for name, parameter in inspect.signature(function).parameters.items():
        label = "**" if parameter.kind is parameter.VAR_KEYWORD else name
        if parameter.kind is not parameter.VAR_POSITIONAL:
            found[label] = None if name.startswith("_") else _kind(_resolved(parameter.annotation, names))
    return found


def _names_for(function: Callable[..., Any], owner: type | None) -> dict[str, Any]:
    """Return what annotations can name: a dataclass has fields whose types only the base's module knows."""
    found = dict(vars(sys.modules[__name__.partition(".")[0]]))
    for base in reversed(owner.__mro__ if owner else ()):
        found.update(getattr(sys.modules.get(base.__module__), "__dict__", {}))
    return {**found, **inspect.unwrap(function).__globals__}


def _resolved(annotation: Any, names: dict[str, Any]) -> Any:
    """Return an annotation as an object; ``Any`` where it names what is only there for the type checker."""
    if not isinstance(annotation, str):
        return annotation
    try:
        return eval(annotation, names)
    except AttributeError:
        return Any
    except NameError as unknown:
        package, name = sys.modules[__name__.partition(".")[0]], unknown.name
        if name is None or name not in package.__all__:
            return Any
        # The package loads it when it is asked for.
        return _resolved(annotation, {**names, name: getattr(package, name)})


def _kind(annotation: Any) -> Kind | None:
    """Return what an annotation asks for; ``None`` where it may be anything, or is not looked at."""
    if annotation in _PLAIN:
        return _PLAIN[annotation]
    origin, parts = typing.get_origin(annotation), typing.get_args(annotation)
    if origin in (Union, types.UnionType):
        return _one_of(parts)
    if origin is Literal:  # which of them is the function's own limit
        return Kind(f"one of {', '.join(map(str, parts))}", lambda value: isinstance(value, str))
    if origin is np.ndarray:
        return _ARRAY
    if origin is abc.Callable:
        return Kind("a function", callable)
    if origin is not None:
        return _container(origin, parts)
    if isinstance(annotation, type) and annotation is not object:
        holds = functools.partial(_instance_of, annotation)
        return Kind(named(annotation), holds, by_type=True, classes=(annotation,))
    return None


def _instance_of(wanted: type, value: Any) -> bool:
    return isinstance(value, wanted)


def _one_of(parts: tuple[Any, ...]) -> Kind | None:
    if float in parts and str in parts:
        return None  # a Quantity, which units.si() reads and refuses with its units
    if set(_ARRAY_LIKE) <= set(parts):
        rest = tuple(part for part in parts if part not in _ARRAY_LIKE)
        kinds: list[Kind | None] = [_ARRAY, *map(_kind, rest)]
    else:
        kinds = [_kind(part) for part in parts]
    known = [kind for kind in kinds if kind is not None]
    if len(known) < len(kinds):
        return None
    others = [kind for kind in known if kind is not _NONE]
    words = list(dict.fromkeys(kind.words for kind in others))
    return Kind(
        either(words),
        lambda value: any(kind.holds(value) for kind in known),
        by_type=any(kind.by_type for kind in known),
        item=others[0].item if len(others) == 1 else None,
        classes=tuple(one for kind in others for one in kind.classes),
    )


def _container(origin: Any, parts: tuple[Any, ...]) -> Kind | None:
    if not isinstance(origin, type):
        return None
    if issubclass(origin, abc.Mapping):
        values = _kind(parts[1])
        return Kind(
            "a mapping of names" + (f" to {plural(values.words)}" if values else ""),
            lambda found: (
                isinstance(found, abc.Mapping)
                and all(isinstance(name, str) for name in found)
                and (values is None or all(map(values.holds, found.values())))
            ),
        )
    if origin is tuple and parts[-1:] != (...,):
        return _row([_kind(part) for part in parts])
    if not issubclass(origin, abc.Iterable):
        return None
    item = _kind(parts[0])
    once = origin in (abc.Iterable, abc.Iterator)
    return Kind(
        f"a list of {plural(item.words) if item else 'values'}",
        lambda found: _is_list(found) and (once or item is None or _all_hold(item, found)),
        item=item,
    )


def _row(items: list[Kind | None]) -> Kind:
    """Of values in a row, whose number is the function's own limit."""
    known = [item for item in items if item is not None]
    words = plural(known[0].words) if len(known) == len(items) else "values"
    return Kind(f"a list of {words}", lambda found: _is_list(found) and _each_holds(known, items, found))


def _each_holds(known: list[Kind], items: list[Kind | None], found: Any) -> bool:
    alike = len(known) == len(items) and all(item is items[0] for item in items)
    return not alike or _all_hold(known[0], found)


def _is_list(found: Any) -> bool:
    """Whether something is a row of things; text, bytes and a mapping are none."""
    if isinstance(found, np.ndarray):
        return bool(found.ndim > 0)
    return isinstance(found, abc.Iterable) and not isinstance(found, (str, bytes, abc.Mapping, type))


def _all_hold(item: Kind, found: Any) -> bool:
    if not hasattr(found, "__len__"):  # what can be gone through but once is left to the function
        return True
    if item is _NUMBER and isinstance(found, np.ndarray):
        return found.ndim == 1 and found.dtype.kind in "iuf"
    return all(map(item.holds, found))


def _is_array(value: Any) -> bool:
    if isinstance(value, np.ndarray):
        return value.dtype.kind in "iuf" or (value.size == 0 and value.dtype.kind == "f")
    if isinstance(value, (bool, str, bytes, abc.Mapping, type)) or value is None:
        return False
    try:
        return np.asarray(value).dtype.kind in "iuf"
    except (TypeError, ValueError, OverflowError):
        return False


_NUMBER = Kind("a number", is_number)
_ARRAY = Kind("an array of numbers", _is_array)
_NONE = Kind("None", lambda value: value is None)
_ARRAY_LIKE = typing.get_args(np.typing.ArrayLike)
_PLAIN: dict[Any, Kind | None] = {
    Any: None,
    inspect.Parameter.empty: None,
    None: _NONE,
    type(None): _NONE,
    float: _NUMBER,
    int: Kind("a whole number", is_whole),
    bool: Kind("True or False", lambda value: isinstance(value, (bool, np.bool_))),
    str: Kind("text", lambda value: isinstance(value, str)),
    Path: Kind("a path", lambda value: isinstance(value, os.PathLike)),
}
