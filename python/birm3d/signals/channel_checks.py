"""Whether sign, unit, time zero, bias and sampling of a record look right, said aloud.

Nothing is mended here: a finding names the method of :class:`birm3d.Channel` that would.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from ..base.arguments import checked
from .samples import Samples

__all__ = ["Finding", "Findings", "check_channel", "onset_of"]

Floats = npt.NDArray[np.float64]
Severity = Literal["error", "warning", "note"]

# Change of velocity over the impact speed: from a little less than 1 (a vehicle that hardly stops, a cell
# that reads low) to a strong rebound.
_PLAUSIBLE = (0.8, 1.6)
_TYPICAL = 1.15
# Units that get mixed up, by what the numbers are then too large, and how close to that they must be.
_MIX_UPS = {
    "acceleration": {9.80665: "m/s^2 taken for g", 1.0 / 9.80665: "g taken for m/s^2"},
    "force": {1e3: "N taken for kN", 1e-3: "kN taken for N", 4.448: "N taken for lbf", 0.2248: "lbf for N"},
    "speed": {3.6: "km/h taken for m/s", 2.237: "mph taken for m/s", 1.0 / 3.6: "m/s taken for km/h"},
}
_CLOSE = 1.4
# Impact speed that a record of speed shows at time zero, and a bias over the peak: what is worth a word.
_SPEED, _BIAS = 0.05, 0.005
# The record has risen where its mean over 1 ms passes this share of its peak, and twice its first 5 ms.
_ONSET, _ONSET_WINDOW, _NOISE, _REST = 0.02, 1e-3, 2.0, 5e-3
_FEWEST_BEFORE = 10


@dataclass(frozen=True)
class Finding:
    """One thing that was looked at."""

    severity: Severity
    about: str
    message: str

    def __str__(self) -> str:
        return f"{self.severity}: {self.about}: {self.message}"


class Findings(tuple[Finding, ...]):
    """All findings of a channel; printed, one a line."""

    __slots__ = ()

    @property
    def errors(self) -> Findings:
        """Those that make the record useless as it is."""
        return Findings(finding for finding in self if finding.severity == "error")

    @property
    def warnings(self) -> Findings:
        """Those to look into."""
        return Findings(finding for finding in self if finding.severity == "warning")

    @property
    def ok(self) -> bool:
        """Whether there is neither error nor warning."""
        return not self.errors and not self.warnings

    def __str__(self) -> str:
        return "\n".join(map(str, self))


@checked
def check_channel(
    channel: Samples,
    *,
    impact_speed: float | None = None,
    mass: float | None = None,
    cfc: float | None = None,
    onset_within: float = 5e-3,
) -> Findings:
    """Look at the sign, unit, time zero, bias and sampling of a record of an impact against a barrier.

    Signs are expected as BIRM3D has them: a velocity towards the barrier is positive, so an acceleration
    along it is negative on the whole; a force of the barrier is positive.

    Parameters
    ----------
    channel
        Of acceleration, force or speed for all checks; of other quantities sampling only.
    impact_speed
        Along the channel [m/s]; needed to judge sign and unit.
    mass
        Of the vehicle [kg]; needed for a force.
    cfc
        Channel frequency class that the record is wanted in; None: its own.
    onset_within
        How far from time zero a record may rise [s].

    Returns
    -------
    Findings
        Errors (sign, unit), warnings (time zero, bias, sampling) and notes; ``print`` shows them.

    Raises
    ------
    ValueError
        If `impact_speed`, `mass` or `onset_within` is not finite and > 0.
    """
    for name, value in (("impact_speed", impact_speed), ("mass", mass), ("onset_within", onset_within)):
        if value is not None and not (np.isfinite(value) and value > 0.0):
            raise ValueError(f"{name} must be finite and > 0, got {value}")
    si = channel.to_si()
    found = [_sampling(si, channel.cfc if cfc is None else cfc)]
    if channel.quantity in ("acceleration", "force"):
        onset = onset_of(si)
        found += [_time_zero(si, onset, onset_within), _bias(si, min(0.0, onset))]
    if channel.quantity in ("acceleration", "force", "speed"):
        start = onset_of(si) if channel.quantity != "speed" else 0.0
        found.append(_sign_and_unit(si, start, channel.unit, impact_speed, mass))
    return Findings(found)


def _sampling(channel: Samples, cfc: float | None) -> Finding:
    if not channel.is_even:
        steps = np.diff(channel.time)
        return Finding(
            "warning", "sampling",
            f"rows are {steps.min():g} to {steps.max():g} s apart; filters need them even, see resampled()",
        )  # fmt: skip
    interval = channel.interval
    if cfc is not None and interval * cfc > 0.1:
        return Finding(
            "warning", "sampling",
            f"rows every {interval:g} s are too far apart for CFC {cfc:g}, which asks for {0.1 / cfc:g} s",
        )  # fmt: skip
    return Finding("note", "sampling", f"rows every {interval:g} s, from {channel.time[0]:g} s")


def onset_of(channel: Samples) -> float:
    """Return the instant at which a record rises [s]."""
    time, values = channel.time, channel.values
    rows = max(1, round(_ONSET_WINDOW / float(np.median(np.diff(time)))))
    smooth = np.convolve(values, np.full(rows, 1.0 / rows), "same")
    # A record that starts before time zero is taken to start at rest; one that does not has no rest to see.
    rest = (time < min(0.0, time[0] + _REST)) & (np.arange(len(time)) >= rows // 2)
    level = float(np.median(smooth[rest])) if rest.any() else 0.0
    away = np.abs(smooth - level)
    noise = float(away[rest].max()) if rest.any() else 0.0
    limit = max(_ONSET * away.max(), min(_NOISE * noise, 0.5 * away.max()))
    return float(time[np.argmax(away >= limit)])


def _time_zero(channel: Samples, onset: float, within: float) -> Finding:
    if not channel.time[0] <= 0.0 < channel.time[-1]:
        return Finding(
            "warning", "time zero",
            f"the record, {channel.time[0]:g} to {channel.time[-1]:g} s, has none in it; see shifted()",
        )  # fmt: skip
    if abs(onset) > within:
        return Finding(
            "warning", "time zero",
            f"the record rises at {1e3 * onset:.1f} ms; shifted({onset:g}) makes that time zero",
        )  # fmt: skip
    return Finding("note", "time zero", f"the record rises at {1e3 * onset:.1f} ms")


def _bias(channel: Samples, before: float) -> Finding:
    rows = channel.values[channel.time < before]
    if len(rows) < _FEWEST_BEFORE:
        return Finding("note", "bias", "not checked: the record has too few rows before the impact")
    share = float(rows.mean() / np.abs(channel.values).max()) if channel.values.any() else 0.0
    text = f"mean before the impact {rows.mean():.3g} {channel.unit}, {100.0 * share:+.2f} % of the peak"
    if abs(share) > _BIAS:
        return Finding("warning", "bias", f"{text}; see without_bias()")
    return Finding("note", "bias", text)


def _sign_and_unit(
    channel: Samples, start: float, unit: str, speed: float | None, mass: float | None
) -> Finding:
    quantity = channel.quantity
    if speed is None or (quantity == "force" and mass is None):
        needed = "impact_speed and mass" if quantity == "force" else "impact_speed"
        return Finding("note", "sign and unit", f"not checked: that needs {needed}")
    if quantity == "speed":
        first = float(np.interp(start, channel.time, channel.values))
        ratio, low, high, typical = first / speed, 1.0 - _SPEED, 1.0 + _SPEED, 1.0
        text = f"{first:.4g} m/s at time zero, where the impact speed is {speed:.4g} m/s"
    else:
        area = channel.integrated(at=start).values
        most = float(area[np.abs(area).argmax()])
        low, high = _PLAUSIBLE
        typical = _TYPICAL
        if quantity == "acceleration":
            ratio = -most / speed
            text = f"it changes the velocity by {most:.4g} m/s, from an impact speed of {speed:.4g} m/s"
        else:
            assert mass is not None
            ratio = most / (mass * speed)
            text = f"its impulse is {most:.4g} N s, where mass times impact speed is {mass * speed:.4g} N s"
    if low <= ratio <= high:
        return Finding("note", "sign and unit", text)
    if low <= -ratio <= high:
        return Finding("error", "sign", f"{text}; the sign is the other one, see flipped()")
    for factor, mix_up in _MIX_UPS[quantity].items():
        if 1.0 / _CLOSE < abs(ratio) / (typical * factor) < _CLOSE:
            sign = ", and the sign is the other one" if ratio < 0.0 else ""
            return Finding("error", "unit", f"{text}; this looks like {mix_up} (unit here {unit}){sign}")
    return Finding("error", "sign and unit", f"{text}; that does not fit (unit {unit})")
