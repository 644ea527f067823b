"""Modes of a car with sticking and with sliding dampers."""

from vehicle import Car

car = Car.load("sedan")

# Sticking dampers are rods: the car has other modes, with hardly any damping.
for state in ("sliding", "stuck"):
    print(f"dampers {state}:")
    for mode in car.modes(state, highest=6.0):
        print(f"  {mode.frequency:5.2f} Hz, damping {100 * mode.damping_ratio:5.1f} %, {mode.description}")

# Simple estimates of heave, pitch, roll and wheel hop, for each motion alone.
for figure in car.show().figures[:5]:
    print(f"{figure.motion:16} {figure.dampers:8} {figure.frequency_hz:5.2f} Hz")

# Where the first bending mode of the body is felt: the FRF from the matrices.
response = car.matrix_frf(["seat_rail_acc_z"], [1.4, 12.0, 25.0], damper="sliding")
for frequency, value in zip((1.4, 12.0, 25.0), abs(response[0]), strict=True):
    print(f"seat rail {value:7.1f} m/s2 per m at {frequency:4.1f} Hz")
