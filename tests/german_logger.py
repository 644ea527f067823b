"""Record of a German logger: semicolons, decimal commas, plates in mm about mid stroke, accelerations in g, faults."""

import numpy as np

from tests.delayed_records import late, shaken
from vehicle import Car

TRUTH = {"front.damper.viscous": 1900.0, "front.damper.coulomb_friction": 48.0}
"""Parameters of the measured car; `focus_road` has 2250 N s/m and 125 N."""

LATE = 0.012
"""Delay of the accelerations [s]."""

CORNERS = {"fl": "VL", "fr": "VR", "rl": "HL", "rr": "HR"}
NAMES = {
    **{f"plate_{wheel}_displacement": f"Stempel {corner} [mm]" for wheel, corner in CORNERS.items()},
    **{f"knuckle_{wheel}_acc_z": f"Radträger {corner} z [g]" for wheel, corner in CORNERS.items()},
    "seat_rail_acc_z": "Sitzschiene z [g]",
}


def measured_run(seconds=40.0):
    """Return a run of the measured car on four independent plates with 1.5 mm RMS from 0.7 to 25 Hz."""
    signal = shaken(CORNERS, seconds, rms=1.5e-3, band=(0.7, 25.0), seed=5)
    return Car.load("focus_road", TRUTH).run(signal, engine="reduced")


def write_logger(path, run, *, exchanged=None, inverted=None):
    """Write the channels of a run from 2 s on, with 3 % of noise, gravity, late accelerations, and two faults."""
    random, columns = np.random.default_rng(7), {}
    for name in NAMES:
        values = np.array(run[name])
        values += 0.03 * np.std(values) * random.standard_normal(values.size)
        values = -values if name == inverted else values
        if name.startswith("plate"):
            columns[name] = 1e3 * values + 75.0 + random.uniform(-1.0, 1.0)
        else:
            columns[name] = late(values, LATE) / 9.80665 + 1.0
    if exchanged:
        first, second = exchanged
        columns[first], columns[second] = columns[second], columns[first]
    inside = run.time >= 2.0
    table = np.column_stack([run.time[inside] - 2.0, *(values[inside] for values in columns.values())])
    rows = ["Zeit [s];" + ";".join(NAMES.values())]
    rows += [";".join(f"{value:.6f}".replace(".", ",") for value in row) for row in table.tolist()]
    path.write_text("\n".join([*rows, ""]), encoding="utf-8")
    return path
