"""Display of a car and of a run in a notebook."""

from pathlib import Path
from typing import Any

from vehicle.drawing.notebook.picture import card, frame_drawing, line_drawing


def car_label(car: Any) -> str:
    """Return the name of a car in a legend: its file and its first two changes."""
    changes = [text for text in car.overrides if not text.startswith(("driving.", "outputs."))]
    shown = [*changes[:2], *([f"{len(changes) - 2} more"] if len(changes) > 2 else [])]
    return ", ".join([str(car.vehicle.name), *shown])


def car_card(car: Any) -> str:
    """Return HTML of a `vehicle.runs.car.Car`."""
    from vehicle.drawing.rendering.wireframe import car_wireframe

    vehicle, static = car.vehicle, car.static
    rows = {
        "changes": "; ".join(car.overrides) or "none",
        "mass of the trimmed body": f"{vehicle.body.mass:g} kg",
        "tyre loads": ", ".join(f"{wheel} {load:.0f} N" for wheel, load in static.tyre_load.items()),
        "channels": f"{len(vehicle.channels)}, and {len(vehicle.load_channels)} loads",
    }
    wire = car_wireframe(car.model)
    return card(f"Car {vehicle.name}", rows, frame_drawing(wire.points, wire.lines, "seen from the right"))


def run_card(run: Any) -> str:
    """Return HTML of a `vehicle.runs.car.Run`."""
    shares = {wheel: run.slip_share(wheel) for wheel in run.car.vehicle.damped_wheels}
    rows = {
        "signal": f"{Path(run.signal.source).name}, {run.signal.duration:g} s, "
        f"RMS {1e3 * run.signal.rms(run.wheel):.3g} mm at wheel {run.wheel}",
        "car": repr(run.car),
        "tyres": run.car.vehicle.driving.words,
        "engine": run.recording.statistics.engine,
        "time in slip": ", ".join(f"{wheel} {100 * share:.1f} %" for wheel, share in shares.items()),
    }
    shown = next(name for name in ("seat_rail_acc_z", *run.recording.channels) if name in run.recording.channels)
    if "seat_rail_acc_x" in run.recording.channels:
        value = run.comfort()
        low, high = value.band
        for comfort in (value, value.cushion) if value.cushion else (value,):
            rows[f"unweighted, {comfort.point}"] = f"{comfort.unweighted.overall:.4g} m/s² RMS, {low:g} to {high:g} Hz"
            rows[f"weighted, {comfort.point}"] = (
                f"{comfort.weighted.overall:.4g} m/s² RMS (ISO 2631-1); lower is better"
            )
        if value.seat_value is not None:
            rows["SEAT value"] = f"{value.seat_value:.3g}; the seat isolates below 1"
    return card("Run", rows, line_drawing(run.time, run[shown], f"{shown} over {run.signal.duration:g} s"))
