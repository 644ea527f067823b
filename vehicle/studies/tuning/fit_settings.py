"""Settings of measurements for a fit, each declared once: for Python, its documentation and the options of `tune`."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING

from vehicle.settings import Settings, pair, setting

if TYPE_CHECKING:
    from pathlib import Path

    from vehicle.runs.car.road import Road
    from vehicle.signals.excitation.signal import Signal
    from vehicle.signals.records.choice import Choice
    from vehicle.signals.records.delays import Delay

BAND = (3.0, 45.0)
"""Default band of a fit [Hz]: shaker signals excite the car well above 3 Hz, and the body model ends at 43 Hz."""

SPACING = 0.3
"""Default distance of the fitted frequencies [Hz]: a record of 60 s has 17 lines of 1/60 Hz in this distance, from
which the FRF is estimated."""

CARS = 256
"""Default number of cars of the emulator: a cubic of six parameters has 84 terms."""

DISCREPANCY = 0.1
"""Default standard deviation of ln|H| between model and car [-]: 10 %."""


@dataclass(frozen=True)
class ReadingSettings(Settings):
    """Settings of a measurement file."""

    signal: Signal | Road | Path | str | None = setting(
        "plate displacement of the measurement: a signal, a file, or the name of a shipped file; for time histories "
        "also the road that was driven; by default the plate in the measurement file"
    )
    channels: Mapping[str, str] | None = setting("channel of the model to channel of the file; by default equal names")
    _: KW_ONLY
    choice: Choice | None = setting("units, rate and excerpt of the file")
    inverted: Collection[str] = setting("channels measured with the opposite sign", ())
    fitted: Sequence[str] = setting("channels to be fitted; by default all except plates", ())
    delay: Delay = setting(
        "start of the record after the start of the signal [s], for time histories; or known delays of groups, "
        "channels or patterns, as {'record': 0.2, 'accelerations': 0.0123}; those of the other groups are unknowns of "
        "the fit",
        0.0,
    )


@dataclass(frozen=True, kw_only=True)
class BandSettings(Settings):
    """Settings of FRFs in a band."""

    band: tuple[float, float] = setting(
        "fitted frequencies [Hz]; %(default)s by default",
        BAND,
        type=pair("--band", "LOW:HIGH in Hz, as 3:45"),
        metavar="A:B",
    )
    spacing: float = setting(
        "minimum distance of the fitted frequencies [Hz]; %(default)g by default", SPACING, type=float, metavar="HZ"
    )
    window: float | None = setting(
        "length of the Hann windows of measured FRFs [s]; those of the model are estimated in the same way; by default "
        "the whole record is evaluated",
        type=float,
        metavar="S",
    )


@dataclass(frozen=True, kw_only=True)
class ResponseSettings(ReadingSettings, BandSettings):
    """Settings of measured FRFs of one excitation level."""

    averages: float = setting(
        "number of independent averages of FRFs from a file without random errors; with 1, the default, their noise is "
        "overestimated",
        1.0,
        type=float,
        metavar="N",
    )
    stuck: bool = setting(
        "the dampers stick at this level: the FRFs of the linear car follow from its matrices, and no signal is needed",
        False,
        nargs=0,
        help="the dampers stick at the level of the preceding --frf: linear car, no plate signal needed",
    )


@dataclass(frozen=True, kw_only=True)
class HistorySettings(ReadingSettings):
    """Settings of measured time histories."""

    drift: float = setting("relative lag of the clock of the record [-]", 0.0)
    stretch: tuple[float, float] | None = setting(
        "fitted part of the signal [s]; the whole record by default, on a road from 2 s on",
        type=pair("--stretch", "FROM:TO in s, as 4.9:6.5"),
        metavar="FROM:TO",
    )
    lowpass: float = setting(
        "corner of the low-pass filter on measurement and model [Hz]; %(default)g by default",
        100.0,
        type=float,
        metavar="HZ",
    )


@dataclass(frozen=True, kw_only=True)
class LevelSettings(HistorySettings, BandSettings):
    """Settings of time histories that are compared by FRFs in classes of the input level."""

    levels: int = setting(
        "number of classes of the input level, at least 2",
        0,
        type=int,
        metavar="N",
        help="compare the preceding --record by FRFs in N classes of the input level in place of its time histories",
    )
    reference: str | None = setting(
        "input of the FRFs: a plate, or a measured channel, as knuckle_fl_acc_z; the plate of the shaker wheel by "
        "default",
        metavar="CHANNEL",
        help="input of the FRFs of --levels: a plate, or a measured channel, as knuckle_fl_acc_z; the plate of the "
        "shaker wheel by default",
    )


@dataclass(frozen=True, kw_only=True, slots=True)
class PosteriorSettings(Settings):
    """Settings of a posterior distribution."""

    samples: int = setting("cars of the emulator; %(default)s by default", CARS, type=int, metavar="K")
    discrepancy: float = setting(
        "standard deviation of the error of the model in each third octave [-]; %(default)g by default",
        DISCREPANCY,
        factor=0.01,
        type=float,
        metavar="PERCENT",
        help="standard deviation of the error of the model in each third octave [%%]; %(default)g by default",
    )
    rival: Sequence[str] = setting(
        "another law with its evidence against the fitted one: settings, as damper.viscous_law=degressive, and further "
        "parameters with bounds, as damper.degressive_viscous=2e3:1e4",
        (),
        nargs="+",
        metavar="PATH=VALUE",
    )
