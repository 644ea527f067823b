"""Tune a parameter to a record: the damper constant from a measured time history."""

from vehicle import Car, measured_histories, save_run, tune

# Here a run of another car stands for the bench; yours is a file of the bench.
bench = Car.load("focus", {"damper.viscous": 2000.0})
record = save_run(bench.run("bump_7p5mm.csv", "reduced"), "bench", figures=False) / "time.npz"

# A start that is wrong by 40 %.
start = Car.load("focus", {"damper.viscous": 1200.0})
measured = measured_histories(start, record, "bump_7p5mm.csv", fitted=["knuckle_fl_acc_z"], lowpass=60)

# Lower and upper bound, and the first value [N s/m].
result = tune(start, {"damper.viscous": (500, 5000, 1200)}, [measured])
(value,) = result.values.values()
print(f"damper constant {value:.0f} N s/m (the bench had 2000 N s/m)")

# The tuned car is a car like any other.
tuned = start.with_(result.values)
for name, car in (("start", start), ("tuned", tuned), ("bench", bench)):
    print(f"{name}: seat rail peak {car.run('bump_7p5mm.csv', 'reduced').figure('peak:seat rail z'):.3f} m/s2")
