"""A plate signal of your own, from an array: one bump of 5 mm."""

import numpy as np

from vehicle import Car, Signal

# Time [s] and displacement of the plate [m]; the plate starts at rest.
time = np.arange(0.0, 5.0, 1e-3)
bump = 0.005 * np.exp(-(((time - 2.0) / 0.04) ** 2))

# The plate under the front left wheel moves, the other stands.
signal = Signal(time=time, displacement={"fl": bump}, source="bump")
car = Car.load("focus")
run = car.run(signal, "reduced")

# The largest motion, and when it happens.
for name in ("knuckle fl z", "seat rail z"):
    history = run[name]
    peak = np.argmax(np.abs(history))
    print(f"{name:13} {history[peak]:7.2f} m/s2 at {run.time[peak]:.3f} s")

# How long the seat rail stays above a tenth of its peak.
size = np.abs(run["seat rail z"])
above = run.time[size > 0.1 * size.max()]
print(f"above a tenth of the peak for {above[-1] - above[0]:.2f} s")

axes = run.plot(["plate fl displacement", "knuckle fl z", "seat rail z"])
axes[-1].set_xlim(1.8, 3.0)
axes[0].figure.savefig("02_own_plate_signal.png")
