"""Comfort values: RMS, weighted RMS, VDV, MTVV and crest factor of one ride."""

from vehicle import Car, road

# A car with a seat and an occupant, on a rough road; the start from rest is left out.
car = Car.load("focus_road_seated")
run = car.run(road("C", 50, duration=12), "reduced")
comfort = run.comfort()
print(f"evaluated from {run.skip:g} s on")

# Both values at the seat rail and on the cushion, by axis.
for point in (comfort, comfort.cushion):
    for axis in "xyz":
        unweighted, weighted = getattr(point.unweighted, axis), getattr(point.weighted, axis)
        print(f"{point.point:10} {axis}: unweighted {unweighted:.3f} m/s2, weighted {weighted:.3f} m/s2")
print(f"SEAT value {comfort.seat_value:.2f} -: below 1 the seat isolates")

# Single shocks count more in these.
print(f"VDV          {run.figure('vdv:seat z:Wk'):.3f} m/s^1.75")
print(f"MTVV         {run.figure('mtvv:seat z:Wk'):.3f} m/s2")
print(f"crest factor {run.figure('crest_factor:seat z:Wk'):.2f} -")

# Density, third octaves and cumulative RMS, unweighted and weighted.
axes = run.psd("seat z").plot()
axes[0].figure.savefig("05_comfort_values.png")
