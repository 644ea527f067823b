"""Settings of the replication of a drive, each declared once: for Python, its documentation and the command `drive`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from vehicle.names import CORNERS
from vehicle.settings import Settings, engine_setting, pair, setting, stated_errors_setting

if TYPE_CHECKING:
    from vehicle.signals.records.choice import Choice
    from vehicle.studies.replication.iteration import Step


@dataclass(frozen=True, kw_only=True, slots=True)
class DriveSettings(Settings):
    """Settings of the replication of a drive."""

    choice: Choice | None = setting("units, rate and excerpt of the file")
    delay: Mapping[str, float] | None = setting(
        "delays to remove from channels of the file [s], for example {'seat_*': 0.0123}: channel, pattern or group"
    )
    wheels: Sequence[str] | None = setting(
        "wheels whose plates are driven, for example ('fr',); default: the wheels in the names of the channels, "
        "or the shaker wheel of the vehicle file",
        flag="--wheel",
        action="append",
        choices=sorted(CORNERS),
        help="wheel whose plate is driven; default: the wheels in the names of the channels, or the shaker wheel "
        "of the vehicle file. May be repeated",
    )
    band: tuple[float, float] = setting(
        "frequency range of the replication [Hz], from where the target is above the sensor noise; default: "
        "%(default)s",
        (1.0, 50.0),
        type=pair("--band", "two frequencies [Hz], the lower first, for example 1:50", above=0.0),
        metavar="A:B",
    )
    iterations: int = setting(
        "maximum number of runs; default: %(default)s", 15, within="[1, 1000]", type=int, metavar="N"
    )
    gain: float = setting(
        "part of each correction that is applied [-], above 0 and up to 1; default: %(default)s",
        0.8,
        within="(0, 1]",
        type=float,
        metavar="G",
    )
    target_error: float = setting(
        "stop when the RMS error in the band is below this part of the RMS of the target [-]; default: %(default)s",
        1e-3,
        within="(0, 100)",
        factor=0.01,
        type=float,
        metavar="PERCENT",
        help="stop when the RMS error in the band is below this percentage of the RMS of the target [%%]; "
        "default: %(default)s",
    )
    engine: str = engine_setting("auto")
    stated_errors: bool = stated_errors_setting()
    progress: Callable[[Step], None] | None = setting("called with each step of the iteration")
