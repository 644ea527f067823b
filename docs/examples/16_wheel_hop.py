"""Wheel hop: unsprung mass, tyre and damper, and what reaches the seat."""

from vehicle import Car, road

car = Car.load("sedan")
mass = "front.parts.knuckle.mass"
print(f"{mass}: {car[mass].value:g} {car[mass].unit}")

drive = road("B", 80, duration=10, seed=2)
axes = None
for more in (0.0, 10.0):
    # A heavier knuckle at each front wheel.
    heavy = car.with_({mass: car[mass].value + more})
    hop = next(each for each in heavy.show().figures if each.motion == "front wheel hop")
    run = heavy.run(drive, "reduced")
    print(
        f"+{more:4.1f} kg: front wheel hop {hop.frequency_hz:.2f} Hz, damping {100 * hop.damping_ratio:.0f} %, "
        f"tyre load variation {100 * run.figure('tyre_load_fl'):.1f} %, "
        f"seat rail 8 to 16 Hz {run.figure('rms:seat rail z:8-16'):.3f} m/s2"
    )
    axes = run.psd("knuckle fl z").plot(ax=axes)
axes[0].figure.savefig("16_wheel_hop.png")
