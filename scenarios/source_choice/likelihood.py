"""Likelihood of candidates: probability of each statement of the thesis, and the most likely candidate of a half."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np

from scenarios.evidence import COMFORT_ENDS, EVIDENCE, LEVELS, USED, Evidence, slip_error
from scenarios.interval_probability import AGREES_ABOVE, interval_probability
from scenarios.signals.exact_road import ROAD_RMS
from scenarios.source_choice.candidates import NOISE_LEVELS, SLIP_VELOCITIES, Rig
from scenarios.source_choice.runs import BUMPS, ENDS, POINTS, Plan, Readings, swings
from vehicle.arrays import Vector

MISREADING = 0.01
"""Probability that a row is misread: labels come from a damaged scan, and an axis may be set by hand. It bounds
the evidence of a row against a candidate, ln(100)."""

LEVEL_NAMES = ("low", "mid", "high")

MODES = ("wheel_mode", "roll_mode", "rigid_modes", "engine_lowest", "engine_highest")


@dataclass(frozen=True, kw_only=True, slots=True)
class Candidate:
    """Candidate: a rig with inputs and slip velocity; edges are indices in the plan."""

    rig: Rig  # sides and body of the rig
    # velocity, shaker, noise, level, road: indices in `SLIP_VELOCITIES`, in the edges of the plan (shaker, noise of the
    # bump, roads) and in `NOISE_LEVELS`
    velocity: int
    shaker: int
    noise: int
    level: int
    road: int

    def text(self, plan: Plan) -> tuple[str, ...]:
        """Return slip velocity, edges of shaker, bump and road, and noise of the low bump as cells of a table."""
        return (
            f"{1e3 * SLIP_VELOCITIES[self.velocity]:g}",
            f"{plan.shaker_edges[self.shaker]:g}",
            f"{plan.shaker_edges[self.noise]:g}",
            f"{plan.road_edges[self.road]:g}",
            tuple(NOISE_LEVELS)[self.level],
        )


def probability(row: Evidence, readings: Readings, candidate: Candidate, plan: Plan) -> float:
    """Return the probability of the interval of a row, over our values and the error of the model."""
    values = _VALUES[row.key](readings, candidate, plan)
    return interval_probability(values, row.interval, error=_error(row, readings, candidate))


def log_likelihood(row: Evidence, readings: Readings, candidate: Candidate, plan: Plan) -> float:
    """Return the weighted ln(m + (1 - m) P) of a row, m the probability of a misreading."""
    chance = probability(row, readings, candidate, plan)
    return row.weight * float(np.log(MISREADING + (1.0 - MISREADING) * chance))


def values_of(readings: Readings, candidate: Candidate, plan: Plan) -> dict[str, Vector]:
    """Return key to our values of every row of the evidence."""
    return {row.key: _VALUES[row.key](readings, candidate, plan) for row in EVIDENCE}


Reader = Callable[[Readings, Candidate, Plan], Vector]


def _readers() -> Iterator[tuple[str, Reader]]:
    for key in _SHARES:
        yield key, partial(_share, key)
    yield "bump_7p5_end_of_stick", lambda readers, entry, _: np.minimum(readers.stick_end[entry.noise], 6.0)
    yield "bump_1p5_no_slip", _fastest
    for size in ("7p5", "1p5"):
        for point in (*(name for name in POINTS if not name.startswith("roof")), "roof_z"):
            for end, word in enumerate(("lowest", "highest")):
                yield f"bump_{size}_{point}_{word}", partial(_extreme, size, point, end)
    keys = [row.key for row in EVIDENCE if row.topic == "comfort"]
    for key, (name, _, source_kind, _, value, _) in zip(keys, COMFORT_ENDS, strict=True):
        yield key, partial(_comfort, list(ROAD_RMS).index(source_kind), ENDS.index((name, value)))
    for index, (figure, *_) in enumerate(LEVELS):
        yield f"level_{figure.replace('.', '_')}", partial(_level, index)
    yield "swing_2_6", lambda _, entry, plan: _swings(plan, entry.road)
    for index, name in enumerate(MODES):
        yield name, partial(_mode, index)


def _shaker_shares(level: int, side: int, readings: Readings, candidate: Candidate) -> Vector:
    return np.asarray(100.0 * readings.shaker[candidate.shaker, level, :, side, :, candidate.velocity])


def _road_shares(road: int, readings: Readings, candidate: Candidate) -> Vector:
    return np.asarray(100.0 * readings.road[candidate.road, road, :, :, candidate.velocity])


_SHARES: Mapping[str, Callable[[Readings, Candidate], Vector]] = {
    **{
        f"slip_{word}_{level}": partial(_shaker_shares, index, side)
        for index, level in enumerate(LEVEL_NAMES)
        for side, word in enumerate(("right", "left"))
    },
    **{f"slip_{name}": partial(_road_shares, index) for index, name in enumerate(ROAD_RMS)},
}
"""Key of a slip share to the shares [%] at `SLIP_STEPS` of the slip velocity of a candidate, (seeds, steps)."""


def _share(key: str, readings: Readings, candidate: Candidate, _: Plan) -> Vector:
    return np.asarray(_SHARES[key](readings, candidate)[:, 0])


def _error(row: Evidence, readings: Readings, candidate: Candidate) -> float:
    """Return the error of the model in the unit of a row; for a slip share the error of the candidate's shares."""
    if row.key not in _SHARES:
        return row.error
    _, less, more = _SHARES[row.key](readings, candidate).T
    return slip_error(less, more)


