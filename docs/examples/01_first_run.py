"""First run: a car on a shaker, its comfort and the slip of its dampers."""

from vehicle import Car

# The car of Bommer 2006, with its front wheels on shaker plates.
car = Car.load("focus")

# A measured plate displacement that comes with the program; one plate moves.
run = car.run("low.csv", "reduced")
print(f"{run.signal.duration:.0f} s, plate {run.wheel}: RMS {1e3 * run.signal.rms(run.wheel):.3f} mm")

# Comfort at the seat rail: RMS over all axes.
comfort = run.comfort()
print(f"unweighted, 2 to 50 Hz:  {comfort.unweighted.overall:.4f} m/s2")
print(f"weighted (ISO 2631-1):   {comfort.weighted.overall:.4f} m/s2")

# Share of the time in which a damper slips; the rest of the time friction holds it.
for wheel in ("fr", "fl"):
    print(f"damper {wheel} slips {100 * run.slip_share(wheel):.1f} % of the time")

# Plate, seat rail, knuckle and damper over time.
axes = run.plot()
axes[0].figure.savefig("01_first_run.png")
