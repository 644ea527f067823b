"""A logger file: names, units, gravity and sign, and what they do to comfort."""

import numpy as np

from vehicle import Car, compare, diagnose

# A logger with mm, g, gravity, an offset of the plate sensor and a sensor upside down.
run = Car.load("focus").run("low.csv", "reduced")
columns = np.column_stack(
    [run.time, 1e3 * run["plate_fl_displacement"] + 75.0, -run["knuckle_fl_acc_z"] / 9.80665 + 1.0]
)
head = "Time [s],Shaker FL [mm],Hub FL z [g]"
np.savetxt("logger.csv", columns, delimiter=",", header=head, comments="", fmt="%.6f")

# What is wrong with the file, and the arguments that mend it.
findings = diagnose("logger.csv", Car.load("focus"))
print(findings)

# With these arguments the file compares with a run of the car.
comparison = compare(run, "logger.csv", **findings.arguments)
record = comparison.records[0]
print(f"{record.channel}: {record.rms:.3f} m/s2 RMS measured, {100 * record.rms_ratio:.1f} % of it simulated")
print(f"correlation {record.correlation:.4f} -")
