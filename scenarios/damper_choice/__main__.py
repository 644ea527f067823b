"""Choice of dampers for road holding: figures 2 to 13 of the source, and the trade-off on roads of ISO 8608.

python -m scenarios.damper_choice [--output DIR] [--parameters FILE.toml] [--quick] [--force] [--refit]
"""

import math
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from scenarios.claims import Findings, markdown
from scenarios.damper_choice.claims import (
    city_claim,
    determinant_claim,
    half_optimum_claims,
    half_response_claims,
    quarter_optimum_claims,
    quarter_response_claims,
    rate_claims,
    ratio_claims,
)
from scenarios.damper_choice.damper_curves import compare_curves, curve_claims, curve_figure
from scenarios.damper_choice.figures import iteration_figure, optimum_figure, response_figures, trade_off_figure
from scenarios.damper_choice.fit import (
    HALF_FREE,
    QUARTER_FREE,
    fit_half_car,
    fit_quarter_car,
    half_car_values,
    quarter_car_values,
)
from scenarios.damper_choice.other_vehicles import fitted_to_wheels
from scenarios.damper_choice.runs import (
    MEASURES,
    RoadHolding,
    TradeOff,
    complete_car_quarter,
    half_car_measure,
    half_responses,
    quarter_responses,
    road_holding,
    trade_off,
)
from scenarios.lumped.damper_choice import FITTED, DamperChoiceParameters, ExponentialRoad, damper_choice_parameters
from scenarios.study import VERTICAL_TYRES, LumpedSettings, lumped_study
from vehicle.model.parameters.toml_file import as_table
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.settings import setting as declared

TITLE = "Choice of dampers for road holding (Mehmood, Khan and Mehmood 2014)"

