"""Whether a record's time zero is the impact: nothing changes the velocity before it."""

from __future__ import annotations

import numpy as np

from ..signals.channel import Channel
from ..signals.channel_checks import onset_of

__all__ = ["require_rest_before"]

# Greatest change of velocity before time zero [m/s]: 2.5 % of the greatest OIV that MASH allows. A pulse of
# 10 g reaches it in 3 ms, and films show the first contact no more exactly. Noise of 0.05 g over 0.1 s is a
# sixth of it.
_LIMIT = 0.3
# An onset is blurred by this: it is found in means over 1 ms [s].
_BLUR = 1e-3


def require_rest_before(name: str, channel: Channel, time_zero: float) -> None:
    """Refuse an acceleration that changes the velocity before time zero: occupants would fly before it.

    Parameters
    ----------
    name
        Of the argument, for the message.
    channel
        Must hold `time_zero` [s].

    Raises
    ------
    ValueError
        Naming the channel, where its pulse begins, the change of velocity before time zero and its limit.
    """
    gained = channel.integrated(at=time_zero).values[channel.time < time_zero]
    change = -float(gained[np.abs(gained).argmax()]) if len(gained) else 0.0
    if abs(change) <= _LIMIT:
        return
    begins = onset_of(channel.to_si().shifted(time_zero)) + time_zero
    if begins < time_zero - _BLUR:
        what = (
            f"Shift the time axis so that zero is the first contact (time_zero={begins:.4g}, or "
            "Channel.shifted). Or the sensor has an offset (Channel.without_bias)"
        )
    else:
        what = (
            "So the sensor most likely has an offset (Channel.without_bias), or brake or tow act before the "
            "contact (Channel.between leaves those rows out)"
        )
    raise ValueError(
        f"{name} must not change the velocity by more than {_LIMIT} m/s before time zero, the first contact "
        f"({time_zero:g} s); got {channel.name!r} with {change:+.2f} m/s before it, whose pulse begins at "
        f"{begins:.4g} s. {what}"
    )
