"""Runs of the quarter-car family: sines, random roads and the mass on a damper, each computed once."""

import time as clock
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np

from scenarios.lumped.fixed_step_solution import fixed_step_solution
from scenarios.lumped.history import History
from scenarios.lumped.input_signals import Sampled, Sine
from scenarios.lumped.quarter_car_network import quarter_car, single_mass
from scenarios.lumped.quarter_car_parameters import QuarterCar
from scenarios.lumped.quarter_car_spec import WHEEL
from scenarios.lumped.stiff_solution import Tolerances, stiff_solution, switch_solution
from scenarios.lumped.switch import Switch
from scenarios.signals.random_road import random_road
from vehicle.arrays import Vector
from vehicle.engines.linear.first_order import FirstOrder
from vehicle.model.laws.coulomb import Coulomb
from vehicle.signals.analysis.spectra import power_spectral_density
from vehicle.signals.excitation.signal import Signal

Found = TypeVar("Found")

STEP = 1e-3
"""Sampling of road and results [s]."""

SEED = 2006
"""Seed of the first road; runs of every level share their roads."""

UPPER_EDGE_HZ = 100.0
"""Upper edge of the road's band [Hz]: twice the range of interest, so that 50 Hz has input too."""

WHOLE = 30.0
"""Length of the road of figure 2.6 [s]."""

NO_FRICTION: Mapping[str, float] = {"friction.limit": 0.0}

LEVELS = (0.0005, 0.0015, 0.005, 0.015, 0.05)
"""RMS of the roads of figure 2.14 [m]; the lowest and the highest are printed."""

LOW, HIGH = 0.001, 0.05
"""RMS of the low and the high road of figures 2.21 to D.5, and amplitude of the sines [m]."""

