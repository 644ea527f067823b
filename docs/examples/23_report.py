"""A report for colleagues: two cars in one HTML file that computes."""

from vehicle import Car, Run, save_run, write_report

base = Car.load("focus")

# A folder for each run: tables, channels and the vehicle file.
for name, change in (("base", {}), ("less_friction", {"damper.coulomb_friction": 60})):
    run = base.with_(change).run("bump_7p5mm.csv", "reduced")
    folder = save_run(run, name, figures=False)
    print(f"{folder}: {run.comfort().weighted.overall:.4f} m/s2 weighted")

# The second run is compared with the first.
file = write_report(["base", "less_friction"], "a_or_b.html", author="A. Engineer", project="Ride")
print(f"{file}: {file.stat().st_size / 1e6:.1f} MB, to open in a browser")

# The folder loads as a run again.
again = Run.load("less_friction")
print(f"{again.car['damper.coulomb_friction'].value:g} N: friction of the dampers of the saved run")
