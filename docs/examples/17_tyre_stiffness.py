"""Tyre stiffness, as by inflation pressure: comfort against tyre load."""

import matplotlib.pyplot as plt
import numpy as np

from vehicle import Car, road, sweep

car = Car.load("sedan")
value = car["front.bushings.tyre.stiffness.z"].value
factors = np.array([0.8, 0.9, 1.0, 1.1, 1.2])

# All four tyres change together: "*." is every parameter with this end.
vary = [{"*.bushings.tyre.stiffness.z": factor * value} for factor in factors]
table = sweep(car, vary, road("B", 80, duration=8), measure=["weighted", "tyre_load"], engine="reduced")

comfort, load = table.column("weighted"), table.column("tyre_load")
for factor, one, other in zip(factors, comfort, load, strict=True):
    print(f"tyre {1e-3 * factor * value:5.0f} N/mm: {one:.4f} m/s2 weighted, tyre load variation {100 * other:.2f} %")
print(f"comfort changes by {100 * (comfort[-1] / comfort[0] - 1):+.1f} % from the softest to the stiffest tyre")

axis = plt.subplots()[1]
axis.plot(1e-3 * factors * value, comfort, marker="o")
axis.set(xlabel="vertical tyre stiffness [N/mm]", ylabel="weighted RMS, seat rail [m/s²]")
axis.figure.savefig("17_tyre_stiffness.png")
