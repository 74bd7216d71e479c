"""A rating: what a run would be called by a standard, and by which criteria."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .criteria import Criterion, criteria_html, criteria_text
from .doubts import Doubt

__all__ = ["Rating", "first_reached"]

_NO_BAND = (
    "No band: these are runs of one vehicle. rate(birm3d.predict(simulation), ...) says what others of its "
    "class are rated."
)


@dataclass(frozen=True, eq=False)
class Rating:
    """What a standard would call a run; made by :func:`birm3d.rate`. Always indicative.

    Attributes
    ----------
    standard : str
    verdict : str
        Class or code of a security barrier, as ``"M50-P1"``, ``"K12-L3"``, ``"V/7200[N3C]/80/90:0.8"``;
        ``"pass"``, ``"fail"`` or ``"fail, within the model's error"`` of a roadside barrier, with its
        classes. ``"no rating: ..."`` names the conditions of the standard that are not met.
    penetration : float
        Greatest dynamic distance of the standard's point of the vehicle past the standard's datum of the
        barrier [m]; negative where it stays before it. Of MASH and EN 1317: of any part of the vehicle past
        the undeformed traffic face.
    contained : bool
        Whether the vehicle does not go on past the barrier. By a security standard one that came to rest
        behind it is contained, within the worst class of penetration.
    criteria : tuple of Criterion
        Name, value, limit, verdict of all that was judged or is reported.
    cautions : tuple of str
        Why the run can not be relied on, if so, and what the standard and the model say about a rating that
        was computed.
    vehicle_class : str
        What the standard calls the vehicle.
    test : str
        Test or level of a roadside standard that the run is rated as, as ``"3-11"``; "" of others.
    is_rated : bool
        Whether the conditions of the standard are met: mass, speed, angle.
    is_final : bool
        Whether the penetration can not grow any more.
    is_clear : bool
        False if all that fails are values of occupant risk which the model's error decides on.
    unmet : tuple of str
        Conditions of the standard that are not met; that the vehicle goes on past the barrier is none.
    doubts : tuple of Doubt
        Those of the cautions that say why this run, or its verdict, can not be relied on; a level has none of
        its own.
    outcome : str
        That of the run, see :attr:`birm3d.Result.outcome`; "" of a level, which has several runs.
    """

    standard: str
    verdict: str
    penetration: float
    contained: bool
    criteria: tuple[Criterion, ...]
    cautions: tuple[str, ...]
    vehicle_class: str
    test: str = ""
    is_rated: bool = True
    is_final: bool = True
    is_clear: bool = True
    unmet: tuple[str, ...] = ()
    doubts: tuple[Doubt, ...] = ()
    outcome: str = ""

    @property
    def designation(self) -> str:
        """As the standard writes it: ``"M50-P1"``, ``"MASH 3-11: pass"``."""
        return f"{self.standard} {self.test}: {self.verdict}" if self.test else self.verdict

    @property
    def caution(self) -> str:
        """All cautions as one text."""
        return " ".join(self.cautions)

    @property
    def passed(self) -> bool:
        """Whether no criterion failed and the vehicle was contained."""
        return self.contained and all(one.passed is not False for one in self.criteria)

    def summary(self) -> str:
        """Return designation, criteria and caution as text."""
        return "\n".join([self.title, criteria_text(self.criteria), f"Caution: {self.caution}", _NO_BAND])

    __str__ = summary

    @property
    def title(self) -> str:
        """Standard, designation and vehicle in one line."""
        return f"{self.standard}, indicative: {self.designation} (vehicle {self.vehicle_class})"

    def to_dict(self) -> dict[str, object]:
        """Return all of it as plain values, SI."""
        return {
            "standard": self.standard,
            "designation": self.designation,
            "vehicle_class": self.vehicle_class,
            "penetration": self.penetration,
            "contained": self.contained,
            "passed": self.passed,
            "criteria": [
                {
                    **{name: getattr(one, name) for name in ("name", "value", "unit", "limit", "passed")},
                    "grade": one.grade,
                }
                for one in self.criteria
            ],
            "caution": self.caution,
        }

    def _repr_html_(self) -> str:
        return criteria_html(self.title, self.criteria, f"Caution: {self.caution}\n{_NO_BAND}")

    def __repr__(self) -> str:
        return f"Rating({self.standard!r}, {self.designation!r}, penetration={self.penetration:.3f} m)"


def first_reached(value: float, steps: Sequence[tuple[str, float]]) -> str | None:
    """Return the name of the first step whose greatest value is not exceeded; ``None`` beyond the last."""
    return next((name for name, most in steps if value <= most), None)
