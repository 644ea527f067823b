"""Which stretch of a record to look at."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle.simulation.recording import Recording

Vector = npt.NDArray[np.float64]


def liveliest(time: Vector, values: Vector, length: float) -> float:
    """Start [s] of the stretch of a given length with the largest mean square of a channel.

    Args:
        time: uniform sample times [s], (n,).
        values: channel, (n,).
        length: of the stretch [s]; the whole record where it is shorter.

    Returns:
        First time of the stretch [s].
    """
    count = min(round(length / (time[1] - time[0])) + 1, len(time))
    sums = np.concatenate([[0.0], np.cumsum(values**2)])
    return float(time[np.argmax(sums[count:] - sums[:-count])])


def excerpt_start(recording: Recording, wheel: str, slip_velocity: float, length: float) -> tuple[float, str]:
    """Choose a stretch: where the damper of a wheel works most; where it never slips, where the knuckle shakes most.

    Args:
        recording: the run.
        wheel: the excited wheel.
        slip_velocity: [m/s].
        length: of the stretch [s].

    Returns:
        First time [s], and why.
    """
    velocity = recording[f"damper_{wheel}_velocity"]
    if np.any(np.abs(velocity) > slip_velocity):
        return liveliest(recording.time, velocity, length), "most damper motion"
    return liveliest(recording.time, recording[f"knuckle_{wheel}_acc_z"], length), "liveliest knuckle; no slip"