HEAVY_INDEX = 0.5
"""Least J / (Ms a b) of the comparison fit of --refit [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class DamperSettings(LumpedSettings):
    """Settings of the study of dampers."""

    refit: bool = declared("repeat the fit of the parameters and report it", False, action="store_true")


def study(parameters: DamperChoiceParameters, folder: Path, settings: DamperSettings) -> Findings:
    """Run everything, draw the figures into the folder, and compare."""
    damping = [float(c) for c in np.linspace(1000.0, 8000.0, 15 if settings.quick else 57)]
    lines = np.arange(0.01, 15.0, 0.01)
    wide = np.arange(0.02, 30.0, 0.02)
    quarter, half = quarter_responses(parameters, lines), half_responses(parameters, wide)
    roads = {"highway": parameters.highway, "city": parameters.city}
    holding = {
        road: {measure: road_holding(parameters, measure, density, damping) for measure in MEASURES}
        for road, density in roads.items()
    }
    printed = half_car_measure(parameters, "printed", parameters.highway)
    cars = {"fitted quarter car": parameters.quarter_car, "complete car": complete_car_quarter(load_vehicle())}
    wide_damping = [float(c) for c in np.geomspace(200.0, 10000.0, 25 if settings.quick else 81)]
    curves = compare_curves(parameters, duration=6.0 if settings.quick else 30.0)
    trades = {name: trade_off(car, wide_damping) for name, car in cars.items()}

    claims = [
        *ratio_claims(parameters),
        *quarter_response_claims(parameters, lines, quarter),
        *quarter_optimum_claims(parameters, holding["highway"]["printed"], "printed"),
        *quarter_optimum_claims(parameters, holding["highway"]["physical"], "physical"),
        *half_response_claims(parameters, wide, half, None if settings.quick else fitted_to_wheels(parameters)),
        *half_optimum_claims(holding["highway"]["printed"], "printed"),
        *rate_claims(parameters, holding["highway"]["printed"], printed(4000.0, 4000.0), printed(3250.0, 3250.0)),
        *half_optimum_claims(holding["highway"]["physical"], "physical"),
        *curve_claims(curves),
        city_claim(holding["highway"], holding["city"]),
        determinant_claim(parameters),
    ]
    curve_figure(folder, curves)
    response_figures(folder, lines, quarter, wide, half)
    for road, measures in holding.items():
        optimum_figure(folder, measures, road)
    iteration_figure(folder, holding["highway"]["printed"], printed)
    for name, trade in trades.items():
        trade_off_figure(folder / f"trade_off_{name.replace(' ', '_')}.png", trade, name.capitalize())
    notes = [_optimum_table(holding, roads), _trade_note(trades), _fit_note(parameters)]
    data: dict[str, Any] = {
        "optima": {road: {m: _optimum_data(result) for m, result in row.items()} for road, row in holding.items()},
        "trade_off": {name: _trade_data(trade) for name, trade in trades.items()},
        "parameters": as_table(parameters),
        "complete_car_quarter": as_table(cars["complete car"]),
    }
    if settings.refit:
        data["refit"] = _refit(parameters)
        notes.append(_refit_note(data["refit"]))
    return Findings(title=TITLE, claims=claims, tyres=VERTICAL_TYRES, unjudged=None, notes=notes, data=data)


def _optimum_table(road_holding: Mapping[str, Mapping[str, RoadHolding]], roads: Mapping[str, ExponentialRoad]) -> str:
    heads = ("road", "measure", "quarter car", "half car, equal: front", "rear", "iteration: front, rear")
    rows = []
    for road, measures in road_holding.items():
        for name, result in measures.items():
            last, (front, rear, values) = result.continuous[-1], result.joint
            optima = (f"{best.damping:.0f}" for best in (result.quarter_optimum, *result.equal_optima))
            iterated = (f"{last.front:.0f}, {last.rear:.0f}", "{:.3f}, {:.3f}".format(*last.fluctuation))
            joint = (f"{front:.0f}, {rear:.0f}", "{:.3f}, {:.3f}".format(*values))
            rows.append((road, name, *optima, *iterated, *joint))
    maxima_text = " and ".join(
        f"{1e3 * math.sqrt(road.roughness / road.decay):.0f} mm ({name})" for name, road in roads.items()
    )
    return "\n\n".join(
        [
            "Optimum damping [N s/m] and the measures there [-]:",
            markdown((*heads, "R front, rear", "joint optimum: front, rear", "R front, rear"), rows),
            "The iteration lets each end look after its own tyre, the joint optimum (scipy.optimize, Nelder-Mead) "
            "after the sum of both. Physical ratios above 1/3 mean that the tyres leave these roads: the printed "
            f"densities have an RMS height of {maxima_text}, so the values rank dampers and no more.",
        ]
    )


def _trade_note(trades: Mapping[str, TradeOff]) -> str:
    own_heads = "class C, own damper: tyre load, acceleration, travel"
    rows = []
    for name, trade in trades.items():
        load, acceleration, travel = (
            float(np.interp(trade.own, trade.damping, [getattr(measure, key) for measure in trade.measures["C"]]))
            for key in ("tyre_load", "acceleration", "travel")
        )
        best = f"{trade.best('acceleration'):.0f} N s/m"
        measures = f"{load:.3f}, {acceleration:.3f} m/s2, {1e3 * travel:.2f} mm"
        rows.append((name, f"{trade.own:.0f}", f"{trade.best('tyre_load'):.0f}", best, measures))
    return "\n\n".join(
        [
            "ISO 8608, 80 km/h, linear quarter car; every class doubles all values, so the optima hold for A to H:",
            markdown(("car", "own damping", "least tyre load at", "best comfort (Wk) at", own_heads), rows),
            "Complete car: front right quarter from the complete car's own parameters (share of body and engine on the "
            "wheel, spring and damper along the strut); rigid body, no friction, no mounts.",
        ]
    )


def _fit_note(parameters: DamperChoiceParameters) -> str:
    index = half_car_values(parameters.half_car)[1]
    return (
        "Vehicle parameters are not printed. Fitted (scenarios/damper_choice/fit.py lists every target): "
        f"quarter car {', '.join(QUARTER_FREE)}; half car {', '.join(HALF_FREE)}; suspension stiffnesses from the "
        f"printed damping ratios; band width. The fitted half car has J = {index:.2f} Ms a b; real cars have 0.8 to "
        "1.1: the printed influence of one end on the other asks for a body that pitches more easily than a car's. "
        f"--refit repeats the fit and also holds J at {HEAVY_INDEX} Ms a b or more, for comparison."
    )


def _refit_note(refit: Mapping[str, Any]) -> str:
    lines = ["Refit (sum of squared residuals, each over its scale):", ""]
    for name, fitted in refit.items():
        lines.append(
            f"- {name}: {fitted['cost']:.2f}; " + ", ".join(f"{k} {v:.5g}" for k, v in fitted["values"].items())
        )
    return "\n".join(lines)


def _optimum_data(result: RoadHolding) -> dict[str, Any]:
    front, rear, values = result.joint
    return {
        "quarter_car": {"damping": result.quarter_optimum.damping, "value": result.quarter_optimum.value},
        "half_car_equal": [{"damping": best.damping, "value": best.value} for best in result.equal_optima],
        "iteration_read_off": [as_table(step) for step in result.read_off],
        "iteration": [as_table(step) for step in result.continuous],
        "joint": {"front": front, "rear": rear, "values": [float(value) for value in values]},
        "damping": result.damping.tolist(),
        "quarter_car_curve": result.quarter.tolist(),
        "half_car_curves": result.equal.tolist(),
    }


def _trade_data(trade: TradeOff) -> dict[str, Any]:
    return {
        "damping": trade.damping.tolist(),
        "own_damping": trade.own,
        "classes": {road: [as_table(measure) for measure in row] for road, row in trade.measures.items()},
    }


def _refit(parameters: DamperChoiceParameters) -> dict[str, Any]:
    """Repeat the fit from the shipped values."""
    quarter, half = quarter_car_values(parameters.quarter_car), half_car_values(parameters.half_car)
    result: dict[str, Any] = {}
    road, bands = parameters.highway, parameters.bands
    heavy = np.where(np.arange(half.size) == HALF_FREE.index("inertia_index"), 1.5 * HEAVY_INDEX, half)
    for name, names, (values, residuals) in (
        ("quarter_car", QUARTER_FREE, fit_quarter_car(quarter, road, bands)),
        ("half_car", HALF_FREE, fit_half_car(half, road, bands)),
        ("half_car_heavy", HALF_FREE, fit_half_car(heavy, road, bands, least_index=HEAVY_INDEX)),
    ):
        result[name] = {
            "values": {key: float(value) for key, value in zip(names, values, strict=True)},
            "residuals": residuals.tolist(),
            "cost": float(residuals @ residuals),
        }
    return result


def load(settings: DamperSettings) -> DamperChoiceParameters:
    """Return the parameters."""
    return damper_choice_parameters(settings.parameters or FITTED)


main = lumped_study("damper_choice", load, study, DamperSettings)


if __name__ == "__main__":
    sys.exit(main())
