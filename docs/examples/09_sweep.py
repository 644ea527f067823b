"""Sweep: every combination of two parameters, ranked by comfort."""

import matplotlib.pyplot as plt

from vehicle import Car, road, sweep

car = Car.load("sedan")
vary = {
    "front.damper.coulomb_friction": [20, 60, 100],  # N
    "rear.damper.viscous": [1000, 1500, 2000],  # N s/m
}

# Nine runs of the reduced engine; with jobs=4 they go to four processes.
table = sweep(car, vary, road("B", 80, duration=8), engine="reduced")

# Cars in the order of comfort.
print(table)
best = table.to_dataframe().sort_values("weighted [m/s2]").iloc[0]
print(f"best: {best['weighted [m/s2]']:.4f} m/s2 weighted at the seat rail")

# The same runs for other figures.
loads = sweep(car, vary, road("B", 80, duration=8), measure=["tyre_load", "travel"], engine="reduced")
print(f"tyre load variation {loads.column('tyre_load').min():.3f} to {loads.column('tyre_load').max():.3f} -")

# A map over two parameters.
table.plot()
plt.savefig("09_sweep.png")
