"""Experiment with damper curves of different coefficients in bump and rebound, at low and high velocity.

The introduction of the paper (IOSRJEN 2014) describes usual curves without a curve or a number; its models have one
coefficient for each damper. The experiment runs the fitted quarter car on the printed highway with three dampers of
equal work.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from scenarios.charts import chart, lines
from scenarios.claims import NOT_TESTABLE, Claim, placed
from scenarios.lumped.damper_choice import DamperChoiceParameters
from scenarios.lumped.fixed_step_solution import fixed_step_solution
from scenarios.lumped.half_car_rider_model import axle_links
from scenarios.lumped.network import ROAD, Network, masses_of
from scenarios.lumped.road_holding import exponential_density, quarter_car_model
from vehicle.arrays import Vector
from vehicle.drawing.rendering.figure import COLOURS
from vehicle.engines.linear.system import Slide

RATIO = 2.0
"""Of the coefficients at low and high velocity, and in rebound and bump [-]."""

STEP, SETTLED = 2e-3, 2.0
"""Step of the time integration, and decay time of the transient from rest [s]."""

SEEDS = (2014, 2015, 2016, 2017)

PICTURE = "damper_curves.png"

NAMES = ("one coefficient", "more at low velocity", "more in rebound")


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FourSlopes:
    """F = c v with a coefficient for each of bump, rebound, low and high velocity; positive in rebound.

    Arrays of one shape [N s/m], the knee [m/s]; continuous.
    """

    low_bump: Vector
    high_bump: Vector
    low_rebound: Vector
    high_rebound: Vector
    knee: float

    def force(self, velocity: npt.ArrayLike) -> Vector:
        """Return the force [N] at a velocity [m/s]."""
        v = np.asarray(velocity, dtype=float)
        inner = np.clip(v, -self.knee, self.knee)
        return np.asarray(np.where(v < 0.0, self.low_bump, self.low_rebound) * inner + self._high(v) * (v - inner))

    def slope(self, velocity: npt.ArrayLike) -> Vector:
        """Return the derivative d F / d v [N s/m]."""
        v = np.asarray(velocity, dtype=float)
        low = np.where(v < 0.0, self.low_bump, self.low_rebound)
        return np.asarray(np.where(np.abs(v) < self.knee, low, self._high(v)))

    def _high(self, v: Vector) -> Vector:
        return np.where(v < 0.0, self.high_bump, self.high_rebound)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Compared:
    """Three dampers of `NAMES` on the same roads; leading axis the damper."""

    velocity: float  # RMS of the damper with one coefficient [m/s]; the knee of the second damper
    slow_share: float  # share of its square below 3 Hz, where the body moves [-]
    curves: tuple[Vector, Vector]  # velocity [m/s], (m,), and force of each damper [N], (3, m)
    tyre_load: Vector  # RMS tyre force over static load [-], (3, seeds)
    height: Vector  # mean height of the body over its static one [m], (3, seeds)
    time: Vector  # of the first road [s], (n,)
    body: Vector  # height of the body on it [m], (3, n)


def compare_curves(parameters: DamperChoiceParameters, duration: float) -> Compared:
    """Simulate the fitted quarter car with three dampers on roads of the printed highway.

    The damper with two slopes does the same work as the one with one coefficient c at a Gaussian velocity v of the
    same RMS: E[F v] = E[v^2] E[dF/dv], so that c = ch + (cl - ch) P(|v| < knee), 68 % at a knee of one RMS. The damper
    with the larger coefficient in rebound has the mean c, and so also does the same work.
    """
    car, wheel = parameters.quarter_car, parameters.quarter_car.wheel
    c = wheel.suspension_damping
    line = 1.0 / duration
    frequency: Vector = line * np.arange(1, round(parameters.bands.highest / line) + 1, dtype=np.float64)
    density = exponential_density(parameters.highway, frequency)
    response = quarter_car_model(car).response(frequency)
    speed = np.abs(2.0 * np.pi * frequency * (response[1] - response[0])) ** 2 * density * line
    knee = float(np.sqrt(speed.sum()))
    high = c / (1.0 + (RATIO - 1.0) * 0.6826895)
    bump = 2.0 * c / (1.0 + RATIO)
    each = np.array([[c, c, c, c], [RATIO * high, high, RATIO * high, high], [bump, bump, RATIO * bump, RATIO * bump]])

    def law(coefficients: Vector) -> FourSlopes:
        low_bump, high_bump, low_rebound, high_rebound = coefficients.T
        return FourSlopes(
            low_bump=low_bump, high_bump=high_bump, low_rebound=low_rebound, high_rebound=high_rebound, knee=knee
        )

    stacked = np.repeat(each, len(SEEDS), axis=0)
    travel = {"body": 1.0, "wheel": -1.0}
    network = Network(
        coordinates=("wheel", "body"),
        masses=masses_of(
            {"wheel": np.full(len(stacked), wheel.unsprung_mass), "body": np.full(len(stacked), car.sprung_mass)}
        ),
        links=axle_links(wheel, travel, "wheel", ROAD, 0.0),
        outputs={"wheel": {"wheel": 1.0}, "body": {"body": 1.0}},
        slides=(Slide(row=travel, friction=law(stacked)),),
    )
    roads = np.array([_road(frequency, density * line, seed, duration) for seed in SEEDS])
    history = fixed_step_solution(network.first_order(), STEP, np.tile(roads, (len(NAMES), 1)).T)
    late = history.time >= SETTLED
    shape = (len(NAMES), len(SEEDS), -1)
    moved = {name: history.displacement(name)[late].T.reshape(shape) for name in ("wheel", "body")}
    force = wheel.tyre_stiffness * (roads[:, late] - moved["wheel"])
    static = (car.sprung_mass + wheel.unsprung_mass) * 9.81
    velocity = np.linspace(-3.0 * knee, 3.0 * knee, 301)
    return Compared(
        velocity=knee,
        slow_share=float(speed[frequency < 3.0].sum() / speed.sum()),
        curves=(velocity, np.array([law(forces[None]).force(velocity) for forces in each])),
        tyre_load=np.asarray(force.std(axis=-1) / static),
        height=np.asarray((moved["body"] - roads[:, late]).mean(axis=-1)),
        time=history.time[late],
        body=moved["body"][:, 0],
    )


def _road(frequency: Vector, power: Vector, seed: int, duration: float) -> Vector:
    """Return a Gaussian road [m] with a mean square for each line [m2], from 0 to the duration at `STEP`."""
    generator = np.random.default_rng(seed)
    count = round(duration / STEP)
    spectrum = np.zeros(count // 2 + 1, dtype=complex)
    normal = generator.standard_normal((2, frequency.size))
    spectrum[1 : frequency.size + 1] = 0.5 * count * np.sqrt(power) * (normal[0] + 1j * normal[1])
    road = np.fft.irfft(spectrum, count)
    return np.append(road, road[0])


def curve_claims(comparison: Compared) -> list[Claim]:
    """Return the rows on the damper curves of the introduction."""
    comparison_case, low, rebound = comparison.tyre_load.mean(axis=1)
    drop = -1e3 * (comparison.height[2] - comparison.height[0]).mean()
    why = (
        "a statement about practice: the source prints no curve, its models have one coefficient for each damper and "
        "no roll. Beside it the fitted quarter car on the printed highway, dampers of the same work, "
        f"{comparison.tyre_load.shape[1]} roads"
    )
    rows = [
        NOT_TESTABLE.statement(
            "damper curve: more damping at low velocity, where the body moves, than at high",
            "typical",
            f"twice as much below {comparison.velocity:.2f} m/s: RMS tyre force {_change(low, comparison_case)}; "
            f"below 3 Hz, where the body moves, is {comparison.slow_share:.0%} of the mean square of the damper "
            "velocity",
            False,
            why,
        ),
        NOT_TESTABLE.statement(
            "damper curve: more damping in rebound than in bump",
            "often",
            f"twice as much: RMS tyre force {_change(rebound, comparison_case)}; the body rides {drop:.1f} mm lower",
            False,
            why,
        ),
    ]
    return placed(rows, "introduction", PICTURE)


def _change(value: float, base: float) -> str:
    return f"{100.0 * (value / base - 1.0):+.1f} %"


def curve_figure(folder: Path, comparison: Compared) -> None:
    """Draw force over velocity of the three dampers, and the height of the body with each."""
    caption = (
        "Dampers of the same work on the fitted quarter car, printed highway. Left: force over velocity, rebound "
        "positive. Right: height of the body on one road; the damper with more in rebound pulls it down."
    )
    velocity, forces = comparison.curves
    shown = comparison.time <= comparison.time[0] + 4.0
    looks = list(zip(NAMES, COLOURS, ("-", "--", "-."), strict=False))
    damping = [(name, 1e-3 * force, *look) for (name, *look), force in zip(looks, forces, strict=True)]
    height = [(name, 1e3 * body[shown], *look) for (name, *look), body in zip(looks, comparison.body, strict=True)]
    with chart(folder / PICTURE, caption, columns=2, size=(11.0, 4.8)) as (left, right):
        lines(left, velocity, damping, xlabel="damper velocity [m/s]", ylabel="damper force [kN]")
        lines(right, comparison.time[shown], height, xlabel="time [s]", ylabel="height of the body [mm]")
