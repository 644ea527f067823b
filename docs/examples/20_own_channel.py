"""A channel of your own: the acceleration at any point of any part."""

from vehicle import Car, road

# Coordinates [m] in the design position: x to the rear, y to the right, z up.
car = Car.load("sedan").with_channel("tunnel", [1.6, 0.0, 0.45])
car = car.with_channel("rear_bench", [2.9, -0.35, 0.6])

# The new points have channels in x, y and z, like those of the file.
run = car.run(road("B", 80, duration=10), "reduced")
print([name for name in run.channels if name.startswith(("tunnel", "rear_bench"))])

# Front and rear passengers.
for point in ("seat_rail", "tunnel", "rear_bench"):
    value = run.figure(f"rms:{point}_acc_z:0.5-80:Wk")
    print(f"{point:10} {value:.3f} m/s2 weighted RMS, vertical")

# Spectra, FRFs, sweeps and `car.save` know the channel too.
axes = run.psd(["seat rail z", "rear bench z"]).plot()
axes.flat[0].figure.savefig("20_own_channel.png")
