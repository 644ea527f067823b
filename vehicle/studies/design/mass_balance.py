"""Body of a new car: what is left of the stated car after all other parts.

    m_b = m - sum m_i,   m_b c_b = m c - sum m_i c_i,   I_b = I - sum (I_i + m_i (|r_i|^2 1 - r_i r_i'))   about c,

and I_b is then taken about c_b. The parts (axles, engine, seats) come from the compiled model.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import rounded
from vehicle.engines.simulation.car_masses import car_masses
from vehicle.engines.simulation.car_model import CarModel
from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.model.parameters.whole_body import put
from vehicle.runs.car import Car
from vehicle.runs.car.inertia_survey import SURVEY, AxleGeometry
from vehicle.runs.car.usual_figures import usual_ranges
from vehicle.studies.design.moved_points import Sources
from vehicle.studies.design.stated_numbers import StatedNumbers, option
from vehicle.studies.design.template_car import TemplateCar

LIGHTEST_BODY = 100.0
"""Smallest mass of a body [kg], see `TrimmedBody`."""
LEAST_SHARE = 0.2
"""Smallest load of a stated axle as a share of the kerb mass: half of the smallest usual one, on the front axle."""
ROUND_OFF = 1e-9
"""Product of inertia, as a share of the sum of the moments, that counts as zero."""
LOAD_AGREES = 1e-6
"""Deviation of an axle load, as a share of it, at which the position of the centre of gravity is settled."""


def kerb_model(table: Mapping[str, Any], template: TemplateCar) -> CarModel:
    """Return the compiled model of a vehicle table without its loads."""
    kerb = {key: value for key, value in table.items() if key != "load"}
    return Car(vehicle_of(kerb, template.file.parent), folder=template.file.parent).model


def axle_loads(car: CarModel, template: TemplateCar) -> dict[str, float]:
    """Return the static load of each axle [kg], by "front" and "rear"."""
    loads, g = car.static.tyre_load, car.vehicle.gravity
    return {word: sum(loads[wheel.name] for wheel in wheels) / g for word, wheels in template.wheels.items()}


def balanced(table: dict[str, Any], template: TemplateCar, stated: StatedNumbers) -> tuple[dict[str, Any], Sources]:
    """Return a vehicle table with a body of the stated masses, and the sources of the numbers of this body."""
    before = car_masses(template_model := kerb_model(template.table, template))
    loads = axle_loads(template_model, template)
    share = loads["rear"] / sum(loads.values())
    mass, front, rear = kerb_mass(stated, before.mass), stated.front_axle_load, stated.rear_axle_load
    wheelbase = stated.wheelbase or template.wheelbase
    if rear is not None:
        share = rear / mass
    elif front is not None:
        share = 1.0 - front / mass
    elif stated.cog_x is not None:
        share = stated.cog_x / wheelbase
    if not 0.0 < share < 1.0:
        stated_names = [
            name for name in ("front_axle_load", "rear_axle_load", "cog_x") if getattr(stated, name) is not None
        ]
        raise ConfigurationError(
            f"{', '.join(map(option, stated_names))}: the centre of gravity would be {share * wheelbase:.3f} m "
            f"behind the front axle but must be inside the wheelbase of {wheelbase:g} m (kerb mass {mass:g} kg)"
        )
    for name, load in (("front_axle_load", front), ("rear_axle_load", rear)):
        if load is not None and load < LEAST_SHARE * mass:
            low, high = usual_ranges()["load on the front axle [%]"]["all"]
            percent = f"; for {load:g} % of the kerb mass type {option(name)} {load:g}%" if load < 100.0 else ""
            raise ConfigurationError(
                f"{option(name)} {load:g} kg: is {100.0 * load / mass:.1f} % of the kerb mass of {mass:g} kg but must "
                "be "
                f"at least {100.0 * LEAST_SHARE:g} %; cars have {low} to {high} % of it on the front axle{percent}"
            )
    parts = car_masses(kerb_model(table, template), body=False)
    if mass - parts.mass < LIGHTEST_BODY:
        minimum = LIGHTEST_BODY / (1.0 - parts.mass / mass) if parts.mass < mass else parts.mass + LIGHTEST_BODY
        raise ConfigurationError(
            f"{option('kerb_mass')} {mass:g} kg: leaves {mass - parts.mass:.1f} kg for the body but must leave at "
            "least "
            f"{LIGHTEST_BODY:g} kg; axles, engine and other parts, scaled from {template.name}, weigh {parts.mass:.1f} "
            f"kg: state a kerb mass of at least {math.ceil(minimum)} kg"
        )
    radius = stated.tyre_radius or template.tyre_radius
    ground = template.wheels["front"][0].center[2] - radius
    height = before.cog[2] - template.ground if stated.cog_height is None else stated.cog_height
    cog = np.array([template.front_x + share * wheelbase, before.cog[1], ground + height])
    table, along = dict(table), cog[0]
    for _ in range(5):
        cog[0] = along
        whole = MassProperties(mass=mass, cog=cog, inertia=_inertia(template, stated, before, mass, share))
        body = whole.without(parts)
        put(table, _body_numbers(body))
        achieved = axle_loads(kerb_model(table, template), template)
        error = achieved["rear"] / sum(achieved.values()) - share
        # Tyres with a rotational stiffness support a part of the moment.
        if stated.cog_x is not None or abs(error) < LOAD_AGREES:
            break
        along -= error * wheelbase
    return table, _sources(template, stated, parts.mass, template_indices(template, before))


def kerb_mass(stated: StatedNumbers, of_template: float) -> float:
    """Return the kerb mass of a new car [kg]: stated, the sum of both axle loads, or from the template."""
    front, rear = stated.front_axle_load, stated.rear_axle_load
    if stated.kerb_mass is not None:
        return stated.kerb_mass
    return of_template if front is None or rear is None else front + rear


def template_indices(template: TemplateCar, before: MassProperties) -> tuple[float, float, float]:
    """Return the indices i_x, i_y, i_z of the template car [-]; `before`: its mass properties."""
    front = float(before.cog[0]) - template.front_x
    geometry = AxleGeometry(track=template.mean_track, front=front, rear=template.wheelbase - front)
    return geometry.indices(before.mass, np.diag(before.inertia).tolist())


def _inertia(template: TemplateCar, stated: StatedNumbers, before: MassProperties, mass: float, share: float) -> Vector:
    """Return the inertia tensor of the new car about its CoG: stated or estimated moments; products of the template.

    Of pitch and yaw, one that is stated scales the estimate of the other: both are sums of m x^2 along the car.
    """
    tracks = [stated.of_axle("track", word) or template.track(word) for word in template.wheels]
    wheelbase = stated.wheelbase or template.wheelbase
    geometry = AxleGeometry(track=float(np.mean(tracks)), front=share * wheelbase, rear=(1.0 - share) * wheelbase)
    of_survey = [index.mean for index in SURVEY.values()]
    indices = of_survey if stated.inertia == "survey" else template_indices(template, before)
    names = ("roll_inertia", "pitch_inertia", "yaw_inertia")
    roll, pitch, yaw = geometry.inertia(mass, indices)
    if (stated.pitch_inertia is None) != (stated.yaw_inertia is None):
        scale = stated.pitch_inertia / pitch if stated.pitch_inertia else (stated.yaw_inertia or yaw) / yaw
        pitch, yaw = scale * pitch, scale * yaw
    moments = [getattr(stated, name) or value for name, value in zip(names, (roll, pitch, yaw), strict=True)]
    return mass / before.mass * (before.inertia - np.diag(np.diag(before.inertia))) + np.diag(moments)


def _body_numbers(body: MassProperties) -> dict[str, Any]:
    """Return the parameters of the body by path."""
    moments = np.diag(body.inertia)
    for axis, (name, moment) in enumerate(zip(("roll", "pitch", "yaw"), moments, strict=True)):
        others = moments.sum() - moment
        if not 0.0 < moment < others:
            raise ConfigurationError(
                f"the body would have I{'xyz'[axis] * 2} = {moment:.0f} kg m2 but it must be above 0 and below the "
                f"sum of the two others ({others:.0f} kg m2): check {option(f'{name}_inertia')} and the other moments, "
                f"{option('cog_height')} and {option('kerb_mass')}"
            )
    ixx, iyy, izz = (rounded(float(value), 9) for value in moments)
    inertia = {"about": "cog", "ixx": ixx, "iyy": iyy, "izz": izz}
    for name, entry in (("ixy", (0, 1)), ("izx", (2, 0)), ("iyz", (1, 2))):
        if abs(body.inertia[entry]) > ROUND_OFF * moments.sum():
            inertia[name] = -rounded(float(body.inertia[entry]), 9)
    return {
        "body.mass": rounded(body.mass, 9),
        "body.cog": [round(float(value), 9) + 0.0 for value in body.cog],
        "body.inertia": inertia,
    }


def _sources(template: TemplateCar, stated: StatedNumbers, parts: float, of_template: Sequence[float]) -> Sources:
    """Return the sources of the numbers of the body."""
    as_template = f"template {template.name}"

    def source(*names: str, otherwise: str = as_template) -> str:
        return ", ".join(stated.stated(name) for name in names if getattr(stated, name) is not None) or otherwise

    position = source(
        "front_axle_load", "rear_axle_load", "cog_x", otherwise=f"axle loads in the ratio of {as_template}"
    )
    masses = source("kerb_mass", "front_axle_load", "rear_axle_load")
    height = source("cog_height", otherwise=f"CoG height of {as_template}")
    estimates = []
    for (word, index), template_index in zip(SURVEY.items(), of_template, strict=True):
        cars = "73 cars of NHTSA's database (SAE 1999-01-1336)"
        if stated.inertia == "survey":
            estimates.append(f"estimated: {word} = {index.mean}, mean of {cars}")
        else:
            span = f"{index.least} to {index.most} in {cars}"
            estimates.append(f"estimated: {word} = {template_index:.3f} as in {as_template}; {span}")
    sources = {
        "body.mass": f"{masses}, less {parts:.2f} kg of the other parts",
        "body.cog": f"{position}; {height}; less the other parts",
        "body.flexible": "rigid, because the mode shapes of this body are unknown",
        "body.attachment_flexibility": "rigid: likewise",
        "body.inertia.about": "about the centre of gravity",
    }
    for axis, (name, estimate) in zip(
        ("ixx", "iyy", "izz"), zip(("roll", "pitch", "yaw"), estimates, strict=True), strict=True
    ):
        other = {"pitch": "yaw", "yaw": "pitch"}.get(name, "")
        if other and getattr(stated, f"{other}_inertia") is not None:
            estimate = f"estimated: scaled with {other} inertia"
        sources[f"body.inertia.{axis}"] = f"{source(f'{name}_inertia', otherwise=estimate)}; less the other parts"
    for product in ("ixy", "izx", "iyz"):
        sources[f"body.inertia.{product}"] = (
            f"products of {as_template}, in proportion to the mass; less the other parts"
        )
    return sources
