"""How probable each statement of the source is for a candidate, and the candidate that makes one half most probable."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np
import numpy.typing as npt

from scenarios.evidence import COMFORT_ENDS, EVIDENCE, LEVELS, USED, Evidence
from scenarios.interval_probability import AGREES_ABOVE, interval_probability
from scenarios.source_choice.candidates import NOISE_LEVELS, SLIP_VELOCITIES, Rig
from scenarios.source_choice.runs import BUMPS, ENDS, POINTS, Plan, Readings, swings
from vehicle.signals.excitation.exact_road import ROAD_RMS

Vector = npt.NDArray[np.float64]

MISREADING = 0.01
"""Chance that a row is not what we read: labels come from a damaged scan, and an axis can be set by hand. It bounds
what one row can say against a candidate, ln(100)."""

LEVEL_NAMES = ("low", "mid", "high")

MODES = ("wheel_mode", "roll_mode", "rigid_modes", "engine_lowest", "engine_highest")


@dataclass(frozen=True, kw_only=True, slots=True)
class Candidate:
    """A rig and what drives it; edges as numbers of the plan.

    Attributes:
        rig: sides and body.
        velocity, shaker, noise, level, road: places in `SLIP_VELOCITIES`, in the edges of the plan (shaker, noise of
            the bump, roads) and in `NOISE_LEVELS`.
    """

    rig: Rig
    velocity: int
    shaker: int
    noise: int
    level: int
    road: int

    def text(self, plan: Plan) -> tuple[str, ...]:
        """Slip velocity, edges of shaker, bump and road, noise of the low bump, as cells."""
        return (
            f"{1e3 * SLIP_VELOCITIES[self.velocity]:g}",
            f"{plan.shaker_edges[self.shaker]:g}",
            f"{plan.shaker_edges[self.noise]:g}",
            f"{plan.road_edges[self.road]:g}",
            tuple(NOISE_LEVELS)[self.level],
        )


def probability(row: Evidence, values: npt.ArrayLike) -> float:
    """Probability of the interval of a row, over the seeds of the input and the error of the model.

    Args:
        row: what is printed.
        values: ours, one for each seed or stretch, (n,).
    """
    return interval_probability(values, row.interval, error=row.error)


def log_likelihood(row: Evidence, values: npt.ArrayLike) -> float:
    """Weighted ln(m + (1 - m) P) of a row, m the chance of a misreading."""
    return row.weight * float(np.log(MISREADING + (1.0 - MISREADING) * probability(row, values)))


def values_of(found: Readings, one: Candidate, plan: Plan) -> dict[str, Vector]:
    """Our values of every row of the evidence."""
    return {row.key: _VALUES[row.key](found, one, plan) for row in EVIDENCE}


Reader = Callable[[Readings, Candidate, Plan], Vector]


def _readers() -> Iterator[tuple[str, Reader]]:
    for place, level in enumerate(LEVEL_NAMES):
        for side, word in enumerate(("right", "left")):
            yield f"slip_{word}_{level}", partial(_shaker_share, place, side)
    for place, name in enumerate(ROAD_RMS):
        yield f"slip_{name}", partial(_road_share, place)
    yield "bump_7p5_end_of_stick", lambda found, one, _: np.minimum(found.stick_end[one.noise], 6.0)
    yield "bump_1p5_no_slip", _fastest
    for size in ("7p5", "1p5"):
        for point in (*(name for name in POINTS if not name.startswith("roof")), "roof_z"):
            for end, word in enumerate(("lowest", "highest")):
                yield f"bump_{size}_{point}_{word}", partial(_extreme, size, point, end)
    keys = [row.key for row in EVIDENCE if row.topic == "comfort"]
    for key, (name, _, kind, _, value, _) in zip(keys, COMFORT_ENDS, strict=True):
        yield key, partial(_comfort, list(ROAD_RMS).index(kind), ENDS.index((name, value)))
    for place, (figure, *_) in enumerate(LEVELS):
        yield f"level_{figure.replace('.', '_')}", partial(_level, place)
    yield "swing_2_6", lambda _, one, plan: _swings(plan, one.road)
    for place, name in enumerate(MODES):
        yield name, partial(_mode, place)


def _shaker_share(level: int, side: int, found: Readings, one: Candidate, _: Plan) -> Vector:
    return np.asarray(100.0 * found.shaker[one.shaker, level, :, side, one.velocity])


def _road_share(road: int, found: Readings, one: Candidate, _: Plan) -> Vector:
    return np.asarray(100.0 * found.road[one.road, road, :, one.velocity])


def _fastest(found: Readings, one: Candidate, _: Plan) -> Vector:
    return np.asarray(found.fastest[one.noise, :, _bump("1p5", one)] / SLIP_VELOCITIES[one.velocity])


def _extreme(size: str, point: str, end: int, found: Readings, one: Candidate, _: Plan) -> Vector:
    return np.asarray(found.extremes[one.noise, :, _bump(size, one), _point(point, one), end])


def _comfort(road: int, end: int, found: Readings, one: Candidate, _: Plan) -> Vector:
    return np.asarray(100.0 * found.comfort[one.road, road, :, end])


def _level(figure: int, found: Readings, one: Candidate, _: Plan) -> Vector:
    return np.asarray(found.levels[one.road, figure])


def _mode(place: int, found: Readings, one: Candidate, _: Plan) -> Vector:
    return found.modes[place : place + 1]


@lru_cache(maxsize=32)
def _swings(plan: Plan, road: int) -> Vector:
    return swings(plan.road_edges[road], plan)


def _bump(size: str, one: Candidate) -> int:
    scaled = size == "1p5" and one.level == 1
    return list(BUMPS).index(f"{size} scaled" if scaled else size)


def _point(name: str, one: Candidate) -> int:
    side = "roof_left_z" if one.rig.roof == "-y" else "roof_right_z"
    return POINTS.index(side if name == "roof_z" else name)


_VALUES: dict[str, Reader] = dict(_readers())

AXES: Mapping[str, tuple[str, ...]] = {
    "shaker slip": ("velocity", "shaker"),
    "no slip": ("velocity", "shaker", "noise", "level"),
    "road slip": ("velocity", "road"),
    "bump 7.5 mm": ("noise",),
    "bump 1.5 mm": ("noise", "level"),
    "comfort": ("road",),
    "level": ("road",),
    "mode": (),
}
"""Topic of evidence to the numbers of a candidate that its rows depend on."""

NUMBERS = ("velocity", "shaker", "noise", "level", "road")


def table(found: Readings, rig: Rig, plan: Plan, keys: frozenset[str] = USED) -> Vector:
    """Log-likelihood of every candidate with a rig, axes as `NUMBERS`.

    Args:
        found: what was read off the runs of the rig.
        rig: its sides and body.
        plan: the inputs.
        keys: rows that count.
    """
    sizes = dict(
        zip(
            NUMBERS,
            (
                len(SLIP_VELOCITIES),
                len(plan.shaker_edges),
                len(plan.shaker_edges),
                len(NOISE_LEVELS),
                len(plan.road_edges),
            ),
            strict=True,
        )
    )
    total = np.zeros(tuple(sizes.values()))
    for row in EVIDENCE:
        if row.key not in keys:
            continue
        axes = AXES[row.topic]
        if row.key.startswith("slip_"):
            axes = tuple(name for name in axes if name not in ("noise", "level"))
        elif row.topic == "no slip":
            axes = tuple(name for name in axes if name != "shaker")
        part = np.empty([sizes[name] if name in axes else 1 for name in NUMBERS])
        for at in np.ndindex(part.shape):
            one = Candidate(rig=rig, **dict(zip(NUMBERS, at, strict=True)))
            part[at] = log_likelihood(row, _VALUES[row.key](found, one, plan))
        total += part
    return total


def best(tables: Mapping[Rig, Vector], *, own_noise: bool = False) -> list[tuple[float, Candidate]]:
    """The best candidate of each rig, the most likely first.

    Args:
        tables: rig to log-likelihoods, axes as `NUMBERS`.
        own_noise: whether the noise of the bump may have another edge than the random inputs of the same shaker.
    """
    found = []
    for rig, one in tables.items():
        free = np.ones(one.shape, dtype=bool) if own_noise else np.eye(one.shape[1], dtype=bool)[None, :, :, None, None]
        at = np.unravel_index(int(np.argmax(np.where(free, one, -np.inf))), one.shape)
        numbers = dict(zip(NUMBERS, (int(place) for place in at), strict=True))
        found.append((float(one[at]), Candidate(rig=rig, **numbers)))
    return sorted(found, key=lambda pair: -pair[0])


BARE_MENTION = 1.0
"""Difference of log-likelihoods that is not worth more than a bare mention: Kass and Raftery, Bayes factors, J. Am.
Stat. Assoc. 90 (1995), section 3.2."""

PRINTED_SHARES = {"slip_right_low": 0.0, "slip_right_mid": 3.9, "slip_right_high": 21.8, "slip_left_low": 0.0,
                  "slip_left_mid": 0.0, "slip_left_high": 0.0, "slip_smooth": 31.3, "slip_rough": 79.4}  # fmt: skip
"""Slip shares [%] of table 3.2, section 3.3.1 and chapter 4."""


def shipped_numbers(found: Readings, rig: Rig, plan: Plan, whole: Vector) -> Candidate:
    """The numbers of a rig to ship among those that are tied with its best ones.

    Slip velocity and edges are tied along a line. Of the tied sets those with the median slip velocity are taken, and
    of these that whose eight slip shares deviate least (RMS) from the printed ones.

    Args:
        found: what was read off the runs of the rig.
        rig: its sides and body.
        plan: the inputs.
        whole: its log-likelihoods, axes as `NUMBERS`.
    """
    tied = np.eye(whole.shape[1], dtype=bool)[None, :, :, None, None] & (
        whole > best({rig: whole})[0][0] - BARE_MENTION
    )
    places = np.argwhere(tied)
    velocity = sorted(set(places[:, 0]))[(len(set(places[:, 0])) - 1) // 2]
    sets = [Candidate(rig=rig, **dict(zip(NUMBERS, map(int, at), strict=True))) for at in places if at[0] == velocity]

    def deviation(one: Candidate) -> float:
        values = values_of(found, one, plan)
        return float(np.sqrt(np.mean([(np.mean(values[key]) - share) ** 2 for key, share in PRINTED_SHARES.items()])))

    return min(sets, key=deviation)


def probabilities(found: Readings, one: Candidate, plan: Plan) -> dict[str, float]:
    """Probability of every row."""
    values = values_of(found, one, plan)
    return {row.key: probability(row, values[row.key]) for row in EVIDENCE}


def agreement(given: Mapping[str, float], keys: Sequence[str]) -> float:
    """Share of rows that agree [-]."""
    return float(np.mean([given[key] >= AGREES_ABOVE for key in keys]))


def jackknife(found: Sequence[tuple[Readings, Candidate]], plan: Plan) -> float:
    """Standard error of the difference of the log-likelihoods of two candidates over the seeds of the inputs.

    Both meet the same seeds; each is left out once: e^2 = (n - 1) / n sum over i of (d_i - mean of d)^2.

    Args:
        found: both candidates with their readings.
        plan: the inputs.
    """
    differences = []
    for seed in range(plan.seeds):
        sums = []
        for readings, one in found:
            values = values_of(readings.without(seed), one, plan)
            sums.append(sum(log_likelihood(row, values[row.key]) for row in EVIDENCE if row.key in USED))
        differences.append(sums[0] - sums[1])
    return float(np.sqrt((plan.seeds - 1) * np.var(differences)))