def _fastest(readings: Readings, candidate: Candidate, _: Plan) -> Vector:
    return np.asarray(
        readings.fastest[candidate.noise, :, _bump("1p5", candidate)] / SLIP_VELOCITIES[candidate.velocity]
    )


def _extreme(size: str, point: str, end: int, readings: Readings, candidate: Candidate, _: Plan) -> Vector:
    return np.asarray(readings.extremes[candidate.noise, :, _bump(size, candidate), _point(point, candidate), end])


def _comfort(road: int, end: int, readings: Readings, candidate: Candidate, _: Plan) -> Vector:
    return np.asarray(100.0 * readings.comfort[candidate.road, road, :, end])


def _level(figure: int, readings: Readings, candidate: Candidate, _: Plan) -> Vector:
    return np.asarray(readings.levels[candidate.road, figure])


def _mode(index: int, readings: Readings, candidate: Candidate, _: Plan) -> Vector:
    return readings.modes[index : index + 1]


@lru_cache(maxsize=32)
def _swings(plan: Plan, road: int) -> Vector:
    return swings(plan.road_edges[road], plan)


def _bump(size: str, candidate: Candidate) -> int:
    scaled = size == "1p5" and candidate.level == 1
    return list(BUMPS).index(f"{size} scaled" if scaled else size)


def _point(name: str, candidate: Candidate) -> int:
    side = "roof_left_z" if candidate.rig.roof == "-y" else "roof_right_z"
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


def table(readings: Readings, rig: Rig, plan: Plan, keys: frozenset[str] = USED) -> Vector:
    """Return the log-likelihood of every candidate with a rig, axes as `NUMBERS`."""
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
            candidate = Candidate(rig=rig, **dict(zip(NUMBERS, at, strict=True)))
            part[at] = log_likelihood(row, readings, candidate, plan)
        total += part
    return total


def best(tables: Mapping[Rig, Vector], *, own_noise: bool = False) -> list[tuple[float, Candidate]]:
    """Return the best candidate of each rig, the most likely first."""
    candidates = []
    for rig, rig_table in tables.items():
        free = (
            np.ones(rig_table.shape, dtype=bool)
            if own_noise
            else np.eye(rig_table.shape[1], dtype=bool)[None, :, :, None, None]
        )
        at = np.unravel_index(int(np.argmax(np.where(free, rig_table, -np.inf))), rig_table.shape)
        numbers = dict(zip(NUMBERS, (int(index) for index in at), strict=True))
        candidates.append((float(rig_table[at]), Candidate(rig=rig, **numbers)))
    return sorted(candidates, key=lambda pair: -pair[0])


BARE_MENTION = 1.0
"""Difference of log-likelihoods that is not worth more than a bare mention: Kass and Raftery, Bayes factors, J. Am.
Stat. Assoc. 90 (1995), section 3.2."""

PRINTED_SHARES = {"slip_right_low": 0.0, "slip_right_mid": 3.9, "slip_right_high": 21.8, "slip_left_low": 0.0,
                  "slip_left_mid": 0.0, "slip_left_high": 0.0, "slip_smooth": 31.3, "slip_rough": 79.4}  # fmt: skip
"""Slip shares [%] of table 3.2, section 3.3.1 and chapter 4."""


def shipped_numbers(readings: Readings, rig: Rig, plan: Plan, whole: Vector) -> Candidate:
    """Return the candidate of a rig to be shipped, among the candidates with nearly the best likelihood.

    Slip velocity and edges have nearly equal likelihoods along a line. Of these candidates those with the median slip
    velocity are selected, and of these the candidate with the smallest RMS deviation of the eight slip shares.
    """
    tied = np.eye(whole.shape[1], dtype=bool)[None, :, :, None, None] & (
        whole > best({rig: whole})[0][0] - BARE_MENTION
    )
    candidates_at = np.argwhere(tied)
    velocity = sorted(set(candidates_at[:, 0]))[(len(set(candidates_at[:, 0])) - 1) // 2]
    sets = [
        Candidate(rig=rig, **dict(zip(NUMBERS, map(int, at), strict=True))) for at in candidates_at if at[0] == velocity
    ]

    def deviation(candidate: Candidate) -> float:
        values = values_of(readings, candidate, plan)
        return float(np.sqrt(np.mean([(np.mean(values[key]) - share) ** 2 for key, share in PRINTED_SHARES.items()])))

    return min(sets, key=deviation)


def probabilities(readings: Readings, candidate: Candidate, plan: Plan) -> dict[str, float]:
    """Return key to probability of every row."""
    return {row.key: probability(row, readings, candidate, plan) for row in EVIDENCE}


def agreement(by_row: Mapping[str, float], keys: Sequence[str]) -> float:
    """Return the share of agreeing rows [-]."""
    return float(np.mean([by_row[key] >= AGREES_ABOVE for key in keys]))


def jackknife(judged: Sequence[tuple[Readings, Candidate]], plan: Plan) -> float:
    """Return the standard error of the difference of two log-likelihoods over the seeds of the inputs.

    Both candidates have the same seeds; jackknife over the seeds: e^2 = (n - 1) / n sum over i of (d_i - mean of d)^2.
    """
    differences = []
    for seed in range(plan.seeds):
        sums = []
        for readings, without_seed in judged:
            kept = readings.without(seed)
            sums.append(sum(log_likelihood(row, kept, without_seed, plan) for row in EVIDENCE if row.key in USED))
        differences.append(sums[0] - sums[1])
    return float(np.sqrt((plan.seeds - 1) * np.var(differences)))
