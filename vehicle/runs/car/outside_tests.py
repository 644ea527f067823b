"""Share of time in which dampers move outside the velocities of their tests, and its effect on comfort.

Above the fastest test the force of a law goes on with its last slope; below the slowest test its friction and its first
slope are those of the fit. No test shows either. Bounds of the comfort come from runs with the reduced engine whose
laws continue from the end v_h of the range in two other ways, the force constant or in proportion to the velocity:

    above v_h:  F = F_c(v_h)  or  F_c(v_h) v/v_h;
    below v_l:  F = F(v_l) sign(v), friction alone,  or  F(v_l) v/v_l, without friction;   F = F_c + friction.

They enclose degressive laws, and all splits of the force at v_l into friction and damping. The differences are those to
a run of the same engine with the law as it is.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple, TypeVar

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.engines.reduced.batch_simulation import simulate_batch
from vehicle.errors import VehicleError
from vehicle.model.laws.damper import damper_curve
from vehicle.model.parameters.composition import PlacedDamper
from vehicle.model.parameters.force_elements import Damper
from vehicle.names import AXES
from vehicle.runs.car.simulated_run import with_notices
from vehicle.signals.analysis.ride_comfort import WEIGHTED, comfort_columns

T = TypeVar("T")

RELEVANT = 0.01
"""Minimum change of the weighted acceleration [-] that is stated: a tenth of a change that persons notice."""

RARE = 0.01
"""Minimum share of time [-] that is stated where the comfort is unknown."""

FAR = 10.0
"""Velocity of the last point of a continued table [m/s], faster than any damper."""

ROOM = 2**26
"""Maximum size of the accelerations of runs in a batch [byte]."""

RAIL = tuple(f"seat_rail_acc_{axis}" for axis in AXES)

ABOVE, BELOW = 2, 3
"""Sides of the range: indices of the shares in `_Outside`."""

CONTINUATIONS = {
    ABOVE: ("stays constant", "grows in proportion to the velocity"),
    BELOW: ("is friction alone", "is damping alone"),
}
"""Two continuations of a law on each side in words: the force constant, and in proportion to the velocity."""


def with_range_notice(run: T) -> T:
    """Return a run with the sentence of `outside_tests` among the notices of its recording."""
    simulated: Any = run
    noted: T = replace(simulated, recording=with_notices(simulated.recording, outside_tests(simulated)))
    return noted


def outside_tests(run: Any) -> tuple[str, ...]:
    """Return a sentence on dampers outside the velocities of their tests; none if the comfort does not depend on it.

    Args:
        run: the run; the evaluated span counts.
    """
    laws: dict[str, _Outside] = {}
    names: list[str] = []
    for damper in run.car.vehicle.composition.dampers:
        tested, channel = damper.law.tested, f"{damper.name}_velocity"
        if tested is None or tested.velocity is None or channel not in run.channels:
            continue
        low, high = tested.velocity
        speed = np.abs(run.recording[channel][run.evaluated])
        found = _Outside(low, high, float(np.mean(speed > high)), float(np.mean(speed < low)), float(np.max(speed)))
        other = laws.get(damper.path, found)
        laws[damper.path] = _Outside(low, high, *map(max, found[2:], other[2:]))
        names.append(damper.name)
    outside = {side: {path: each for path, each in laws.items() if each[side]} for side in CONTINUATIONS}
    try:
        changes = _changes_of_comfort(run, names, [side for side in outside if outside[side]])
    except VehicleError:
        changes = None
    sentences = []
    for side, sides in outside.items():
        shares = "; ".join(f"{path} is {each.words(side)}" for path, each in sides.items())
        # Every damper is slow at times, so that the time below the range alone is no reason for a message.
        if changes is None and side == ABOVE and any(each.above > RARE for each in sides.values()):
            sentences.append(f"{shares}; no test shows its force there, and the effect on comfort is not computed")
        elif changes is not None and any(abs(each) >= RELEVANT for each in changes.get(side, {}).values()):
            effects = " and ".join(
                f"by {'+' if each > 0.0 else ''}{number(100.0 * each, 2)} % if the force {way}"
                for way, each in changes[side].items()
            )
            fastest = max(each.fastest for each in sides.values())
            more = f"up to {number(fastest, 2)} m/s" if side == ABOVE else "with lower velocities"
            sentences.append(
                f"{shares}. No test shows the force there: the weighted acceleration at the seat rail changes "
                f"{effects}; add tests {more}"
            )
    return tuple(sentences)


class _Outside(NamedTuple):
    """Range of a law [m/s], shares of time above and below it, the larger ones of both sides, and highest velocity."""

    low: float
    high: float
    above: float
    below: float
    fastest: float

    def words(self, side: int) -> str:
        """Return range and share of a side in words."""
        share = f"{number(100.0 * self[side], 2)} % of the time"
        if side == ABOVE:
            reached = f"up to {number(self.fastest, 2)} m/s"
            return f"faster than its fastest test ({number(self.high, 2)} m/s) for {share}, {reached}"
        return f"slower than its slowest test reaches ({number(self.low, 2)} m/s) for {share}"


def _changes_of_comfort(run: Any, names: Sequence[str], sides: Sequence[int]) -> dict[int, dict[str, float]] | None:
    """Return the relative change of comfort for each continuation of each side; None if it cannot be computed.

    Args:
        names: dampers with a range.
        sides: `ABOVE`, `BELOW` or both.
    """
    dampers = run.car.vehicle.composition.dampers
    laws = [each.law for each in dampers if each.name in names]
    other_laws = any(law.controlled or law.function or law.friction_function for law in laws)
    if other_laws or not sides or not set(RAIL) <= set(run.channels):
        return None
    cars = [run.car]
    for side in sides:
        for constant in (True, False):
            others = {
                each.name: continued(each.law, above=side == ABOVE, constant=constant)
                for each in dampers
                if each.name in names
            }
            changed = [replace(each, law=others.get(each.name, each.law)) for each in dampers]
            cars.append(_variant(run.car, tuple(changed)))
    comfort = _comfort(cars, run)
    if comfort[0] == 0.0:
        return None
    changes = (comfort[1:] / comfort[0] - 1.0).reshape(-1, 2).tolist()
    return {side: dict(zip(CONTINUATIONS[side], pair, strict=True)) for side, pair in zip(sides, changes, strict=True)}


def continued(law: Damper, *, above: bool, constant: bool) -> Damper:
    """Return the law of a damper with another continuation outside the range of its tests.

    Args:
        law: law with a range of velocities.
        above: True for a continuation above the fastest test, False for one below the slowest test.
        constant: True for a constant force, False for one in proportion to the velocity.
    """
    assert law.tested is not None and law.tested.velocity is not None
    end = law.tested.velocity[1 if above else 0]
    curve, at_rest = damper_curve(law), float(damper_curve(law).force(0.0))
    speeds, sides = {}, {}
    for sign in (1.0, -1.0):
        knots = sign * curve.knots
        inner = knots[(knots > 0.0) & (knots < end)] if above else knots[knots > end]
        speeds[sign] = np.unique([*inner, end])
        sides[sign] = sign * (curve.force(sign * speeds[sign]) - at_rest)
    last = {sign: float(curve.slope(sign * FAR)) for sign in sides}
    friction = 0.0
    if above:
        last = {sign: 0.0 if constant else float(force[-1]) / end for sign, force in sides.items()}
    else:
        if constant:  # the friction is alike on both sides; what one side has more remains damping
            friction = min(float(force[0]) for force in sides.values()) + float(_friction(law, np.array([end]))[0])
        sides = {sign: np.maximum.accumulate(np.maximum(force + _friction(law, speeds[sign]) - friction, 0.0))
                 for sign, force in sides.items()}  # fmt: skip
    points = [(0.0, at_rest)]
    for sign, force in sides.items():
        far = float(force[-1]) + last[sign] * (FAR - float(speeds[sign][-1]))
        pairs = zip([*speeds[sign].tolist(), FAR], [*force.tolist(), far], strict=True)
        points += [(sign * v, at_rest + sign * f) for v, f in pairs]
    velocity, forces = zip(*sorted(points), strict=True)
    table = replace(law, viscous_law="table", velocity=velocity, force=forces, tested=None)
    if above:
        return table
    return replace(table, friction_law="coulomb", friction_function=None, coulomb_friction=friction)


def _friction(law: Damper, speeds: Vector) -> Vector:
    """Return the friction limit [N] at velocities [m/s]; (n,)."""
    if law.friction_law != "stribeck":
        return np.full(speeds.size, law.coulomb_friction)
    assert law.stribeck_velocity is not None and law.stribeck_exponent is not None
    weight = np.exp(-((speeds / law.stribeck_velocity) ** law.stribeck_exponent))
    return np.asarray(law.coulomb_friction + (law.static_friction - law.coulomb_friction) * weight)


def _variant(car: Any, dampers: tuple[PlacedDamper, ...]) -> Any:
    """Return a car with other laws of dampers; its matrices come from terms of the car."""
    vehicle = replace(car.vehicle, composition=replace(car.vehicle.composition, dampers=dampers))
    variant = type(car)(vehicle, folder=car.folder)
    variant._base = car
    return variant


def _comfort(cars: Sequence[Any], run: Any) -> Vector:
    """Return the weighted acceleration at the seat rail of cars on the input of a run [m/s2]; (cars,)."""
    samples, values = run.recording.time.size, []
    size = max(int(ROOM / (8.0 * len(RAIL) * samples)), 1)
    for first in range(0, len(cars), size):
        batch = cars[first : first + size]
        runs = simulate_batch(
            [car.poles for car in batch],
            run.signal,
            dampers=[[damper.law for damper in car.vehicle.composition.dampers] for car in batch],
            record_rate=run.car.vehicle.solver.record_rate,
            tyre_load=[car.static.tyre_load for car in batch],
            channels=RAIL,
        )
        rail = np.stack([runs.channels[name] for name in RAIL], axis=1)
        columns = comfort_columns(run.recording.timestep, rail, skip=run.skip, names=(WEIGHTED,), errors=False)
        values.append(columns[WEIGHTED])
    return np.concatenate(values)
