"""A run that was kept, run again and compared bit for bit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..base.frozen_mapping import FrozenMapping
from ..io.file_format import reads
from ..io.made_with import code_to_install, facts_text, platform_facts
from ..result import capsule
from ..result.result import Result, load

__all__ = ["Rerun", "rerun"]

_WALL_TIME = ("run_time",)  # differs between any two runs


@dataclass(frozen=True, eq=False)
class Rerun:
    """A run that was kept beside the same run of today; made by :func:`birm3d.rerun`.

    Attributes
    ----------
    result : Result
        Of today.
    expected_hash, found_hash : int
        State at the end, then and today.
    made_with : mapping of str to str
        Versions, source and platform that wrote the file, as far as it says.
    made_here : mapping of str to str
        The same of this process.
    differences : mapping of str to (float or None, float or None)
        Metric -> value then and today, of those that differ; ``None``: there is none. Without wall times.
    """

    result: Result
    expected_hash: int
    found_hash: int
    made_with: Mapping[str, str]
    made_here: Mapping[str, str]
    differences: Mapping[str, tuple[float | None, float | None]]

    @property
    def same(self) -> bool:
        """Whether both runs end in the same bits."""
        return self.expected_hash == self.found_hash

    def summary(self) -> str:
        """Return both hashes, who made them, and the metrics that differ, as text."""
        word = "the same bits" if self.same else "OTHER BITS"
        lines = [
            f"{word}: state {self.expected_hash:016x} then, {self.found_hash:016x} now",
            f"  written by  {facts_text(self.made_with)}",
            f"  run now by  {facts_text(self.made_here)}",
        ]
        if not self.same:
            lines.append(f"  {self._why}")
        if self.same and self.differences:
            lines.append("  from the same bits this version computes some metrics in another way:")
        elif self.differences:
            lines.append(f"  {len(self.differences)} metrics differ:")
        elif not self.same:
            lines.append("  all metrics are equal")
        lines += [f"    {name}: {_difference(*values)}" for name, values in self.differences.items()]
        return "\n".join(lines)

    @property
    def _why(self) -> str:
        """What may give the same bits."""
        then, now = (facts.get("source") for facts in (self.made_with, self.made_here))
        if then is not None and then == now:
            return "the source is the same: compare compiler, C library, NumPy, Python and machine"
        return f"for the same bits install what wrote it: {code_to_install(self.made_with)}"

    __str__ = summary

    def to_dict(self) -> dict[str, Any]:
        """Return all of it as plain values."""
        return {
            "same": self.same,
            "expected_hash": f"{self.expected_hash:016x}",
            "found_hash": f"{self.found_hash:016x}",
            "made_with": dict(self.made_with),
            "made_here": dict(self.made_here),
            "differences": {
                name: {"then": then, "now": now} for name, (then, now) in self.differences.items()
            },
        }

    def __repr__(self) -> str:
        return f"Rerun(same={self.same}, expected_hash={self.expected_hash:#018x})"


@reads("must be a capsule, or a file of Result.save()")
def rerun(path: str | Path) -> Rerun:
    """Run a capsule, or a saved result, once more and compare it bit for bit.

    Raises
    ------
    FileFormatError
        If the file can not be read, is damaged or was changed, or a newer version made it.
    """
    path = Path(path)
    then = load(path)
    made_with = then.made_with
    with path.open("rb") as stream:
        if capsule.is_capsule(stream):
            made_with = capsule.read(stream, path).manifest["made_with"]
    core = capsule.run_again(then.scene, capsule.steps_of(then))
    now = Result._of(then.scene, core, 0.0)
    return Rerun(
        result=now,
        expected_hash=then.state_hash,
        found_hash=now.state_hash,
        made_with=FrozenMapping(made_with),
        made_here=FrozenMapping(platform_facts()),
        differences=FrozenMapping(_differences(then, now)),
    )


def _differences(then: Result, now: Result) -> dict[str, tuple[float | None, float | None]]:
    before: Mapping[str, float] = then.saved_metrics or {}
    today: Mapping[str, float] = now.metrics if len(now.time) > 1 else {}
    names = [name for name in {**before, **today} if name not in _WALL_TIME]
    pairs = {name: (before.get(name), today.get(name)) for name in names}
    return {name: pair for name, pair in pairs.items() if pair[0] != pair[1]}


def _difference(then: float | None, now: float | None) -> str:
    text = ", ".join(f"{_value(value)} {when}" for value, when in ((then, "then"), (now, "now")))
    if then is None or now is None:
        return text
    return f"{text} ({now / then - 1.0:+.2e})" if then != 0.0 else f"{text} ({now - then:+.2e})"


def _value(value: float | None) -> str:
    return "none" if value is None else f"{value:.10g}"
