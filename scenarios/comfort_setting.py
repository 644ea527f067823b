"""What the numbers of a comfort study were made with, and how well they are known."""

from __future__ import annotations

from scenarios.comfort_sensitivity_runs import ComfortRuns
from scenarios.road_signals import ROAD_EDGE_HZ, ROAD_RMS, velocity_density
from vehicle.excitation.slip_set import sets_text


def setting(comfort: ComfortRuns) -> list[str]:
    """Paragraphs for `results.md`."""
    runs, found = comfort.runs, {road: comfort.point(0.0, (), road, ()) for road in ROAD_RMS}
    car = "the car of source 1" if runs.vehicle is None else runs.vehicle.name
    changes = f", changed: {', '.join(runs.overrides)}" if runs.overrides else ""
    levels = ", ".join(
        f"{road} {1e3 * rms:g} mm RMS (velocity PSD {velocity_density(rms):.3g} (m/s)²/Hz)"
        for road, rms in ROAD_RMS.items()
    )
    errors = ", ".join(
        f"{road} {100.0 * one.comfort_error / one.comfort:.2f} % over the records, "
        f"{100.0 * one.gaussian_error / one.comfort:.2f} % as a Gaussian road"
        for road, one in found.items()
    )
    return [
        f"Made with {car}{changes}; engine {comfort.engine}. Roads: {levels}, {ROAD_EDGE_HZ:g} to 50 Hz, lines of "
        f"exact level and random phase, {comfort.records.text()}; every car runs on the same records.",
        f"Standard error of the comfort value of the nominal car: {errors} (1/2 sqrt(int S² df / T) / int S df, which "
        "would hold if the amplitudes of the lines were random too). ± behind a number is one standard error over the "
        "records; that of a ratio is over the ratios of the single records.",
        f"Slip shares: time with the right damper above {1e3 * runs.car().vehicle.damper.slip_velocity:g} mm/s, above "
        "1 mm/s, and the left one. Lowest load: of the tyre on the shaker.",
        sets_text(),
        "The tyre is a linear spring, as in the source: where its load is negative it pulls.",
    ]
