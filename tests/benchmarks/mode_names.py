"""Names of the modes of four cars, with the share of the kinetic energy that they name: a table, run by hand.

    python -m tests.benchmarks.mode_names

Asked: the named motion holds half of the energy, or two motions are named with their shares.
"""

from vehicle.engines.linear.motion_names import NAMED
from vehicle.runs.car import Car

CARS = (
    ("focus", "stuck"), ("focus", "sliding"), ("focus_road", "stuck"), ("focus_road_seated", "stuck"),
    ("sedan", "stuck"), ("sedan", "sliding"),
)  # fmt: skip


def main() -> None:
    """Print the names of all modes, and how many are held by one motion, by two, and by less than half together."""
    totals = []
    for name, damper in CARS:
        modes = Car.load(name).modes(damper)
        print(f"{name}, dampers {damper}\n{'Hz':>8} {'named':>6}  name")
        shares = [list(mode.motions.values()) for mode in modes]
        for mode, share in zip(modes, shares, strict=True):
            held = share[0] if share[0] >= NAMED else sum(share[:2])
            print(f"{mode.frequency:8.3f} {100.0 * held:4.0f} %  {mode.description}")
        one = sum(share[0] >= NAMED for share in shares)
        pair = sum(share[0] < NAMED <= sum(share[:2]) for share in shares)
        least = min(sum(share[:2]) for share in shares)
        totals.append((f"{name}, {damper}", len(modes), one, pair, len(modes) - one - pair, least))
        print()
    print(f"{'car':<26}{'modes':>6}{'one name':>10}{'two':>5}{'two, below half':>17}{'least share of two':>20}")
    for row in totals:
        print(f"{row[0]:<26}{row[1]:>6}{row[2]:>10}{row[3]:>5}{row[4]:>17}{100.0 * row[5]:>18.0f} %")


if __name__ == "__main__":
    main()
