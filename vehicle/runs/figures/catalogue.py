"""The catalogue: every figure of a ride by its name.

A figure is added here alone. Sweeps, searches, targets, bench, report, page with sliders and Python take it by its name
(`vehicle.runs.figures.chosen_figure`), and `docs/howto/figures.md` lists it.
"""

from vehicle.runs.figures.comfort_figures import COMFORT_FIGURES
from vehicle.runs.figures.figure import Figure
from vehicle.runs.figures.level_figures import LEVEL_FIGURES
from vehicle.runs.figures.reductions import (
    DOSE,
    FIRST_SLIP,
    LARGEST_CREST,
    LOWEST,
    MTVV,
    PEAK,
    PEAK_TO_PEAK,
    RATIO,
    RMS,
    SATURATED,
    SETTLING,
    SLIP,
    STICK,
    WHEEL_RMS,
    require_obstacle,
)
from vehicle.runs.figures.rows import CHANNELS, LOAD_FORCES, LOAD_VARIATIONS, LOADS, TRAVELS, VELOCITIES
from vehicle.runs.figures.turning_figures import MOTION_FIGURES, ORDER_FIGURES

FIGURES: dict[str, Figure] = COMFORT_FIGURES | {
    "rms": Figure(
        words="RMS", meaning="root of the sum of the mean squares of the channels [U]",
        reads=CHANNELS, reduces=RMS, needs=("channels",), takes=("band", "weighting"),
    ),
    "peak": Figure(
        words="peak", meaning="maximum of |channel|, over all channels [U]",
        reads=CHANNELS, reduces=PEAK, needs=("channels",), takes=("weighting",),
    ),
    "peak_to_peak": Figure(
        words="peak to peak", meaning="maximum minus minimum, largest of all channels [U]",
        reads=CHANNELS, reduces=PEAK_TO_PEAK, needs=("channels",), takes=("weighting",),
    ),
    "vdv": Figure(
        words="vibration dose value",
        meaning="vibration dose value, fourth root of the sum of the fourth powers of the channels [m/s^1.75]",
        unit="m/s^1.75", reads=CHANNELS, reduces=DOSE, needs=("channels", "weighting"),
        of_unit="m/s2",
    ),
    "mtvv": Figure(
        words="largest running RMS",
        meaning="maximum transient vibration value, RMS over 1 s at its largest, of all channels [U]",
        reads=CHANNELS, reduces=MTVV, needs=("channels",), takes=("weighting",),
    ),
    "crest_factor": Figure(
        words="crest factor", meaning="maximum of |channel| divided by its RMS, largest of all channels [-]",
        unit="-", reads=CHANNELS, reduces=LARGEST_CREST, needs=("channels",), takes=("weighting",),
    ),
    "settling": Figure(
        words="settling time",
        meaning="time after an obstacle in which |channel| stays above 10 % of its peak, longest of all channels [s]",
        unit="s", reads=CHANNELS, reduces=SETTLING, needs=("channels",), on_input=require_obstacle,
    ),
    "ratio": Figure(
        words="RMS ratio", meaning="RMS of the channels divided by the RMS of the channels in `over` [-]",
        unit="-", reads=CHANNELS, reduces=RATIO, better="", needs=("channels", "over"), takes=("band", "weighting"),
    ),
    "tyre_load": Figure(
        words="tyre load variation",
        meaning="RMS of the dynamic tyre load divided by the static load (dynamic load coefficient), all wheels "
        "together [-]",
        unit="-", reads=LOAD_VARIATIONS, reduces=WHEEL_RMS, takes=("wheels",),
    ),
    "tyre_load_rms": Figure(
        words="dynamic tyre load", meaning="RMS of the tyre load minus the static load, all wheels together [N]",
        unit="N", reads=LOAD_FORCES, reduces=WHEEL_RMS, takes=("wheels",),
    ),
    "tyre_load_crest": Figure(
        words="tyre load crest factor",
        meaning="maximum of the dynamic tyre load divided by its RMS, largest of all wheels [-]",
        unit="-", reads=LOAD_VARIATIONS, reduces=LARGEST_CREST, takes=("wheels",),
    ),
    "lowest_load": Figure(
        words="lowest tyre load", meaning="minimum tyre load divided by the static load, of all wheels [-]",
        unit="-", reads=LOADS, reduces=LOWEST, better="more", takes=("wheels",),
    ),
    "travel": Figure(
        words="damper travel", meaning="maximum travel of a damper from rest, largest of all wheels [m]",
        unit="m", reads=TRAVELS, reduces=PEAK, takes=("wheels",), of_car="damper",
    ),
    "stick_share": Figure(
        words="time stuck", meaning="share of the time in which a damper sticks, largest of all wheels [-]",
        unit="-", reads=VELOCITIES, reduces=STICK, takes=("wheels",), of_car="damper",
    ),
    "slip_share": Figure(
        words="time in slip", meaning="share of the time in which a damper slips, mean of all dampers [-]",
        unit="-", reads=VELOCITIES, reduces=SLIP, better="", takes=("wheels",), of_car="damper",
    ),
    "saturated_share": Figure(
        words="time at full friction",
        meaning="share of the time in which a damper moves faster than 1 mm/s, mean of all dampers [-]",
        unit="-", reads=VELOCITIES, reduces=SATURATED, better="", takes=("wheels",), of_car="damper",
    ),
    "first_slip": Figure(
        words="first slip", meaning="time at which the first damper slips, of the whole run [s]",
        unit="s", reads=VELOCITIES, reduces=FIRST_SLIP, better="", takes=("wheels",), of_car="damper",
    ),
} | ORDER_FIGURES | MOTION_FIGURES | LEVEL_FIGURES  # fmt: skip
"""Name of each figure to the figure."""
