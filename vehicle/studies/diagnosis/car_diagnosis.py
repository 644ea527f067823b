"""Diagnosis of a car: posterior distributions of its unknowns in sentences, in a table and in JSON."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from vehicle.digits import aligned, number
from vehicle.names import side_of
from vehicle.signals.analysis.road_level import CLASS_WIDTH, CLASSES
from vehicle.signals.formats.csv_table import table_text
from vehicle.studies.diagnosis.drive_record import Parts
from vehicle.studies.diagnosis.driven_modes import DrivenMode
from vehicle.studies.diagnosis.learned import Posterior
from vehicle.studies.diagnosis.roughness import RoadPiece

WORN, GOOD = 0.6, 0.8
"""Factors of the force of a damper [-]: below the first it counts as worn, above the second as good."""

SURE, TOGETHER = 0.9, 0.95
"""Probability from which on a statement on a damper is made, and of the statement on all others."""

TELLS = 0.85
"""Ratio of posterior to prior standard deviation above which an unknown counts as undetermined."""

INTERVAL = (0.05, 0.95)
"""Ends of the printed intervals: 90 % lie inside."""

ENDS = ("median", "low", "high")
"""Names of the median and of the ends of an interval in JSON."""

LIKELIEST = 0.99
"""Largest printed probability: a thousand drives resolve no more."""

GROUPS = {"dampers": "damper ", "tyres": "tyre ", "mounts": "mount ", "springs": "spring ", "friction": "friction "}
"""Groups of unknowns, and the first word of their names."""

CANNOT = (
    "the side of a damper, if all sensors are in the middle of the car; forces far from 0.13 m/s; faults outside the "
    "simulated cars, for example play in a joint or an unbalanced wheel"
)
"""Limits of every record, for the text."""


class RoadClass(NamedTuple):
    """Most likely class of ISO 8608, its probability, and the 90 % interval of G(0.1 cycles/m) [m3]."""

    letter: str
    probability: float
    low: float
    high: float


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class CarDiagnosis:
    """Diagnosis of a car by a record of a drive.

    Attributes:
        record: name of the record.
        car: name of the car.
        channels: its accelerations.
        parts: parts of the record that are used.
        unknowns: name to its distribution; of the road too, "level" as log10 of G(0.1 cycles/m) in m3.
        wheels: wheels with a damper.
        unlikely: share of the simulated drives left out that are as far from the others as the record.
        widened: factor of all intervals, since the record is unlike the simulated drives.
        shown: groups of unknowns for the table, of `GROUPS`.
        drives: number of simulated drives.
        more: change of the test that narrows the intervals of the dampers, and the ratio of widths [-].
        modes: modes of the driven car.
        road_pieces: roughness index of the road in pieces of 100 m, by distance; none for an unknown speed.
        notices: messages on the record.
    """

    record: str
    car: str
    channels: tuple[str, ...]
    parts: Parts
    unknowns: Mapping[str, Posterior]
    wheels: tuple[str, ...]
    unlikely: float
    widened: float
    shown: tuple[str, ...]
    drives: int
    more: Mapping[str, float]
    modes: tuple[DrivenMode, ...] = ()
    road_pieces: tuple[RoadPiece, ...] = ()
    notices: tuple[str, ...] = ()

    def damper(self, wheel: str) -> Posterior:
        """Return the force of the damper of a wheel over nominal."""
        return self.unknowns[f"damper {wheel}"]

    def worn(self, wheel: str) -> float:
        """Return the probability that the damper of a wheel has less than `WORN` of its nominal force."""
        return self.damper(wheel).below(WORN)

    @property
    def road(self) -> RoadClass:
        """Return the class of the road."""
        level = self.unknowns["level"]
        shares = {
            letter: level.below(np.log10(CLASS_WIDTH * mean)) - level.below(np.log10(mean / CLASS_WIDTH))
            for letter, mean in CLASSES.items()
        }
        letter = max(shares, key=shares.__getitem__)
        low, high = (10.0 ** level.quantile(end) for end in INTERVAL)
        return RoadClass(letter, shares[letter], low, high)

    @property
    def roughness(self) -> tuple[float, float, float]:
        """Return median and 90 % interval of the international roughness index of the road [m/km]."""
        middle, low, high = (10.0**each for each in _quantiles(self.unknowns["roughness"]))
        return middle, low, high

    @property
    def answer(self) -> str:
        """Return a sentence for each worn, undecided or undetermined damper, and a sentence for the other dampers."""
        healthy = [wheel for wheel in self.wheels if self.worn(wheel) <= 1.0 - SURE]
        unclear = [wheel for wheel in self.wheels if wheel not in healthy and not told(self.damper(wheel))]
        below = [wheel for wheel in self.wheels if wheel not in (*healthy, *unclear)]
        sentences = []
        for wheel in sorted(below, key=self.worn, reverse=True):
            undecided = "" if self.worn(wheel) >= SURE else "undecided, "
            sentences.append(
                f"{self._title(wheel)}: {undecided}{percent(self.worn(wheel))} likely below {100.0 * WORN:.0f} % of "
                f"nominal ({_interval(self.damper(wheel))})."
            )
        if unclear:
            sentences.append(f"{', '.join(map(self._title, unclear))}: undetermined, this record does not suffice.")
        if healthy:
            sentences.append(self._others(healthy))
        return " ".join(sentences)

    def _others(self, healthy: Sequence[str]) -> str:
        """Return the sentence on good dampers, with the highest limit that all of these dampers exceed."""
        who = "All dampers" if len(healthy) == len(self.wheels) else "The others"
        if len(healthy) == 1:
            who = self._title(healthy[0])
        limits = np.linspace(WORN, 1.0, 41)
        # Union bound: the probability of any event is at most the sum of all probabilities.
        missed = np.array([sum(self.damper(wheel).below(limit) for wheel in healthy) for limit in limits])
        certain = limits[missed <= 1.0 - TOGETHER]
        limit, share = (certain[-1], TOGETHER) if certain.size else (WORN, 1.0 - missed[0])
        verb = "is" if len(healthy) == 1 else "are"
        return f"{who} {verb} above {100.0 * limit:.0f} % ({percent(float(share))} likely)."

    def _title(self, wheel: str) -> str:
        """Return the damper of a wheel in words: "Rear left damper"."""
        return f"{side_of(wheel, self.wheels).capitalize()} damper"

    @property
    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each shown unknown: median, interval, probabilities, and True if it is determined."""
        first_words = tuple(GROUPS[group] for group in self.shown)
        rows = []
        for name, posterior in self.unknowns.items():
            if name.startswith(first_words):
                middle, low, high = _quantiles(posterior)
                row = {"unknown": name, "median": middle, "low": low, "high": high}
                row |= {"below_60_percent": posterior.below(WORN), "above_80_percent": 1.0 - posterior.below(GOOD)}
                rows.append(row | {"told": told(posterior)})
        return rows

    @property
    def csv(self) -> str:
        """Return the table as CSV."""
        rows = self.rows
        cells = [[f"{value:.4f}" if isinstance(value, float) else str(value) for value in row.values()] for row in rows]
        return table_text([[*rows[0]], *cells])

    @property
    def roughness_csv(self) -> str:
        """Return the roughness index of every 100 m as CSV."""
        heads = ("from [m]", "to [m]", "from [s]", "to [s]", "IRI [m/km]", "low [m/km]", "high [m/km]")
        rows = [
            (piece.start[0], piece.end[0], piece.start[1], piece.end[1], *_quantiles(piece.index))
            for piece in self.road_pieces
        ]
        return table_text([heads, *rows], digits=4)

    def summary(self) -> dict[str, Any]:
        """Return all results as an object of JSON."""
        road = self.road
        return {
            "answer": self.answer,
            "record": self.record,
            "car": self.car,
            "channels": list(self.channels),
            "used_s": self.parts.seconds,
            "left_out_s": dict(self.parts.left_out),
            "speed_kmh": [3.6 * speed for speed in self.parts.speeds],
            "drives": self.drives,
            "as_unlike": self.unlikely,
            "widened": self.widened,
            "unknowns": self.rows,
            "road": {
                "class": road.letter,
                "probability": road.probability,
                "density_m3": [road.low, road.high],
                "iri_m_per_km": dict(zip(ENDS, self.roughness, strict=True)),
                "iri_every_100_m": [
                    {"from_m": piece.start[0], "to_m": piece.end[0]}
                    | dict(zip(ENDS, _quantiles(piece.index), strict=True))
                    for piece in self.road_pieces
                ],
            },
            "modes": [
                {
                    "mode": self._mode_title(mode),
                    "frequency_hz": [10.0**each for each in _quantiles(mode.frequency)],
                    "damping_ratio": list(_quantiles(mode.damping)),
                    "good_dampers": {"frequency_hz": mode.nominal.frequency, "damping_ratio": mode.nominal.damping},
                }
                for mode in self.modes
            ],
            "narrower_with": dict(self.more),
            "in_no_record": CANNOT,
            "notices": list(self.notices),
        }

    def __repr__(self) -> str:
        """Return car, record and the sentences."""
        return f"CarDiagnosis({self.car} by {self.record}: {self.answer})"

    def __str__(self) -> str:
        """Return sentences, table, road class, used parts and fit."""
        parts, road = self.parts, self.road
        speed = speed_words([3.6 * speed for speed in parts.speeds])
        left_out = ", ".join(f"{reason} {number(seconds)} s" for reason, seconds in parts.left_out.items())
        more = "; ".join(f"{change}: intervals {number(ratio, 2)} times as wide" for change, ratio in self.more.items())
        widened = f"; intervals are {number(self.widened, 2)} times as wide for that" if self.widened > 1.0 else ""
        lines = [
            self.answer,
            "",
            *self._table(),
            "",
            *self._mode_table(),
            "",
            f"road: class {road.letter} ({percent(road.probability)} likely), G(0.1 cycles/m) "
            f"{number(1e6 * road.low, 2)} to {number(1e6 * road.high, 2)} 1e-6 m3; {self._roughness_words()}",
            f"used: {number(parts.seconds)} s of {self.record} at {speed} in {len(parts.spans)} "
            f"part{'s' * (len(parts.spans) > 1)}{f' (left out: {left_out})' if left_out else ''}, "
            f"{len(self.channels)} channels",
            f"fit: of {self.drives} simulated drives of {self.car} {100.0 * self.unlikely:.0f} % are at least as "
            f"unlike the others as this record{widened}",
            *([f"narrower with: {more}"] if more else []),
            f"in no record: {CANNOT}",
        ]
        return "\n".join(lines)

    def _table(self) -> list[str]:
        """Return the table as lines."""
        cells = [("over nominal", "median", "90 % interval", "below 60 %", "above 80 %", "")]
        for row in self.rows:
            shares = (row["below_60_percent"], row["above_80_percent"])
            damper = row["unknown"].startswith("damper ")
            cells.append(
                (
                    row["unknown"],
                    f"{row['median']:.2f}",
                    f"{row['low']:.2f} to {row['high']:.2f}",
                    *(percent(share) if damper else "" for share in shares),
                    "" if row["told"] else "undetermined",
                )
            )
        return aligned(cells)

    def _roughness_words(self) -> str:
        """Return the roughness index in words, with the range of its pieces."""
        middle, low, high = (number(each, 2) for each in self.roughness)
        pieces = [piece.index.quantile(0.5) for piece in self.road_pieces]
        over = f", {number(min(pieces), 2)} to {number(max(pieces), 2)} over 100 m" if len(pieces) > 1 else ""
        return f"IRI {middle} m/km ({low} to {high}){over}"

    def _mode_title(self, mode: DrivenMode) -> str:
        """Return the name of a mode: "body heave", "rear left wheel hop"."""
        hop, _, wheel = mode.motion.partition(" ")
        return f"{side_of(wheel, self.wheels)} wheel hop" if hop == "hop" else mode.motion

    def _mode_table(self) -> list[str]:
        """Return the table of the modes as lines."""
        heads = ("mode", "frequency [Hz]", "90 % interval", "damping [%]", "90 % interval", "with good dampers")
        cells = [heads]
        for mode in self.modes:
            (f, f_low, f_high), (d, d_low, d_high) = _quantiles(mode.frequency), _quantiles(mode.damping)
            frequency = [f"{10.0**each:#.3g}" for each in (f, f_low, f_high)]
            damping = [f"{100.0 * each:.0f}" for each in (d, d_low, d_high)]
            nominal = f"{mode.nominal.frequency:#.3g} Hz, {100.0 * mode.nominal.damping:.0f} %"
            middle, interval = frequency[0], f"{frequency[1]} to {frequency[2]}"
            cells.append(
                (self._mode_title(mode), middle, interval, damping[0], f"{damping[1]} to {damping[2]}", nominal)
            )
        return aligned(cells)


def told(posterior: Posterior) -> bool:
    """Return True if the posterior is narrower than the prior."""
    return posterior.deviation <= TELLS * posterior.prior


def speed_words(speeds: Sequence[float]) -> str:
    """Return the least and the greatest speed [km/h] as text, a single number if they are nearly equal."""
    slow, fast = speeds
    return f"{slow:.0f} km/h" if fast - slow < 1.0 else f"{slow:.0f} to {fast:.0f} km/h"


def percent(share: float) -> str:
    """Return a probability in percent, at most `LIKELIEST`."""
    return f"{100.0 * min(max(share, 1.0 - LIKELIEST), LIKELIEST):.0f} %"


def _quantiles(posterior: Posterior) -> tuple[float, float, float]:
    """Return the median and both ends of the 90 % interval."""
    return posterior.quantile(0.5), posterior.quantile(INTERVAL[0]), posterior.quantile(INTERVAL[1])


def _interval(posterior: Posterior) -> str:
    _, low, high = _quantiles(posterior)
    return f"{low:.2f} to {high:.2f}"
