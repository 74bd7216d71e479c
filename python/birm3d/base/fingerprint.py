"""Fingerprints of scenes and values: equal ones mean equal bits, in any process and at any time."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Mapping, Sequence
from pathlib import PurePath
from typing import Any

import numpy as np

__all__ = ["fingerprint"]


def fingerprint(*things: Any) -> str:
    """Return 32 hexadecimal digits (BLAKE2b) of scenes, vehicles, barriers, settings, numbers, texts.

    Raises
    ------
    TypeError
        If a thing is of a kind whose content is not known.
    """
    digest = hashlib.blake2b(digest_size=16)
    for thing in things:
        _feed(digest, thing)
    return digest.hexdigest()


def _feed(digest: hashlib.blake2b, thing: Any) -> None:
    if isinstance(thing, np.generic):
        thing = thing.item()
    if thing is None or isinstance(thing, (bool, int, str, PurePath)):
        _mark(digest, type(thing).__name__, str(thing))
    elif isinstance(thing, float):
        _mark(digest, "float", float(thing).hex())
    elif isinstance(thing, np.ndarray):
        _mark(digest, "array", f"{thing.dtype.str}{thing.shape}")
        digest.update(np.ascontiguousarray(thing).tobytes())
    elif hasattr(thing, "model_dump_json"):  # pydantic's: a vehicle's file
        _mark(digest, type(thing).__name__, thing.model_dump_json())
    elif dataclasses.is_dataclass(thing) and not isinstance(thing, type):
        _mark(digest, type(thing).__name__, "")
        for field in dataclasses.fields(thing):
            if field.compare:  # a vehicle's mesh follows from its file and density
                _feed(digest, getattr(thing, field.name))
    elif isinstance(thing, Mapping):
        _mark(digest, "mapping", str(len(thing)))
        for key, value in thing.items():
            _feed(digest, key)
            _feed(digest, value)
    elif isinstance(thing, Sequence):
        _mark(digest, "sequence", str(len(thing)))
        for value in thing:
            _feed(digest, value)
    else:
        raise TypeError(f"no fingerprint of a {type(thing).__name__}")


def _mark(digest: hashlib.blake2b, kind: str, text: str) -> None:
    encoded = text.encode()
    digest.update(f"{kind}:{len(encoded)}:".encode())
    digest.update(encoded)
