"""When does a damper stick? Friction, slip share and comfort."""

from vehicle import Car, road

car = Car.load("sedan")
path = "front.damper.coulomb_friction"
print(f"{car[path].value:g} {car[path].unit}: friction of a front damper in the file")

# The same smooth road for more and more friction in the front dampers.
axes = None
for friction in (0, 40, 80, 160):
    run = car.with_({path: friction}).run(road("A", 60, duration=8), "reduced")
    print(
        f"friction {friction:3} N: front dampers stick {100 * run.figure('stick_share_fl'):4.1f} % of the time, "
        f"seat rail {run.comfort().weighted.overall:.3f} m/s2 weighted"
    )
    if friction in (0, 160):
        axes = run.plot(["damper velocity front left"], ax=axes)

# With much friction the velocity stays at zero for long spans: there the damper is a rod.
axes.set_xlim(4.0, 6.0)
axes.figure.savefig("04_sticking_damper.png")
