"""Optimise dampers: the best compromises of comfort and tyre load."""

from vehicle import Car, optimise, road

car = Car.load("sedan")
vary = {"front.damper.coulomb_friction": (10, 120), "rear.damper.viscous": (800, 3000)}

# 64 cars here, to be done in seconds; 2000 are the default.
found = optimise(
    car,
    vary,
    road("B", 80, duration=4),
    ["weighted", "tyre_load"],
    limits=["travel<=0.05"],
    cars=64,
    population=16,
)
print(found)

# The knee of the front: a car like any other.
knee = found.cars["knee"]
run = knee.run(road("B", 80, duration=4), "reduced")
print(f"knee: {run.figure('weighted'):.4f} m/s2 weighted, tyre load variation {run.figure('tyre_load'):.4f} -")

axes = found.plot()
axes.figure.savefig("11_optimise.png")
