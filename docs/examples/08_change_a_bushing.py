"""Change a bushing: find it, change it, see what it does to the FRF."""

import numpy as np

from vehicle import Car

car = Car.load("focus")

# Words find a parameter; its path, unit, range and source come with it.
for parameter in car.search("suspension mount stiffness")[:1]:
    print(parameter)
path = "front.bushings.suspension_mount.stiffness.z"
value = car[path].value

# The top mount of the strut: half, as it is, twice.
axes = None
for factor in (0.5, 1.0, 2.0):
    run = car.with_({path: factor * value}).run("low.csv", "reduced")
    response = run.frf("knuckle fl z")
    band = (response.frequency > 20.0) & (response.frequency < 40.0)
    size = np.where(band, np.abs(response.response[0]), 0.0)
    print(
        f"mount {1e-3 * factor * value:5.0f} N/mm: wheel mode at {response.frequency[size.argmax()]:.2f} Hz, "
        f"comfort {run.comfort().unweighted.overall:.4f} m/s2"
    )
    axes = response.plot(ax=axes)

axes[0].figure.savefig("08_change_a_bushing.png")
