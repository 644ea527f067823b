"""Report of a diagnosis as one HTML document, from the files in its folder."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from markupsafe import Markup

from vehicle.digits import number
from vehicle.errors import DataError
from vehicle.runs.report.markup import templates
from vehicle.runs.report.page import document, head_line
from vehicle.studies.diagnosis.car_diagnosis import percent, speed_words
from vehicle.studies.diagnosis.diagnosis_files import PICTURE, SUMMARY

fill = templates(__file__)

INTERVAL = "90 % interval"
"""Head of the columns of intervals."""


def diagnosis_page(folder: Path, *, author: str = "", project: str = "") -> str:
    """Return the report of a diagnosis.

    Args:
        folder: folder of `diagnose`, with diagnosis.json and perhaps its picture.
        author, project: names in the head of the page; may be empty.

    Raises:
        DataError: diagnosis.json is damaged or of another program.
    """
    file = folder / SUMMARY
    try:
        summary: Mapping[str, Any] = json.loads(file.read_text(encoding="utf-8"))
        sections = [
            ("Which damper is worn", "dampers", _dampers(summary, folder / PICTURE)),
            ("Road", "road", _road(summary["road"])),
            ("Modes of the driven car", "driven", _modes(summary["modes"])),
            ("Record and limits", "record", _record(summary)),
        ]
        title, subtitle = f"Dampers of {summary['car']}", f"by {summary['record']}, {number(summary['used_s'])} s used"
    except (ValueError, KeyError, TypeError) as error:
        raise DataError(f"{file}: is no complete diagnosis ({error}); run python -m vehicle diagnose again") from error
    return document(title, (subtitle, head_line(author, project)), sections)


def _part(
    sentences: Sequence[str],
    heads: Sequence[str] = (),
    rows: Sequence[Sequence[str]] = (),
    *,
    picture: Markup | str = "",
    remarks: Sequence[str] = (),
) -> Markup:
    return fill("diagnosis_part", sentences=sentences, heads=heads, rows=rows, picture=picture, remarks=remarks)


def _dampers(summary: Mapping[str, Any], picture: Path) -> Markup:
    """Return the answer, the picture and the table of unknowns."""
    drawn = Markup("")
    if picture.is_file():
        data = base64.b64encode(picture.read_bytes()).decode()
        drawn = Markup(
            '<figure><img alt="Distributions of the dampers" src="data:image/png;base64,{}"></figure>'
        ).format(data)
    heads = ("force over nominal", "median", INTERVAL, "below 60 %", "above 80 %", "")
    rows = [
        (
            row["unknown"],
            f"{row['median']:.2f}",
            f"{row['low']:.2f} to {row['high']:.2f}",
            percent(row["below_60_percent"]),
            percent(row["above_80_percent"]),
            "" if row["told"] else "undetermined",
        )
        for row in summary["unknowns"]
    ]
    return _part([summary["answer"]], heads, rows, picture=drawn)


def _road(road: Mapping[str, Any]) -> Markup:
    """Return the class and the roughness index of the road, over all and every 100 m."""
    index, (low, high) = road["iri_m_per_km"], road["density_m3"]
    sentences = [
        f"Class {road['class']} of ISO 8608 ({percent(road['probability'])} likely), G(0.1 cycles/m) "
        f"{number(1e6 * low, 2)} to {number(1e6 * high, 2)} 1e-6 m³.",
        f"International roughness index {number(index['median'], 2)} m/km, {number(index['low'], 2)} to "
        f"{number(index['high'], 2)} (90 % interval).",
    ]
    rows = [
        (f"{piece['from_m']:.0f} to {piece['to_m']:.0f}", number(piece["median"], 2),
         f"{number(piece['low'], 2)} to {number(piece['high'], 2)}")
        for piece in road["iri_every_100_m"]
    ]  # fmt: skip
    return _part(sentences, ("distance [m]", "IRI [m/km]", INTERVAL), rows)


def _modes(modes: Sequence[Mapping[str, Any]]) -> Markup:
    """Return the table of the modes."""
    heads = ("mode", "frequency [Hz]", INTERVAL, "damping ratio [%]", INTERVAL, "with good dampers")
    rows = []
    for mode in modes:
        frequency = [f"{each:#.3g}" for each in mode["frequency_hz"]]
        damping = [f"{100.0 * each:.0f}" for each in mode["damping_ratio"]]
        good = mode["good_dampers"]
        rows.append(
            (
                mode["mode"],
                frequency[0],
                f"{frequency[1]} to {frequency[2]}",
                damping[0],
                f"{damping[1]} to {damping[2]}",
                f"{good['frequency_hz']:#.3g} Hz, {100.0 * good['damping_ratio']:.0f} %",
            )
        )
    sentence = "Friction and curves of the dampers are replaced by viscous constants of the same energy on this road."
    return _part([sentence], heads, rows)


def _record(summary: Mapping[str, Any]) -> Markup:
    """Return used parts, fit, changes that narrow the intervals, limits and notices of the record."""
    left_out = ", ".join(f"{reason} {number(seconds)} s" for reason, seconds in summary["left_out_s"].items())
    sentences = [
        f"Used: {number(summary['used_s'])} s at {speed_words(summary['speed_kmh'])}; channels "
        f"{', '.join(summary['channels'])}." + (f" Left out: {left_out}." if left_out else ""),
        f"Of {summary['drives']} simulated drives {100.0 * summary['as_unlike']:.0f} % are at least as unlike the "
        "others as this record.",
        *(f"Narrower with {change}: intervals {number(ratio, 2)} times as wide."
          for change, ratio in summary["narrower_with"].items()),
        f"In no record: {summary['in_no_record']}.",
    ]  # fmt: skip
    return _part(sentences, remarks=summary["notices"])
