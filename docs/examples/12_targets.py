"""Targets: limits for a few figures, and a page with met or missed."""

from pathlib import Path

from vehicle import Car, road, save_run, write_report

# A target is a figure with a limit; `vehicle/runs/targets/ride.toml` is the shipped file.
Path("targets.toml").write_text(
    """
[primary_ride]
quantity = "rms"
channels = ["seat_rail_acc_z"]
band = [0.5, 5.0]
road = "C"
speed = 80
at_most = 1.0
unit = "m/s2"
source = "assumed"
""",
    encoding="utf-8",
)

run = Car.load("sedan").run(road("C", 80, duration=8), "reduced")
value = run.figure("rms:seat rail z:0.5-5")
print(f"primary ride {value:.3f} m/s2, at most 1.0 m/s2: {'met' if value <= 1.0 else 'missed'}")

# The same in a report for colleagues.
save_run(run, "rough", figures=False)
print(write_report(["rough"], "verdict.html", targets="targets.toml"))
