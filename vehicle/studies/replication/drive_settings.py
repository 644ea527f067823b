"""Settings of the replication of a drive, each declared once: for Python, its documentation and the command `drive`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from vehicle.names import CORNERS
from vehicle.settings import Settings, engine_setting, pair, setting

if TYPE_CHECKING:
    from vehicle.signals.records.choice import Choice
    from vehicle.studies.replication.iteration import Step


@dataclass(frozen=True, kw_only=True, slots=True)
class DriveSettings(Settings):
    """Settings of the replication of a drive."""

    choice: Choice | None = setting("units, rate and excerpt of the file")
    delay: Mapping[str, float] | None = setting(
        "delays that are taken out of the file, as {'seat_*': 0.0123}: channel, pattern or group to seconds"
    )
    wheels: Sequence[str] | None = setting(
        "wheels whose plates are driven, as ('fr',); by default the wheels in the names of the channels, else the "
        "shaker wheel of the vehicle file",
        flag="--wheel",
        action="append",
        choices=sorted(CORNERS),
        help="wheel whose plate is driven; by default the wheels in the names of the channels, else the shaker wheel "
        "of the vehicle file; may be repeated",
    )
    band: tuple[float, float] = setting(
        "frequency range of the replication [Hz]; %(default)s by default; begin where the target exceeds the noise of "
        "its sensor",
        (1.0, 50.0),
        type=pair("--band", "two frequencies [Hz], the lower first, as 1:50", above=0.0),
        metavar="A:B",
    )
    iterations: int = setting(
        "maximum number of runs; %(default)s by default", 15, within="[1, 1000]", type=int, metavar="N"
    )
    gain: float = setting(
        "iteration gain: applied part of the correction [-], above 0 and up to 1; %(default)s by default",
        0.8,
        within="(0, 1]",
        type=float,
        metavar="G",
    )
    target_error: float = setting(
        "stop if the RMS error in the band is below this part of the RMS of the target [-]; %(default)s by default",
        1e-3,
        within="(0, 100)",
        factor=0.01,
        type=float,
        metavar="PERCENT",
        help="stop if the RMS error in the band is below this part of the RMS of the target [%%]; %(default)s",
    )
    engine: str = engine_setting("auto")
    progress: Callable[[Step], None] | None = setting("called with each step of the iteration")
