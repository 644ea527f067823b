"""A road profile of your own: heights of both tracks over the distance."""

import numpy as np

from vehicle import Car, road

# A level road with a dip of 20 mm in the left track and a ramp in both [m].
distance = np.arange(0.0, 120.0, 0.05)
dip = -0.02 * np.exp(-(((distance - 50.0) / 0.8) ** 2))
ramp = 0.03 * np.clip((distance - 80.0) / 4.0, 0.0, 1.0)
columns = np.column_stack([distance, ramp + dip, ramp])
np.savetxt("profile.csv", columns, delimiter=",", header="distance [m],left [m],right [m]", comments="", fmt="%.6f")

# The same road at three speeds; the tyres roll over it.
axes = None
car = Car.load("sedan")
for speed in (30, 50, 70):
    run = car.run(road("profile.csv", speed), "reduced")
    print(
        f"{speed} km/h: seat rail peak {run.figure('peak:seat rail z'):.2f} m/s2, "
        f"smallest tyre load {100 * run.figure('lowest_load'):.0f} % of the static load"
    )

axes = run.plot(["plate fl displacement", "plate fr displacement", "seat rail z"])
axes[0].figure.savefig("22_own_road_profile.png")
