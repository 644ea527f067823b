"""Engine mounts and orders: the second order of the crankshaft at the seat rail."""

import matplotlib.pyplot as plt
import numpy as np

from vehicle import Car, order_points

# A four-cylinder engine: 40 N m of the second order about the y axis of the engine.
shake = {
    "force.shake.on": "engine",
    "force.shake.moment": [0, -1, 0],
    "force.shake.angle": "crank",
    "force.shake.harmonics": [[2, 40, 0]],
}
car = Car.load("sedan", shake)
rpm = [700, 800, 900, 1000]

axis = plt.subplots()[1]
for factor in (0.7, 1.4):
    # All engine mounts softer or stiffer along z.
    mounts = [each.path for each in car.search("engine mount stiffness") if each.path.endswith("mount.stiffness")]
    stiff = car.with_({f"{path}.z": factor * car[f"{path}.z"].value for path in mounts})
    points = order_points(stiff, rpm=rpm, orders=[2], duration=4)
    size = np.abs(points.amplitude).ravel()
    print(f"mounts x {factor}: largest {1e3 * size.max():.2f} mm/s2 at {rpm[int(size.argmax())]} 1/min")
    axis.plot(rpm, 1e3 * size, marker="o", label=f"mounts x {factor}")

axis.set(xlabel="crankshaft [1/min]", ylabel="order 2, seat rail z [mm/s²]")
axis.legend()
axis.figure.savefig("18_engine_orders.png")