STEEP: Mapping[str, float] = {"friction.steepness": 1e6}
"""Smoothing of table C.1 [s/m], which holds for appendices C and D."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Family:
    """Models simulated as a batch: a composition of parts, variants of its parameters, road levels."""

    parts: Mapping[str, Any]
    variants: tuple[Mapping[str, float], ...] = ({},)
    levels: tuple[float, ...] = (LOW, HIGH)
    output: str = "body"  # Parts whose motion is stored


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Marched:
    """Motion on every road of a level with a variant, (roads, samples) each."""

    displacement: Vector  # [m]
    acceleration: Vector  # [m/s2]
    sliding_velocity: Vector  # Of the damper [m/s]


FAMILIES = {
    "no engine": Family(parts={}, levels=(*LEVELS, LOW)),
    "linear mount": Family(parts={"engine": "linear"}),
    "elastomer": Family(parts={"engine": "elastomer"}, variants=({"friction.steepness": 1e5}, STEEP)),
    "degressive": Family(
        parts={"engine": "elastomer", "degressive": True},
        variants=tuple(
            {**STEEP, "degressive.knee_velocity": knee, "degressive.low_damping": damping}
            for knee, damping in ((0.02, 15000.0), (0.01, 15000.0), (0.02, 7500.0))
        ),
    ),
    "inclined": Family(
        parts={"engine": "elastomer", "degressive": True, "strut": True},
        variants=tuple(
            {**STEEP, "strut.angle": angle, "strut.longitudinal_damping": damping}
            for angle, damping in ((4.2, 550.0), (8.4, 550.0), (4.2, 0.0), (4.2, 1100.0))
        ),
    ),
    "small mass": Family(
        parts={"small_mass": True},
        variants=tuple({"friction.steepness": steepness} for steepness in (1e6, 1e5, 1e4)),
        levels=(LEVELS[0], HIGH),
        output="small_mass",
    ),
}
"""Elastomer: the smoothing of chapter 2, then of appendix C with constant damping. Degressive: as printed, half
the knee velocity, half the damping below it. Inclined strut: two angles, then two more longitudinal dampings at
4.2 deg; at 0 deg the model is the degressive one. Small mass: the three smoothings of table B.1."""

CONSTANT, DEGRESSIVE = ("elastomer", 1), ("degressive", 0)
"""Family and variant of appendix C."""


@dataclass(slots=True)
class Runs:
    """All simulations of the figures and the table; every run is computed once and cached."""

    car: QuarterCar
    quick: bool
    seconds: float = 0.0  # Time spent solving [s]
    _done: dict[str, Any] = field(default_factory=dict)

    @property
    def duration(self) -> float:
        """Return the duration of a random road [s]; short roads have the same velocity PSD."""
        return 6.0 if self.quick else WHOLE

    @property
    def resolution(self) -> float:
        """Return the distance of the lines for the search of resonances: three windows per record [Hz]."""
        return 3.0 / self.duration

    def model(self, vary: Mapping[str, Any] | None = None, **parts: Any) -> FirstOrder:
        """Return the equations of a composition of parts."""
        return quarter_car(self.car, vary=vary, **parts).first_order()

    def road_signal(self, rms: float, *, seed: int = SEED, step: float = STEP) -> Signal:
        """Return a random road at uniform steps [s], periodic in the record.

        Args:
            rms: of the displacement in 30 s [m]. A shorter road has the same velocity PSD, and so a smaller RMS: that
                of a road from f1 to f2 goes with sqrt(1 / f1 - 1 / f2).
            seed: of the phases.
            step: [s].
        """
        shortest = 1.0 / UPPER_EDGE_HZ
        return random_road(
            rms=rms * np.sqrt((self.duration - shortest) / (WHOLE - shortest)),
            seed=seed,
            wheel=WHEEL,
            duration=self.duration,
            rate=1.0 / step,
            lower_band_edge=1.0 / self.duration,
            upper_band_edge=UPPER_EDGE_HZ,
        )

    def road_profile(self, rms: float, *, seed: int = SEED, step: float = STEP) -> Vector:
        """Return the displacement of the road of a level [m]."""
        return np.asarray(self.road_signal(rms, seed=seed, step=step).displacement[WHEEL])

    def road(self, rms: float, vary: Mapping[str, Any] | None = None, **parts: Any) -> History:
        """Run the friction model on a random road of an RMS displacement [m], from rest."""
        return self._once(
            f"road {rms} {vary} {sorted(parts.items())}",
            lambda: self.road_of(self.model(vary, damper="friction", **parts), rms),
        )

    def road_of(self, model: FirstOrder, rms: float) -> History:
        """Run a model on a random road of an RMS displacement [m], from rest."""
        profile = self.road_profile(rms)
        return stiff_solution(model, STEP * np.arange(profile.size), road=Sampled(profile, STEP))

    @property
    def march_step(self) -> float:
        """Return the step of the vectorised integration [s].

        With 0.5 ms it is within 5 % of the stiff solver at every instant on roads from 1.3 mm RMS on, within 6 % on
        roads of 0.26 mm.
        """
        return STEP if self.quick else 0.5 * STEP

    @property
    def roads(self) -> int:
        """Return the number of random roads of an averaged spectrum."""
        return 4 if self.quick else 8

    def spectrum(
        self, family: str, level: float, variant: int = 0, *, resolution: float = 0.25, per_road: bool = False
    ) -> tuple[Vector, Vector]:
        """Return the mean PSD of the body acceleration over all roads, 1 to 50 Hz.

        Args:
            family: name in `FAMILIES`.
            level: RMS of the road [m].
            variant: index of the variant.
            resolution: distance of the lines [Hz].
            per_road: divide by the PSD of the road velocity; on roads of constant velocity PSD the shape is the same
                with less scatter.

        Returns:
            Lines [Hz] and PSD [(m/s2)^2/Hz], or their ratio [1/s2].
        """
        motion = self.marched(family, level, variant).acceleration
        estimate = power_spectral_density(STEP, motion, window_s=1.0 / resolution)
        inside = (estimate.frequency >= 1.0) & (estimate.frequency <= 50.0)
        frequency, density = estimate.frequency[inside], estimate.density[:, inside].mean(axis=0)
        if per_road:
            profiles = [self.road_profile(level, seed=SEED + i) for i in range(self.roads)]
            road = power_spectral_density(STEP, profiles, window_s=1.0 / resolution).density[:, inside].mean(axis=0)
            density = density / (road * (2.0 * np.pi * frequency) ** 2)
        return frequency, density

    def marched(self, family: str, level: float, variant: int = 0) -> Marched:
        """Return the motion on all roads; arguments as in `spectrum`."""
        solution: Marched = self._once(f"march {family}", lambda: self._march(FAMILIES[family]))[level, variant]
        return solution

    def _march(self, family: Family) -> dict[tuple[float, int], Marched]:
        """Simulate a family as a batch; return (level, variant) to motion."""
        cases = [(level, index) for level in family.levels for index in range(len(family.variants))]
        vary = {
            path: np.repeat([family.variants[index][path] for _, index in cases], self.roads)
            for path in family.variants[0]
        }
        profiles = {
            level: [self.road_profile(level, seed=SEED + i, step=self.march_step) for i in range(self.roads)]
            for level in family.levels
        }
        roads = np.concatenate([profiles[level] for level, _ in cases]).T
        vary["body.mass"] = np.full(roads.shape[1], self.car.body.mass)  # one model for each road
        history = fixed_step_solution(
            self.model(vary, damper="friction", **family.parts),
            self.march_step,
            roads,
            every=round(STEP / self.march_step),
        )

        def split(values: Vector) -> Vector:
            return values.T.reshape(len(cases), self.roads, -1)

        moved, accelerated = split(history.displacement(family.output)), split(history.acceleration(family.output))
        sliding = split(history.sliding_velocity())
        return {
            case: Marched(displacement=moved[i], acceleration=accelerated[i], sliding_velocity=sliding[i])
            for i, case in enumerate(cases)
        }

    def sine(
        self, amplitude: float, vary: Mapping[str, Any] | None = None, *, phase: float = 0.0, **parts: Any
    ) -> History:
        """Run the friction model on a sine of 1 Hz and an amplitude [m] for 5 s, from rest."""
        drive = Sine(amplitude=amplitude, frequency=1.0, phase=phase)
        return self._once(
            f"sine {amplitude} {phase} {vary} {sorted(parts.items())}",
            lambda: stiff_solution(
                self.model(vary, damper="friction", **parts), np.arange(0.0, 5.0 + 0.5 * STEP, STEP), road=drive
            ),
        )

    def mass_on_damper(self, kind: str) -> History:
        """Run the mass on a damper of section 2.3.2.3 for 0.5 s, with the "smooth" or the "switch" law."""
        p = self.car.mass_on_damper
        friction = Coulomb(friction_limit=p.friction_limit, smoothing=p.steepness)
        model = single_mass(mass=p.mass, damping=p.damping, friction=friction).first_order()
        times = np.linspace(0.0, 0.5, 10001)
        drive = Sine(amplitude=p.force_amplitude, frequency=p.force_frequency)
        if kind == "smooth":
            # While it sticks, velocity errors of 1e-9 m/s shift the friction by more than the inertia force.
            fine = Tolerances(relative=1e-8, displacement=1e-13, velocity=1e-11)
            return self._once("mass smooth", lambda: stiff_solution(model, times, force=drive, tolerances=fine))
        law = Switch(limit=p.friction_limit, band=p.stick_band, return_time=p.return_time)
        return self._once("mass switch", lambda: switch_solution(model, law, times, force=drive))

    def starts(self) -> tuple[Vector, Vector]:
        """Run a sine of 1 mm from 64 starts: eight phases of the road, eight body velocities up to 0.1 m/s.

        With the steep smoothing of appendix C: a damper that creeps below the limit of the friction is no stuck one.

        Returns:
            Time [s], shape (m,), and body acceleration [m/s2], shape (m, 64).
        """

        def solve() -> tuple[Vector, Vector]:
            time: Vector = self.march_step * np.arange(round(5.0 / self.march_step) + 1, dtype=np.float64)
            phase, speed = (grid.ravel() for grid in np.meshgrid(np.pi * np.arange(8) / 4.0, np.linspace(0.0, 0.1, 8)))
            model = self.model({**STEEP, "body.mass": np.full(phase.size, self.car.body.mass)}, damper="friction")
            initial = np.zeros((phase.size, model.state.shape[-1]))
            initial[:, model.velocities.start] = speed  # the body is the first coordinate
            road = LOW * np.sin(2.0 * np.pi * time[:, None] + phase)
            history = fixed_step_solution(model, self.march_step, road, initial=initial)
            return time, history.acceleration("body")

        motion: tuple[Vector, Vector] = self._once("starts", solve)
        return motion

    def _once(self, key: str, solve: Callable[[], Found]) -> Found:
        if key not in self._done:
            start = clock.perf_counter()
            self._done[key] = solve()
            self.seconds += clock.perf_counter() - start
        result: Found = self._done[key]
        return result


def rough_road(seed: int) -> Vector:
    """Return the displacement [m] of the whole high road, as in figure 2.6."""
    road = random_road(
        rms=HIGH,
        seed=seed,
        wheel=WHEEL,
        duration=WHOLE,
        rate=1.0 / STEP,
        lower_band_edge=1.0 / WHOLE,
        upper_band_edge=UPPER_EDGE_HZ,
    )
    return np.asarray(road.displacement[WHEEL])


def peak(frequency: Vector, density: Vector, band: tuple[float, float]) -> tuple[float, float]:
    """Return frequency [Hz] and height of the largest line in a band."""
    inside = (frequency >= band[0]) & (frequency <= band[1])
    index = int(np.argmax(np.where(inside, density, -np.inf)))
    return float(frequency[index]), float(density[index])


def rms(values: Vector) -> float:
    """Return the root mean square about zero."""
    return float(np.sqrt(np.mean(values**2)))
