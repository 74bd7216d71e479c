"""Finished runs on disk: an SQLite file that survives an interruption at any moment.

Table ``study``: key, value (format, fingerprint, package version, units as JSON). Table ``runs``: one row a
finished run with its number, its parameters, its metrics (NULL: the run does not have it), ``outcome``,
``end_reason``,
``state_hash``, ``error``. Any SQLite tool reads it: ``sqlite3 study.db 'select * from runs'``.
"""

from __future__ import annotations

import json
import math
import sqlite3
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from .fingerprint import fingerprint

__all__ = ["Outcome", "RunStore"]

_FORMAT = "birm3d runs 2"


class Outcome(NamedTuple):
    """What a run gave. ``metrics`` are in the order asked for; NaN where the run does not have one."""

    metrics: tuple[float, ...]
    end_reason: str = ""
    outcome: str = ""
    state_hash: str = ""
    error: str = ""


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
        If the file is no store, holds another study or other values, or is in use by another process.
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
        self._rows = rows
        self._metrics = tuple(units)
        columns = (
            "run INTEGER PRIMARY KEY",
            *(_quoted(name) for name in names),
            *(f"{_quoted(name)} REAL" for name in units),
            *(f"{text} TEXT" for text in ("inputs", "end_reason", "outcome", "state_hash", "error")),
        )
        self._insert = f"INSERT OR REPLACE INTO runs VALUES ({', '.join('?' * len(columns))})"
        facts = {"format": _FORMAT, "study": study, "version": version, "units": json.dumps(dict(units))}
        if not self.path.parent.is_dir():
            raise ValueError(f"store must be in a folder that exists, got {str(self.path)!r}")
        self._connection = sqlite3.connect(self.path, timeout=1.0)
        try:
            self._open(facts, columns)
        except sqlite3.OperationalError as error:
            self.close()
            raise ValueError(f"store {str(path)!r} can not be opened or is in use: {error}") from error
        except sqlite3.DatabaseError as error:
            self.close()
            raise ValueError(
                f"store must be a file of runs or a new one, got {str(path)!r}: {error}"
            ) from error
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

    def _refuse_another(self, found: Mapping[str, str], study: str) -> None:
        if found.get("format") != _FORMAT:
            raise ValueError(
                f"store must have format {_FORMAT!r}, got {found.get('format')!r} in {self.path}"
            )
        if found["study"] != study:
            raise ValueError(
                f"store {str(self.path)!r} holds another study: scene, parameters, metrics or package "
                f"version differ (fingerprint {found['study']}, made by birm3d {found['version']}; "
                f"this study has {study})"
            )
        for run, inputs in self._connection.execute("SELECT run, inputs FROM runs ORDER BY run"):
            if run < len(self._rows) and inputs != fingerprint(self._rows[run]):
                raise ValueError(
                    f"store {str(self.path)!r} holds another study: run {run} has other parameter values "
                    f"than this study's {tuple(self._rows[run])}"
                )

    def finished(self) -> dict[int, Outcome]:
        """Return the outcomes so far, number of the run -> outcome; only runs that the study has."""
        names = ", ".join(
            _quoted(name) for name in (*self._metrics, "end_reason", "outcome", "state_hash", "error")
        )
        query = f"SELECT run, {names} FROM runs WHERE run < ? ORDER BY run"
        return {
            run: Outcome(tuple(math.nan if value is None else value for value in rest[:-4]), *rest[-4:])
            for run, *rest in self._connection.execute(query, (len(self._rows),))
        }

    def add(self, outcomes: Mapping[int, Outcome]) -> None:
        """Write finished runs, all or none of them."""
        with self._connection:
            self._connection.executemany(
                self._insert, [self._line(run, outcome) for run, outcome in sorted(outcomes.items())]
            )

    def _line(self, run: int, outcome: Outcome) -> tuple[Any, ...]:
        row = self._rows[run]
        metrics = [None if math.isnan(value) else value for value in outcome.metrics]
        return (run, *(_cell(value) for value in row), *metrics, fingerprint(row), *outcome[1:])

    def close(self) -> None:
        """Close the file."""
        self._connection.close()


def _cell(value: Any) -> Any:
    return value if value is None or isinstance(value, (int, float, str)) else str(value)


def _quoted(name: str) -> str:
    return '"' + name.replace('"', '""') + '"'
