"""Two cars on the same road: which is more comfortable, and where in frequency?"""

from vehicle import Car, road

# Stiffer front dampers and softer rear dampers than in the file.
first = Car.load("sedan")
second = first.with_({"front.damper.coulomb_friction": 80, "rear.damper.viscous": 1100})
print("equal cars:", first == second)

# The same seed gives both the same road.
drive = road("B", 80, duration=12, seed=3)
runs = [car.run(drive, "reduced") for car in (first, second)]

# A few figures beside each other; `howto/figures.md` lists all names.
for name, unit in (("weighted", "m/s2"), ("rms:seat rail z:10-20", "m/s2"), ("tyre_load", "-"), ("travel", "m")):
    one, other = (run.figure(name) for run in runs)
    print(f"{name:22} {one:8.4f} {unit}  {other:8.4f} {unit}  {100 * (other / one - 1):+5.1f} %")

# The densities on the same axes; the legend names the cars.
axes = runs[0].psd("seat rail z").plot()
runs[1].psd("seat rail z").plot(ax=axes)
axes[0].figure.savefig("07_compare_two_cars.png")
