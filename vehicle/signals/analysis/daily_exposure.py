"""Daily exposure A(8) of a hand or a body to vibration, with action value and limit value."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.evaluation import AXES, HEALTH

EXPOSURE_VALUES = {"hand": (2.5, 5.0), "seat": (0.5, 1.15), "standing": (0.5, 1.15)}
"""Point of contact to action value and limit value of A(8) [m/s2] (Directive 2002/44/EC, article 3)."""


def daily_exposure(acceleration: float, hours: float) -> float:
    """Return the daily exposure A(8) = a sqrt(T / 8 h) [m/s2].

    Args:
        acceleration: of a hand the vector sum of its weighted RMS values; of a body the largest of 1.4 a_x, 1.4 a_y and
            a_z [m/s2].
        hours: duration T of the exposure in a day [h].

    Raises:
        ConfigurationError: a duration outside 0 to 24 h.

    Source: ISO 5349-1:2001, 5.3; Directive 2002/44/EC, annex.
    """
    if not 0.0 < hours <= 24.0:
        raise ConfigurationError(f"exposure: found {hours:g} h in a day; must be above 0 and at most 24")
    return float(acceleration * np.sqrt(hours / 8.0))


def exposure(values: Mapping[str, Any], hours: float) -> dict[str, Any]:
    """Return the daily exposure A(8) to the vibration of a record, with action value and limit value.

    For a hand from the vector sum, for a body from the largest of 1.4 a_x, 1.4 a_y and a_z.

    Args:
        values: values of a record, see `evaluate`.
        hours: daily duration of this vibration [h].

    Returns:
        {"hours", "a8", "axis", "action_value", "limit_value"}, accelerations in m/s2; the axis is "all" for a hand.

    Raises:
        ConfigurationError: a duration out of range, or a point of contact without exposure values.
        DataError: an axis is missing.

    Source: Directive 2002/44/EC; ISO 5349-1:2001; ISO 2631-1:1997, 7.2.
    """
    contact = values["place"]
    if contact not in EXPOSURE_VALUES:
        raise ConfigurationError(
            f"exposure: the directive has no action value for {contact}; the point of contact must be "
            f"{', '.join(EXPOSURE_VALUES)}"
        )
    missing = [axis for axis in AXES if values[axis] is None]
    if missing:
        raise DataError(f"exposure: A(8) needs x, y and z; {' and '.join(missing)} missing")
    if contact == "hand":
        axis, acceleration = "all", values["vector_sum"]["weighted_rms"]
    else:
        weighted = {name: factor * values[name]["weighted_rms"] for name, factor in zip(AXES, HEALTH, strict=True)}
        axis, acceleration = max(weighted.items(), key=lambda item: item[1])
    action, limit = EXPOSURE_VALUES[contact]
    a8 = daily_exposure(acceleration, hours)
    return {"hours": hours, "a8": a8, "axis": axis, "action_value": action, "limit_value": limit}
