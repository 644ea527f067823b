"""Road classes and speed: how rough a ride is."""

import matplotlib.pyplot as plt

from vehicle import Car, road

car = Car.load("sedan")
speeds = (50, 80, 110)
axis = plt.subplots()[1]

# Classes of ISO 8608: A is a new motorway, C a road with damage.
for name in "ABC":
    values = []
    for speed in speeds:
        run = car.run(road(name, speed, duration=8, seed=1), "reduced")
        values.append(run.comfort().weighted.overall)
    axis.plot(speeds, values, marker="o", label=f"class {name}")
    print(f"class {name}: " + ", ".join(f"{v:.2f} m/s2 at {s} km/h" for v, s in zip(values, speeds, strict=True)))

# A random road of 8 s has a random error, which the comfort value states.
error = run.comfort().values["weighted_error"]
print(f"standard error of the last value: {100 * error:.0f} %")

axis.set(xlabel="speed [km/h]", ylabel="weighted RMS, seat rail [m/s²]")
axis.legend()
axis.figure.savefig("06_road_class_and_speed.png")
