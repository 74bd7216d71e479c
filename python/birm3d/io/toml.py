"""Strict reading of TOML files: every error names file, line, key, limit and the value received."""

from __future__ import annotations

import re
import sys
from bisect import bisect_right
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NoReturn, TypeAlias, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError
from pydantic_core import ErrorDetails, PydanticCustomError

from .file_format import MOST_DEPTH, FileFormatError, depth, read_bytes, reading, received

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

__all__ = ["Document", "DocumentError", "KeyPath", "Locator", "Strict", "frozen", "received", "reject"]

Model = TypeVar("Model", bound=BaseModel)


class DocumentError(FileFormatError):
    """A file of TOML that can not be used; the message gives file, line, key, limit and value."""


class Strict(BaseModel):
    """A block of a file: immutable, no unknown keys, no NaN, no conversion from text."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)

    def changed(self: Block, changes: Mapping[str, Any]) -> Block:
        """Return the block with some fields changed, unchecked; cached properties are not copied along."""
        copy = self.model_copy(update=changes)
        for name in copy.__dict__.keys() - type(copy).model_fields.keys():
            del copy.__dict__[name]
        return copy


Block = TypeVar("Block", bound=Strict)


def plain(block: Strict) -> dict[str, Any]:
    """Return a block as TOML's own kinds, without what has its default."""
    content: dict[str, Any] = block.model_dump(by_alias=True, exclude_none=True, exclude_defaults=True)
    return {key: _listed(value) for key, value in content.items()}


def _listed(value: Any) -> Any:
    if isinstance(value, (list, tuple)):
        return [_listed(item) for item in value]
    if isinstance(value, dict):
        return {key: _listed(item) for key, item in value.items()}
    return value


def reject(key: str, message: str) -> NoReturn:
    """Fail on one key of a block, so that the error is reported on the key's own line."""
    raise PydanticCustomError("document", "{message}", {"key": key, "message": message})


KeyPath: TypeAlias = tuple[str | int, ...]
_MOST_BYTES = 16 * 2**20  # the largest vehicle of this package has 25,000
_HEADER = re.compile(r"(\[\[?)([^\[\]]+)\]")
_KEY = re.compile(r"""((?:[\w-]+|"[^"]*"|'[^']*')(?:\s*\.\s*(?:[\w-]+|"[^"]*"|'[^']*'))*)\s*=\s*""")
_PART = re.compile(r"""[\w-]+|"[^"]*"|'[^']*'""")
_BLANK = re.compile(r"(?:[\s,]|#[^\n]*)*")
_STRING = re.compile(
    r'"""(?:[^\\]|\\.)*?"{3,5}'  # text over several lines, with escapes
    r"|'{3}.*?'{3,5}"
    r'|"(?:[^"\\]|\\.)*"'
    r"|'[^']*'",
    re.DOTALL,
)
_SCALAR = re.compile(r"[^,\]}\n#]*")


