"""Choice of the excerpt of a film: where the car moves most or around an event, as slow as the eye needs.

A film shows 30 frames per second, in which the eye follows a motion of up to about 7.5 Hz (4 frames per period). The
motion is that of the part that carries the wheel: its kinetic energy over the frequency is the power of its vertical
acceleration divided by w^2.
"""

from dataclasses import dataclass

import numpy as np

from vehicle.drawing.rendering.recorded_run import event_of, liveliest, wheels_of
from vehicle.engines.simulation.recording import Recording

FPS = 30.0
"""Frames per second of every film [Hz]."""

USUAL_LENGTH = 10.0
"""Default length of a film [s]; that of an event is shorter."""

FAST_MOTION, FRAMES_PER_PERIOD = 15.0, 4.0
"""Frequency [Hz] with half of the kinetic energy above which a film is in slow motion by default, and frames in a
period of the frequency with 90 % of the energy below; at 15 Hz a film in real time has 2 frames per period."""

LOWEST_HZ = 0.5
"""Minimum frequency of the kinetic energy [Hz]; the integration of noise would dominate below."""

BEFORE_EVENT, AFTER_EVENT, EVENT_SLOW = 0.3, 1.0, 4.0
"""Times shown before and after an event [s], and its minimum slow motion: a bump of 0.3 s then takes a second."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Excerpt:
    """Excerpt of a record in a film."""

    start: float
    """first time [s]"""
    length: float
    """length in the record [s]"""
    slow: float
    """slow-motion factor"""
    reason: str
    """reason for the start"""


def choose_excerpt(
    recording: Recording,
    wheel: str,
    hub: str,
    slip_velocity: float | None,
    *,
    start: float | None = None,
    duration: float | None = None,
    slow: float | None = None,
) -> Excerpt:
    """Choose start, length and slow motion of a film, as far as they are not given.

    The slow motion depends on the record alone, not on a given start or length. A single event, as a bump or an
    obstacle, is shown from 0.3 s before to 1 s after it. Otherwise the start is that of the window with the largest
    damper motion of the wheel; without slip, with the largest knuckle motion.

    Args:
        recording: recording of the run.
        wheel: the excited wheel.
        hub: acceleration channel of the part that carries the wheel.
        slip_velocity: velocity above which the damper of the wheel slips [m/s]; None without a damper.
        start: first time [s].
        duration: length of the film [s].
        slow: slow-motion factor.

    Returns:
        The excerpt, inside the record.
    """
    record = float(recording.time[-1])
    event = event_of(recording, wheels_of(recording))
    if slow is None:
        slow = max(_slow_motion(recording, hub), 1.0 if event is None else EVENT_SLOW)
    if event is not None and start is None and duration is None:
        first, last = max(event[0] - BEFORE_EVENT, 0.0), min(event[1] + AFTER_EVENT, record)
        if slow * (last - first) <= USUAL_LENGTH:
            return Excerpt(start=first, length=last - first, slow=slow, reason="the event")
    length = (USUAL_LENGTH if duration is None else duration) / slow
    if start is None:
        start, reason = liveliest_window(recording, wheel, hub, slip_velocity, length)
    else:
        reason = "chosen"
    return Excerpt(start=start, length=min(length, record - start), slow=slow, reason=reason)


def liveliest_window(
    recording: Recording, wheel: str, hub: str, slip_velocity: float | None, length: float
) -> tuple[float, str]:
    """Choose the time window with the largest damper motion of a wheel; without slip, with the largest knuckle motion.

    Args:
        recording, wheel, hub, slip_velocity: see `choose_excerpt`.
        length: length of the window [s].

    Returns:
        First time [s], and the reason for the choice.
    """
    velocity = recording.channels.get(f"damper_{wheel}_velocity")
    if velocity is not None and slip_velocity is not None and np.any(np.abs(velocity) > slip_velocity):
        return liveliest(recording.time, velocity, length), "most damper motion"
    return liveliest(recording.time, recording[hub], length), "largest knuckle motion; no slip"


def _slow_motion(recording: Recording, hub: str) -> float:
    """Return the slow-motion factor that shows the motion of the part that carries the wheel; 1 for real time."""
    if not hub.endswith("_acc_z") or hub not in recording.channels:
        return 1.0
    values = recording[hub] - np.mean(recording[hub])
    frequency = np.fft.rfftfreq(values.size, recording.timestep)
    power = np.abs(np.fft.rfft(values * np.hanning(values.size))) ** 2
    inside = frequency >= LOWEST_HZ
    energy = np.cumsum(power[inside] / frequency[inside] ** 2)
    if not energy.size or energy[-1] == 0.0:
        return 1.0
    middle, upper = (float(frequency[inside][np.searchsorted(energy, share * energy[-1])]) for share in (0.5, 0.9))
    return float(np.ceil(upper * FRAMES_PER_PERIOD / FPS)) if middle > FAST_MOTION else 1.0
