"""FRF with coherence: one car, two levels, two different FRFs."""

import numpy as np

from vehicle import Car

car = Car.load("focus")
axes = None
for level in ("low.csv", "high.csv"):
    run = car.run(level, "reduced")
    response = run.frf("seat rail z")

    # The largest magnitude [m/s2 per m of plate displacement] and its coherence.
    size = np.abs(response.response[0])
    peak = np.nanargmax(size)
    print(
        f"{level:8}  peak {size[peak]:6.0f} m/s2/m at {response.frequency[peak]:5.2f} Hz, "
        f"coherence {response.coherence[0, peak]:.3f}, slip {100 * run.slip_share(run.wheel):.1f} %"
    )

    # Magnitude, phase and coherence of both levels on the same axes.
    axes = response.plot(ax=axes)

# Friction is not linear: at the high level the dampers slip, and the coherence falls.
axes[0].set_title("Seat rail, vertical: low level solid, high level dashed")
axes[0].figure.savefig("03_frf_with_coherence.png")
