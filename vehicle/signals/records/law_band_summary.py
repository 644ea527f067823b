"""Part of `summary.json` on the band of fitted dampers: comfort and stick with the softest and the firmest dampers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from vehicle.digits import number, rounded
from vehicle.names import point_words, side_of, slip_words
from vehicle.stored import Stored

if TYPE_CHECKING:
    from vehicle.signals.records.run_summary import RunSummary


@dataclass(frozen=True, kw_only=True, slots=True)
class EdgeSummary(Stored):
    """Run with all banded dampers at an edge of their band.

    `weighted_rms` [m/s2] by output point, `slip_share` [-] by wheel, `energy_residual` of the input work [-], null for
    the reduced engine.
    """

    weighted_rms: dict[str, float]
    slip_share: dict[str, float]
    energy_residual: float | None


@dataclass(frozen=True, kw_only=True, slots=True)
class LawBandSummary(Stored):
    """Paths of the dampers with a band, and the runs with their softest and with their firmest laws."""

    dampers: list[str]
    soft: EdgeSummary
    firm: EdgeSummary


def band_rows(summary: RunSummary) -> list[tuple[str, ...]]:
    """Return words, and values with the softest, the fitted and the firmest laws; empty without `law_band`."""
    band = summary.law_band
    if band is None:
        return []
    rows = [
        (f"{point_words(point)}, weighted acceleration [m/s²]", *(number(each, 4) for each in values))
        for point, values in _comfort(summary).items()
    ]
    shares = {wheel: (band.soft.slip_share[wheel], share, band.firm.slip_share[wheel])
              for wheel, share in summary.slip_shares.items()}  # fmt: skip
    return rows + [
        (f"{side_of(wheel, shares)} damper, share of the time that it sticks [%]",
         *(number(100.0 * (1.0 - share), 3) for share in each))
        for wheel, each in shares.items()
    ]  # fmt: skip


def _comfort(summary: RunSummary) -> dict[str, tuple[float, float, float]]:
    """Return the weighted RMS of seat rail, and of a seat, with the softest, the fitted and the firmest laws [m/s2]."""
    assert summary.law_band is not None
    soft, firm = summary.law_band.soft.weighted_rms, summary.law_band.firm.weighted_rms
    points = {name: value for name, value in summary.comfort.items() if name != "seat" or summary.seat_value}
    return {point: (soft[point], value.weighted, firm[point]) for point, value in points.items()}


def band_sentence(summary: RunSummary) -> str:
    """Return the changes of comfort and stick at both edges in a sentence without a full stop; empty without a band."""
    band = summary.law_band
    if band is None:
        return ""
    effects, shares, edges = [], summary.slip_shares, (band.soft.slip_share, band.firm.slip_share)
    if (values := _comfort(summary).get("seat_rail")) is not None and values[1] > 0.0:
        soft, firm = (f"{rounded(100.0 * (each / values[1] - 1.0), 2):+.10g} %" for each in (values[0], values[2]))
        effects.append(f"the weighted acceleration of the seat rail by {soft} and {firm}")
    if shares:
        wheel = max(shares, key=lambda name: max(abs(edge[name] - shares[name]) for edge in edges))
        soft, law, firm = (number(100.0 * (1.0 - each[wheel]), 3) for each in (edges[0], shares, edges[1]))
        limit = slip_words({wheel: summary.slip_limits[wheel]}, [wheel])
        effects.append(
            f"the time that the {side_of(wheel, shares)} damper sticks (|v| < {limit} mm/s) from {law} % to {soft} and "
            f"{firm} %"
        )
    return (
        f"the softest and the firmest law that the tests of {' and '.join(band.dampers)} leave open change "
        f"{', and '.join(effects)}"
    )
