"""Result of a comparison, with its tables for the console, CSV and JSON, largest errors first."""

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from vehicle.digits import finite, number
from vehicle.errors import ConfigurationError
from vehicle.runs.comparison.frf_comparison import FrfComparison, Signatures
from vehicle.runs.comparison.record_comparison import RecordComparison
from vehicle.signals.formats.csv_table import table_text
from vehicle.signals.records.counterpart import PARTS
from vehicle.signals.records.group_delays import GroupDelay
from vehicle.wording import choose_from

SHOWN = 12
"""Maximum number of rows of a table on the console."""

BAND_HEADS = ("error", "magnitude_db", "magnitude_rms_db", "phase_deg", "weight", "lines")
"""Columns of the error of a response in a band."""

HEADS = (
    *("kind", "channel", "low_hz", "high_hz", *BAND_HEADS, "frac", "scaled_frac", "frequency_scale", "rms_ratio"),
    *("correlation", "iso18571", "corridor", "phase", "magnitude", "slope", "lag_s", "drift_ppm", "window_s", "plate"),
)
"""Columns of `compare.csv`."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Comparison:
    """Comparison of a measurement with a run: responses and time histories, largest errors first.

    Attributes:
        measured, simulated: names of the measurement and the run.
        responses: comparisons of frequency responses.
        signatures: agreement of all responses together.
        records: comparisons of time histories.
        delays: delay of each group of channels; the first is the reference of the others.
        notices: notices on the measurement.
        tyres: state of the tyres in the run, "standing" or "rolling at ..."; empty if unknown.
    """

    measured: str
    simulated: str
    responses: tuple[FrfComparison, ...] = ()
    signatures: Signatures | None = None
    records: tuple[RecordComparison, ...] = ()
    delays: tuple[GroupDelay, ...] = ()
    notices: tuple[str, ...] = ()
    tyres: str = ""

    @property
    def plates(self) -> tuple[str, ...]:
        """Return the inputs of the responses, as "plate_fr", without unknown inputs."""
        return tuple(dict.fromkeys(item.plate for item in self.responses if item.plate))

    def label(self, channel: str, plate: str) -> str:
        """Return the name of a response in tables and figures: the output, with its plate if there are several."""
        return f"{channel}/{plate}" if plate and len(self.plates) > 1 else channel

    @property
    def run(self) -> str:
        """Name of the run and state of its tyres."""
        return self.simulated + (f" (tyres {self.tyres})" if self.tyres else "")

    def __repr__(self) -> str:
        """Return what is compared in a line."""
        counts = f"{len(self.responses)} responses, {len(self.records)} time histories"
        return f"Comparison({self.measured} with {self.run}: {counts})"

    def __str__(self) -> str:
        """Return the tables of the console."""
        return self.text()

    def plot(self, name: str | None = None, ax: Any = None) -> Any:
        """Plot measured and simulated data of one output point.

        Args:
            name: as "compare_frf_seat_rail", "compare_time_seat_rail" or "compare_signatures"; the first by default.
            ax: array of axes, as many as the picture has; a new figure by default.

        Returns:
            The axes.

        Raises:
            ConfigurationError: there is no picture of this name; the message lists all.
        """
        from vehicle.drawing.rendering.open_axes import open_axes, plain
        from vehicle.runs.comparison.named_pictures import pictures_of

        pictures = pictures_of(self)
        wanted = next(iter(pictures)) if name is None else name
        if wanted not in pictures:
            raise ConfigurationError(f"no picture {wanted!r}{choose_from(wanted, pictures)}")
        picture = pictures[wanted]
        title = f"{self.measured} and {self.run}"
        axes = open_axes(ax, picture.size, picture.rows, picture.columns, title=title, **picture.options)
        picture.draw(axes)
        return plain(axes)

    def rows(self) -> list[dict[str, Any]]:
        """Return the rows of the table: bands of responses by falling error, then time histories by rising rating."""
        bands = [
            {
                "kind": "frf",
                "channel": item.channel,
                "plate": item.plate or None,
                "low_hz": band.low,
                "high_hz": band.high,
                **{name: getattr(band, name) for name in BAND_HEADS},
                "frac": item.frac,
                "scaled_frac": item.scaled_frac,
                "frequency_scale": item.scale,
            }
            for item in self.responses
            for band in item.bands
        ]
        times = [
            {
                "kind": "time",
                "channel": item.channel,
                "rms_ratio": item.rms_ratio,
                "correlation": item.correlation,
                "iso18571": item.rating.overall,
                **{name: getattr(item.rating, name) for name in ("corridor", "phase", "magnitude", "slope")},
                "lag_s": item.lag,
                "drift_ppm": PARTS * item.drift,
                "window_s": item.rating.window,
            }
            for item in self.records
        ]
        return [
            *sorted(bands, key=lambda row: -row["error"]),
            *sorted(times, key=lambda row: row["iso18571"]),
        ]

    def summary(self) -> dict[str, Any]:
        """Return the content of `compare.json`."""
        agreement = None
        if self.signatures is not None:
            agreement = {
                "channels": self.signatures.channels,
                "csac_mean": _mean(self.signatures.csac),
                "csf_mean": _mean(self.signatures.csf),
                "lines": [
                    [_plain(value) for value in line]
                    for line in zip(self.signatures.frequency, self.signatures.csac, self.signatures.csf, strict=True)
                ],
            }
        return {
            "measured": self.measured,
            "simulated": self.simulated,
            "tyre": self.tyres or None,
            "responses": [
                {
                    "channel": item.channel,
                    "plate": item.plate or None,
                    "frac": _plain(item.frac),
                    "scaled_frac": _plain(item.scaled_frac),
                    "frequency_scale": item.scale,
                    "bands": [asdict(band) for band in item.bands],
                }
                for item in self.responses
            ],
            "signatures": agreement,
            "records": [
                {
                    "channel": item.channel,
                    "unit": item.unit,
                    "rms": item.rms,
                    "rms_ratio": _plain(item.rms_ratio),
                    "correlation": _plain(item.correlation),
                    "iso18571": {**asdict(item.rating), "overall": item.rating.overall, "grade": item.rating.grade},
                    "rated_rate_hz": 1.0 / float(item.time[1] - item.time[0]),
                    "lag_s": _plain(item.lag),
                    "lag_error_s": _plain(item.clock.shift_error) if item.clock else None,
                    "drift_ppm": _plain(PARTS * item.drift),
                    "drift_error_ppm": _plain(PARTS * item.clock.drift_error) if item.clock else None,
                    "aligned_correlation": item.clock.correlation if item.clock else None,
                    "repeats_after_s": item.clock.period if item.clock else None,
                }
                for item in self.records
            ],
            "delays": [each.summary() for each in self.delays],
            "table": [{name: _plain(value) for name, value in row.items()} for row in self.rows()],
            "notices": list(self.notices),
        }

    def csv(self) -> str:
        """Return the content of `compare.csv`; columns of the other kind of row are empty."""
        header = (
            f"measured {self.measured}, simulated {self.run}; worst first; plate: input of the response; "
            "error: root of the mean of |ln(simulated / measured)|^2 weighted by both coherences; magnitude positive "
            "where simulated is larger; "
            "iso18571: ISO/TS 18571, 0 to 1, mean over windows of window_s at the full rate, weighted by their RMS; "
            "lag: positive where simulated is late, in the middle of the record; drift: its change per time"
        )
        return table_text([HEADS, *([_cell(row.get(name)) for name in HEADS] for row in self.rows())], [header])

    def text(self) -> str:
        """Return the tables for the console."""
        rows = self.rows()
        bands, times = ([row for row in rows if row["kind"] == section] for section in ("frf", "time"))
        lines = [f"measured {self.measured}, simulated {self.run}"]
        if bands:
            worst, named = bands[0], [self.label(row["channel"], row["plate"] or "") for row in bands]
            width = max(28, 2 + max(len(name) for name in named[:SHOWN]))
            lines.append(
                f"largest error of a response: {named[0]}, {worst['low_hz']:g} to {worst['high_hz']:g} Hz: "
                f"{worst['magnitude_db']:+.1f} dB, {worst['phase_deg']:.0f} deg"
            )
            lines.append(
                f"{'channel':<{width}}{'band [Hz]':>12}{'error':>8}{'mean [dB]':>11}{'RMS [dB]':>10}{'phase [deg]':>13}"
                f"{'weight':>8}{'FRAC':>8}{'scaled':>8}{'at':>8}"
            )
            lines += [
                f"{name:<{width}}{_band(row):>12}{row['error']:>8.3f}{row['magnitude_db']:>+11.2f}"
                f"{row['magnitude_rms_db']:>10.2f}{row['phase_deg']:>13.1f}{row['weight']:>8.2f}{row['frac']:>8.4f}"
                f"{row['scaled_frac']:>8.4f}{row['frequency_scale']:>8.3f}"
                for name, row in zip(named, bands[:SHOWN], strict=False)
            ]
            lines += _left(bands)
        if self.signatures is not None:
            lines.append(
                f"{self.signatures.channels} responses together: CSAC {_mean(self.signatures.csac):.3f} (shape), CSF "
                f"{_mean(self.signatures.csf):.3f} (shape and amplitude), means over the lines"
            )
        if times:
            lines.append(
                f"{'channel':<28}{'RMS ratio':>11}{'correlation':>13}{'ISO 18571':>11}{'corridor':>10}{'phase':>8}"
                f"{'magnitude':>11}{'slope':>8}{'lag [ms]':>10}{'drift [ppm]':>13}"
            )
            lines += [
                f"{row['channel']:<28}{_told(row['rms_ratio']):>11}{_told(row['correlation']):>13}{row['iso18571']:>11.3f}"
                f"{row['corridor']:>10.3f}{row['phase']:>8.3f}{row['magnitude']:>11.3f}{row['slope']:>8.3f}"
                f"{_told(1e3 * row['lag_s']):>10}{_told(row['drift_ppm'], 0):>13}"
                for row in times[:SHOWN]
            ]
            lines += _left(times)
            windows = sorted({(record.rating.window, record.rating.windows) for record in self.records})
            lines.append(
                "ISO 18571: mean over "
                + ", ".join(f"{count} window{'s' if count > 1 else ''} of {length:.4g} s" for length, count in windows)
                + " at the full rate, weighted by their RMS"
            )
        delays = [
            f"{each.group} {1e3 * each.delay:.3f} +- {number(1e3 * each.error, 1)} ms after the {each.against}"
            + (f" ({1e3 * each.taken_out:.5g} ms removed)" if each.taken_out else "")
            + (f", in {each.agreeing} of {each.channels} channels" if each.agreeing < each.channels else "")
            for each in self.delays
            if math.isfinite(each.delay)
        ]
        lines += [f"delays: {'; '.join(delays)}"] if delays else []
        return "\n".join([*lines, *(f"notice: {text}" for text in self.notices)])


def _told(value: float, digits: int = 3) -> str:
    """Return a number as text; a dash for NaN, as the RMS ratio of a channel at rest."""
    return f"{value:.{digits}f}" if math.isfinite(value) else "-"


def _band(row: dict[str, Any]) -> str:
    return f"{row['low_hz']:g}-{row['high_hz']:g}"


def _left(rows: Sequence[object]) -> list[str]:
    return [f"and {len(rows) - SHOWN} more in compare.csv"] if len(rows) > SHOWN else []


def _mean(values: Any) -> float:
    finite = values[np.isfinite(values)]
    return float(finite.mean()) if finite.size else 0.0


def _plain(value: Any) -> Any:
    """Return a value for JSON; None for NaN and infinity."""
    if isinstance(value, (float, np.floating)):
        return finite(float(value))
    return value


def _cell(value: Any) -> str:
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return ""
    return f"{value:.9g}" if isinstance(value, float) else str(value)
