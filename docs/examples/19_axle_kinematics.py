"""Kinematics of an axle: toe over travel, and a tie rod 5 mm higher."""

import matplotlib.pyplot as plt
import numpy as np

from vehicle import Car
from vehicle.engines.kinematics.axle_curves import travel_curve
from vehicle.runs.car.axle import axle_statics, car_at_rest

car = Car.load("sedan")
path = "front.hardpoints.tie_outer.z"
axis = plt.subplots()[1]
for shift in (0.0, 0.005):
    moved = car.with_({path: car[path].value + shift})

    # Bump steer and roll centre come with the data of the car.
    front = moved.show().axles[0]
    print(f"tie rod +{1e3 * shift:.0f} mm: bump steer {0.1 * front.bump_steer_deg_per_m:+.2f} deg per 100 mm")

    # The right wheel over its travel, in static equilibrium at each position.
    travels = np.linspace(-0.04, 0.04, 9)
    poses = travel_curve(axle_statics(car_at_rest(moved), "front", ideal=False), travels)
    print(f"  toe-in from {poses[0].toe_deg:+.3f} deg to {poses[-1].toe_deg:+.3f} deg over 80 mm")
    axis.plot(1e3 * travels, [pose.toe_deg for pose in poses], marker="o", label=f"+{1e3 * shift:.0f} mm")

axis.set(xlabel="wheel travel [mm]", ylabel="toe-in [deg]")
axis.legend()
axis.figure.savefig("19_axle_kinematics.png")
