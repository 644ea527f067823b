"""A damper law of your own: a valve that opens at 0.05 m/s."""

import ctypes

import matplotlib.pyplot as plt
import numpy as np

from vehicle import Car, register_law, road

LAW = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_void_p, ctypes.c_double, ctypes.c_double)


@LAW
def valve(memory, displacement, velocity):
    """Force [N] over velocity [m/s], positive in extension."""
    return 1500.0 * velocity + 3000.0 * max(-0.05, min(0.05, velocity))


# The name becomes a value of the parameter `function` of a damper.
law = register_law("valve", valve)
car = Car.load("focus_road")
drive = road("C", 60, duration=4)
for name, each in (("file", car), ("valve", car.with_({"front.damper.function": "valve"}))):
    run = each.run(drive, "reduced")
    print(
        f"{name:5}: {run.comfort().weighted.overall:.3f} m/s2 weighted, travel {1e3 * run.figure('travel_fl'):.1f} mm"
    )

velocity = np.linspace(-0.3, 0.3, 61)
print(f"{law.force(0.2):.0f} N at 0.2 m/s")
axis = plt.subplots()[1]
axis.plot(velocity, [law.force(each) for each in velocity])
axis.set(xlabel="velocity [m/s]", ylabel="force [N]")
axis.figure.savefig("21_own_damper_law.png")
