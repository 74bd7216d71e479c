"""Finished runs on disk: an SQLite file that survives an interruption at any moment.

Table ``study``: key, value (format, fingerprint, package version, units as JSON). Table ``runs``: one row for
each finished run. Its columns are number, parameters, metrics (NULL: the run does not have it),
``end_reason``, ``outcome``, ``state_hash``, ``error``, and a checksum of all of it. Any SQLite tool reads it:
``sqlite3 study.db 'select * from runs'``.
"""

from __future__ import annotations

import json
import math
import sqlite3
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ..base.fingerprint import fingerprint
from ..io.file_format import FileFormatError, reading, received

__all__ = ["Outcome", "RunStore", "StoreError"]

_FORMAT = "birm3d runs 3"
_MUST = "store must be a file of runs or a new one"
_TEXTS = ("inputs", "end_reason", "outcome", "state_hash", "error", "checksum")


class Outcome(NamedTuple):
    """What a run gave. ``metrics`` are in the order asked for; NaN where the run does not have one."""

    metrics: tuple[float, ...]
    end_reason: str = ""
    outcome: str = ""
    state_hash: str = ""
    error: str = ""


class StoreError(Exception):
    """Finished runs can not be written; the cause says why."""


class RunStore:
    """Outcomes of one study, keyed by the number of the run.

    Every :meth:`add` is one transaction: after a crash or a kill the file holds whole additions only.

    Parameters
    ----------
    path
        File to open or to make.
    study
        Fingerprint of what all runs share (scene, names of parameters and metrics, package version).
    names, rows
        Parameters of the study and their values, one row a run.
    units
        Metric -> unit.

    Raises
    ------
    ValueError
        If the file holds another study or other values, can not be written, or is in use by another process.
    FileFormatError
        If it is no store, or is damaged.
    """

    def __init__(
        self,
        path: str | Path,
        *,
        study: str,
        version: str,
        names: Sequence[str],
        rows: Sequence[Sequence[Any]],
        units: Mapping[str, str],
    ) -> None:
        self.path = Path(path)
        self.lost: set[int] = set()  # runs that could not be written
        self._rows = rows
        self._metrics = tuple(units)
        columns = (
            "run INTEGER PRIMARY KEY",
            *(_quoted(name) for name in names),
            *(f"{_quoted(name)} REAL" for name in units),
            *(f"{text} TEXT" for text in _TEXTS),
        )
        self._insert = f"INSERT OR REPLACE INTO runs VALUES ({', '.join('?' * len(columns))})"
        facts = {"format": _FORMAT, "study": study, "version": version, "units": json.dumps(dict(units))}
        if not self.path.parent.is_dir():
            raise ValueError(f"store must be in a folder that exists, got {str(self.path)!r}")
        try:
            self._connection = sqlite3.connect(self.path, timeout=1.0)
        except sqlite3.Error as error:
            raise ValueError(f"store {str(path)!r} can not be opened: {error}") from error
        try:
            with reading(self.path, _MUST):
                self._open(facts, columns)
        except FileFormatError as error:
            self.close()
            if isinstance(error.__cause__, sqlite3.OperationalError):
                cause = error.__cause__
                raise ValueError(f"store {str(path)!r} can not be opened or is in use: {cause}") from cause
            raise
        except BaseException:
            self.close()
            raise

    def _open(self, facts: Mapping[str, str], columns: Sequence[str]) -> None:
        """Make the tables of a new file, or see whether those of an old one are of this study."""
        # One writer at a time; the lock ends with the process, however that ends.
        self._connection.execute("PRAGMA locking_mode = EXCLUSIVE")
        with self._connection:
            self._connection.execute("BEGIN IMMEDIATE")
            tables = {name for (name,) in self._connection.execute("SELECT name FROM sqlite_master")}
            if not tables:
                self._connection.execute("CREATE TABLE study (key TEXT PRIMARY KEY, value TEXT)")
                self._connection.executemany("INSERT INTO study VALUES (?, ?)", facts.items())
                self._connection.execute(f"CREATE TABLE runs ({', '.join(columns)})")
            elif not tables >= {"study", "runs"}:
                raise ValueError(f"store must be a file of runs or a new one, got a database of {tables}")
        self._refuse_another(dict(self._connection.execute("SELECT key, value FROM study")), facts["study"])

    def _refuse_another(self, found: Mapping[str, Any], study: str) -> None:
        if found.get("format") != _FORMAT:
            raise FileFormatError.at(
                self.path,
                None,
                f"store must have format {_FORMAT!r}, got {received(found.get('format'))}; give another file",
            )
        if found.get("study") != study:
            raise ValueError(
                f"store {str(self.path)!r} holds another study: scene, parameters, metrics or package "
                f"version differ (fingerprint {found.get('study')}, made by birm3d {found.get('version')}; "
                f"this study has {study})"
            )
        for run, inputs in self._connection.execute("SELECT run, inputs FROM runs ORDER BY run"):
            if run < len(self._rows) and inputs != fingerprint(self._rows[run]):
                raise ValueError(
                    f"store {str(self.path)!r} holds another study: run {run} has other parameter values "
                    f"than this study's {tuple(self._rows[run])}"
                )

    def finished(self) -> dict[int, Outcome]:
        """Return the outcomes so far, number of the run -> outcome; only runs that the study has.

        Raises
        ------
        FileFormatError
            If the file is damaged, or a row was changed after it was written.
        """
        outcomes: dict[int, Outcome] = {}
        with reading(self.path, _MUST):
            lines = self._connection.execute(
                "SELECT * FROM runs WHERE run < ? ORDER BY run", (len(self._rows),)
            )
            for run, *rest in lines:
                *values, end_reason, outcome, state_hash, error, found = rest
                if found != fingerprint(run, values, end_reason, outcome, state_hash, error):
                    reason = f"run {run} must have the checksum of its values: it was changed"
                    raise FileFormatError.at(self.path, None, reason)
                metrics = values[len(values) - 1 - len(self._metrics) : -1]  # then come the inputs
                numbers = tuple(math.nan if value is None else value for value in metrics)
                outcomes[run] = Outcome(numbers, end_reason, outcome, state_hash, error)
        return outcomes

    def add(self, outcomes: Mapping[int, Outcome]) -> None:
        """Write finished runs, all or none of them; none any more once that has failed.

        Raises
        ------
        StoreError
            If they can not be written: the disk is full or gone, or the file read-only.
        """
        if self.lost:
            self.lost.update(outcomes)
            return
        lines = [self._line(run, outcome) for run, outcome in sorted(outcomes.items())]
        try:
            with self._connection:
                self._connection.executemany(self._insert, lines)
        except sqlite3.Error as error:
            self.lost.update(outcomes)
            raise StoreError from error

    def _line(self, run: int, outcome: Outcome) -> tuple[Any, ...]:
        row = self._rows[run]
        metrics = [None if math.isnan(value) else float(value) for value in outcome.metrics]
        values = [*(_cell(value) for value in row), *metrics, fingerprint(row)]
        return (run, *values, *outcome[1:], fingerprint(run, values, *outcome[1:]))

    def close(self) -> None:
        """Close the file."""
        self._connection.close()


def _cell(value: Any) -> Any:
    if isinstance(value, bool):
        return int(value)  # as it is read back
    return value if value is None or isinstance(value, (int, float, str)) else str(value)


def _quoted(name: str) -> str:
    return '"' + name.replace('"', '""') + '"'
