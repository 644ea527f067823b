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


@dataclass(frozen=True, kw_only=True, slots=True)
class MeasurementFile:
    """Measurement file of a fit with its own settings."""

    file: Path  # the file
    content: str  # "frf" for FRFs, "record" for time histories
    signal: str | None = None  # file of the plate displacement; by default the plate in the file
    stuck: bool = False  # of FRFs: the dampers stick at this level
    # road, speed, contact: of time histories: road in the forms of `shaker`, speed [km/h], tyre contact
    road: str | None = None
    speed: float | str | None = None
    contact: str | None = None
    levels: int | None = None  # levels, reference: of time histories: see `LevelSettings`
    reference: str | None = None


@dataclass(frozen=True)
class ReadingSettings(Settings):
    """Settings of a measurement file."""

    signal: Signal | Road | Path | str | None = setting(
        "plate displacement of the measurement: a signal, a file, or the name of a shipped file; for time "
        "histories also the road; default: the plate in the measurement file"
    )
    channels: Mapping[str, str] | None = setting(
        "channel of the model and its channel in the file; default: equal names"
    )
    _: KW_ONLY
    choice: Choice | None = setting("units, rate and excerpt of the file")
    inverted: Collection[str] = setting("channels measured with the opposite sign", ())
    fitted: Sequence[str] = setting("channels to fit; default: all except plates", ())
    delay: Delay = setting(
        "for time histories: start of the record after the start of the signal [s], or known delays of groups, "
        "channels or patterns, for example {'record': 0.2, 'accelerations': 0.0123}; all others are fitted",
        0.0,
    )


@dataclass(frozen=True, kw_only=True)
class BandSettings(Settings):
    """Settings of FRFs in a band."""

    band: tuple[float, float] = setting(
        "range of the fitted frequencies [Hz]; default: %(default)s",
        BAND,
        type=pair("--band", "LOW:HIGH in Hz, for example 3:45"),
        metavar="A:B",
    )
    spacing: float = setting(
        "minimum distance of the fitted frequencies [Hz]; default: %(default)g",
        SPACING,
        within="(0, inf)",
        type=float,
        metavar="HZ",
    )
    window: float | None = setting(
        "length of the Hann windows of measured FRFs [s]; FRFs of the model are estimated with the same "
        "windows; default: the whole record",
        within="(0, inf)",
        type=float,
        metavar="S",
    )


@dataclass(frozen=True, kw_only=True)
class ResponseSettings(ReadingSettings, BandSettings):
    """Settings of measured FRFs of one excitation level."""

    averages: float = setting(
        "number of independent averages of measured FRFs, if the file has no random errors; default: 1, which "
        "overestimates the noise",
        1.0,
        within="(0, inf)",
        type=float,
        metavar="N",
    )
    stuck: bool = setting(
        "the dampers stick at this level, so the FRFs follow from the linear car and no signal is needed",
        False,
        nargs=0,
        help="for the preceding --frf: the dampers stick at its level, so the linear car is used and no plate "
        "signal is needed",
    )


@dataclass(frozen=True, kw_only=True)
class HistorySettings(ReadingSettings):
    """Settings of measured time histories."""

    drift: float = setting("relative amount by which the clock of the record runs slow [-]", 0.0)
    stretch: tuple[float, float] | None = setting(
        "part of the record to fit, in times of the file, like --from and --to [s]; default: the whole record, or on "
        "a road from 2 s on",
        type=pair("--stretch", "FROM:TO in s, for example 4.9:6.5"),
        metavar="FROM:TO",
    )
    lowpass: float = setting(
        "corner frequency of the low-pass filter on measurement and model [Hz]; default: %(default)g",
        100.0,
        within="(0, inf)",
        type=float,
        metavar="HZ",
    )


@dataclass(frozen=True, kw_only=True)
class LevelSettings(HistorySettings, BandSettings):
    """Settings of time histories that are compared by FRFs in classes of the input level."""

    levels: int | None = setting(
        "number of classes of the input level, at least 2",
        within="[2, inf)",
        type=int,
        metavar="N",
        help="compare the preceding --record by FRFs in N classes of the input level, instead of its time histories",
    )
    reference: str | None = setting(
        "input of the FRFs: a plate, or a measured channel, for example knuckle_fl_acc_z; default: the plate of "
        "the shaker wheel",
        metavar="CHANNEL",
        help="input of the FRFs of --levels: a plate, or a measured channel, for example knuckle_fl_acc_z; "
        "default: the plate of the shaker wheel",
    )


@dataclass(frozen=True, kw_only=True, slots=True)
class PosteriorSettings(Settings):
    """Settings of a posterior distribution."""

    samples: int = setting(
        "number of simulated cars from which the fast replacement model is built; default: %(default)s",
        CARS,
        within="[1, inf)",
        type=int,
        metavar="K",
    )
    discrepancy: float = setting(
        "expected relative error of the model in a third octave (standard deviation) [-]; default: %(default)g",
        DISCREPANCY,
        factor=0.01,
        within="[0, 100)",
        type=float,
        metavar="PERCENT",
        help="expected relative error of the model in a third octave (standard deviation) [%%]; default: %(default)g",
    )
    rival: Sequence[str] = setting(
        "compare the fitted law with a second law, given by its settings, for example "
        "damper.viscous_law=degressive, and its parameters with bounds, for example "
        "damper.degressive_viscous=2e3:1e4",
        (),
        nargs="+",
        metavar="PATH=VALUE",
    )