class Locator:
    """Line of every key and array element of a valid TOML text, by its path in the parsed document."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._starts = [0, *(m.end() for m in re.finditer("\n", text))]
        self.lines: dict[KeyPath, int] = {(): 1}
        self._scan()

    def _scan(self) -> None:
        text = self._text
        at = 0
        table: KeyPath = ()
        elements: dict[KeyPath, int] = {}  # array of tables -> index of the element being written
        while (at := self._skip(at)) < len(text):
            if header := _HEADER.match(text, at):
                table = ()
                parts = self._parts(header[2])
                for depth, part in enumerate(parts, start=1):
                    table = (*table, part)
                    self._note(table, at)
                    if header[1] == "[[" and depth == len(parts):
                        elements[table] = elements.get(table, -1) + 1
                    if table in elements:
                        table = (*table, elements[table])
                        self._note(table, at)
                at = text.find("\n", header.end()) % (len(text) + 1)
            else:
                at = self._pair(at, table)

    def _pair(self, at: int, table: KeyPath) -> int:
        key = _KEY.match(self._text, at)
        if key is None:  # the text has been parsed before, so this can not happen; lines are then coarser
            return len(self._text)
        path = table
        for part in self._parts(key[1]):
            path = (*path, part)
            self._note(path, at)
        return self._value(key.end(), path)

    def _value(self, at: int, path: KeyPath) -> int:
        text = self._text
        if string := _STRING.match(text, at):
            return string.end()
        if text[at] == "[":
            index = 0
            at = self._skip(at + 1)
            while text[at] != "]":
                self._note((*path, index), at)
                at = self._skip(self._value(at, (*path, index)))
                index += 1
            return at + 1
        if text[at] == "{":
            at = self._skip(at + 1)
            while text[at] != "}":
                at = self._skip(self._pair(at, path))
            return at + 1
        scalar = _SCALAR.match(text, at)
        return scalar.end() if scalar else at

    def _skip(self, at: int) -> int:
        blank = _BLANK.match(self._text, at)
        return blank.end() if blank else at

    def _note(self, path: KeyPath, at: int) -> None:
        self.lines.setdefault(path, bisect_right(self._starts, at))

    @staticmethod
    def _parts(dotted: str) -> list[str]:
        return [part.strip("\"'") for part in _PART.findall(dotted)]


def _longest_key(line: str) -> int:
    """Return how many parts the longest dotted key of a line may have; numbers are separated by commas."""
    if line.count(".") <= MOST_DEPTH:
        return 0
    longest = run = 0
    for part in line.split("."):
        run = run + 1 if part.strip() and "," not in part else 0
        longest = max(longest, run)
    return longest


class Document:
    """A parsed file and the place every value was written."""

    error: type[DocumentError] = DocumentError

    def __init__(self, path: Path) -> None:
        self.path = path
        with reading(path, "must be a file of TOML", self.error):
            text = self._text()
            self.data = self._parsed(text)
            self._places: dict[KeyPath, tuple[Path, int]] = {
                key: (path, line) for key, line in Locator(text).lines.items()
            }

    def _text(self) -> str:
        content = read_bytes(self.path, _MOST_BYTES)
        try:
            return content.decode("utf-8").replace("\r\n", "\n").replace("\r", "\n")
        except UnicodeDecodeError as error:
            line = content.count(b"\n", 0, error.start) + 1
            reason = f"must be UTF-8 text, got byte {content[error.start]:#x}"
            raise self.error.at(self.path, line, reason) from error

    def _parsed(self, text: str) -> dict[str, Any]:
        for i, line in enumerate(text.split("\n"), 1):
            if _longest_key(line) > MOST_DEPTH:  # its parts, squared, are the parser's time
                raise self.error.at(self.path, i, f"a key must have at most {MOST_DEPTH} parts, got more")
        try:
            data = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            found = re.search(r"\(at line (\d+)", str(error))
            at = int(found[1]) if found else None
            raise self.error.at(self.path, at, f"not valid TOML: {error}") from error
        if depth(data) > MOST_DEPTH:
            raise self.error.at(self.path, None, f"must not be nested deeper than {MOST_DEPTH} levels")
        return data

    def place(self, key: KeyPath) -> str:
        """Return "file:line" of a key, or of the innermost block around it that the file has."""
        path, line = self._written(key)
        return f"{path}:{line}"

    def _written(self, key: KeyPath) -> tuple[Path, int]:
        while key and key not in self._places:
            key = key[:-1]
        return self._places[key]

    def fault(self, key: KeyPath, reason: str) -> DocumentError:
        """Return the error of one key of the file."""
        return self.error.at(*self._written(key), reason)

    @contextmanager
    def placed(self, key: KeyPath) -> Iterator[None]:
        """Say where a block stands if what is made of it can not be."""
        try:
            yield
        except FileFormatError as error:
            if error.path is None or error.path == self.path:
                raise
            raise self.fault(key, str(error)) from error
        except (ValueError, TypeError, OverflowError) as error:
            raise self.fault(key, str(error)) from error

    def written_key(self, key: KeyPath) -> KeyPath:
        """Return where a key of the checked data stands in the file."""
        return key

    def validate(self, model: type[Model], data: Any, at: KeyPath = ()) -> Model:
        """Return the checked data of the block at a key, or fail with everything that is wrong with them."""
        try:
            return model.model_validate(data)
        except ValidationError as error:
            # A misspelt key is an unknown one and a missing one: the unknown one says more.
            problems = sorted(error.errors(include_url=False), key=lambda e: e["type"] == "missing")
            messages = "\n".join(self._message(problem, at) for problem in problems)
            path, line = self._written(self._key(problems[0], at))
            raise self.error(messages, path=path, line=line) from error

    def _message(self, error: ErrorDetails, at: KeyPath) -> str:
        context = error.get("ctx", {})
        if error["type"] == "document":
            text = context["message"]
        elif error["type"] == "missing":
            text = "required key is missing"
        elif error["type"] == "extra_forbidden":
            text = f"unknown key, got {received(error['input'])}"
        elif error["type"] == "value_error":
            text = str(context["error"])
        else:
            text = f"{error['msg'].replace('Input should', 'must')}, got {received(error['input'])}"
        key = self._key(error, at)
        dotted = ".".join(str(part) for part in key)
        return f"{self.place(key)}: {dotted}: {text}"

    def _key(self, error: ErrorDetails, at: KeyPath) -> KeyPath:
        """Return the key of the file that an error is about."""
        key = self.written_key((*at, *error["loc"]))
        if error["type"] != "document":
            return key
        parts = error["ctx"]["key"].split(".")
        return (*key, *(int(part) if part.isdigit() else part for part in parts if part))


def frozen(value: Any) -> Any:
    """Turn lists into tuples, all the way down."""
    if isinstance(value, list):
        return tuple(frozen(item) for item in value)
    if isinstance(value, dict):
        return {key: frozen(item) for key, item in value.items()}
    return value
