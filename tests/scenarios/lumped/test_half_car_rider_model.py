"""Half car with rider: matrices against Lagrange's equations, rigid motion, static loads."""

import dataclasses

import numpy as np
import pytest
import sympy

from scenarios.half_car_rider.printed_matrices import growth_rate, printed_system
from scenarios.lumped.half_car_rider_model import half_car_rider, output_points, static_tyre_load
from scenarios.lumped.half_car_rider_parameters import half_car_rider_parameters
from scenarios.lumped.network import Network, masses_of, spring_damper
from tests.validation import validated
from vehicle.errors import ConfigurationError

CAR = half_car_rider_parameters()
MODEL = half_car_rider(CAR)
ORDER = ("upper_limb", "lower_limb", "seat", "heave", "front_wheel", "rear_wheel", "pitch")
# The matrices are sums of a few products of the parameters: only rounding separates two ways of building them.
ROUNDING = 1e-12


def lagrange_matrices():
    """Derive M, C, K, Bk, Bc from Lagrange's equations of energies written by hand, not from rows."""
    t = sympy.Symbol("t")
    x3, x2, xse, xb, xuf, xur, theta = q = [sympy.Function(name)(t) for name in ORDER]
    zf, zr = z = [sympy.Function(name)(t) for name in ("zf", "zr")]
    a1, a2, a3 = (sympy.Float(v) for v in (CAR.body.front_arm, CAR.body.rear_arm, CAR.body.seat_arm))
    f, r, seat, lower, upper = CAR.front, CAR.rear, CAR.seat, CAR.lower_limb, CAR.upper_limb
    qb, xsf, xsr = xb - a3 * theta, xb - a1 * theta, xb + a2 * theta
    stretches = (
        (x3 - xse, upper.stiffness, upper.damping),
        (x2 - xse, lower.stiffness, lower.damping),
        (xse - qb, seat.stiffness, seat.damping),
        (xsf - xuf, f.suspension_stiffness, f.suspension_damping),
        (xsr - xur, r.suspension_stiffness, r.suspension_damping),
        (zf - xuf, f.tyre_stiffness, f.tyre_damping),
        (zr - xur, r.tyre_stiffness, r.tyre_damping),
    )
    masses = (upper.mass, lower.mass, seat.mass, CAR.body.mass, f.unsprung_mass, r.unsprung_mass)
    kinetic = sum(m * c.diff(t) ** 2 / 2 for m, c in zip(masses, q[:6], strict=True))
    kinetic += CAR.body.pitch_inertia * theta.diff(t) ** 2 / 2
    potential = sum(k * s**2 / 2 for s, k, _ in stretches)
    dissipation = sum(c * s.diff(t) ** 2 / 2 for s, _, c in stretches)
    rows = [sympy.expand(kinetic.diff(c.diff(t)).diff(t) + dissipation.diff(c.diff(t)) + potential.diff(c)) for c in q]

    def matrix(columns):
        return np.array([[float(row.coeff(c)) for c in columns] for row in rows])

    rates, roads = [c.diff(t) for c in q], [c.diff(t) for c in z]
    # coeff() of the plain coordinate does not pick up its derivatives: they are other atoms in sympy
    return matrix([c.diff(t, 2) for c in q]), matrix(rates), matrix(q), -matrix(z), -matrix(roads)


def test_matrices_are_those_of_lagranges_equations():
    mass, damping, stiffness, road_stiffness, road_damping = lagrange_matrices()
    assert MODEL.coordinates == ORDER
    scale = np.abs(stiffness).max()
    for name, ours, theirs in (
        ("mass", MODEL.mass, mass),
        ("damping", MODEL.damping, damping),
        ("stiffness", MODEL.stiffness, stiffness),
        ("road stiffness", MODEL.input_stiffness, road_stiffness),
        ("road damping", MODEL.input_damping, road_damping),
    ):
        validated(
            "Quarter and half cars", f"{name} matrix of the half car with rider", ours, theirs, abs=ROUNDING * scale,
            source="second derivation: Lagrange equations by sympy",
        )  # fmt: skip


def test_static_loads_balance_weight_and_moment():
    front, rear = static_tyre_load(CAR)
    limbs = CAR.seat.mass + CAR.lower_limb.mass + CAR.upper_limb.mass
    wheels = CAR.front.unsprung_mass + CAR.rear.unsprung_mass
    validated(
        "Static equilibrium", "half car with rider: sum of the wheel loads", front + rear,
        9.81 * (CAR.body.mass + limbs + wheels), rel=1e-10, unit="N", source="conservation: weight",
    )  # fmt: skip
    a1, a2, a3 = CAR.body.front_arm, CAR.body.rear_arm, CAR.body.seat_arm
    about_rear = CAR.body.mass * a2 + limbs * (a2 + a3) + CAR.front.unsprung_mass * (a1 + a2)
    # linear solve: rounding only
    validated(
        "Static equilibrium", "half car with rider: front wheel load", front, 9.81 * about_rear / (a1 + a2), rel=1e-10,
        unit="N", source="closed form: moment about the rear axle",
    )  # fmt: skip


def test_places_follow_equations_8_to_10_of_the_source():
    points = output_points(CAR)
    assert points["seat_base"] == {"heave": 1.0, "pitch": -0.65}
    assert points["front_body"] == {"heave": 1.0, "pitch": -1.35}
    assert points["rear_body"] == {"heave": 1.0, "pitch": 1.45}
    assert points["front_travel"] == {"heave": 1.0, "pitch": -1.35, "front_wheel": -1.0}


def test_printed_matrices_are_not_symmetric_and_grow():
    system = printed_system(CAR)
    for name, printed in (("C", system.damping), ("K", system.stiffness)):
        validated(
            "Published cars", f"half car with rider: printed matrix {name} is symmetric", printed, printed.T, abs=0.0,
            source="publication: half car with rider, below equation 16",
            reason="misprint: our matrices follow from the energies and are symmetric",
        )  # fmt: skip
    assert growth_rate(system) > 1.0
    assert growth_rate(MODEL) < -1.0


def test_printed_diagonals_agree_but_for_the_pitch_damping():
    validated(
        "Published cars", "half car with rider: diagonal of K", np.diag(MODEL.stiffness),
        np.diag(printed_system(CAR).stiffness), rel=1e-12, unit="N/m",
        source="publication: half car with rider, equation 16",
    )  # fmt: skip
    ours, printed = np.diag(MODEL.damping), np.diag(printed_system(CAR).damping)
    assert printed[:6] == pytest.approx(ours[:6], rel=1e-12)
    assert printed[6] == pytest.approx(-ours[6], rel=1e-12)
    validated(
        "Published cars", "half car with rider: pitch damping on the diagonal of C", ours[6], printed[6], rel=1e-12,
        unit="N m s/rad", source="publication: half car with rider, equation 16",
        reason="misprint: with the printed negative sign the equations of motion grow without bound",
    )  # fmt: skip


def test_unknown_coordinate_in_an_element_is_refused():
    with pytest.raises(ConfigurationError, match="linear form: must be one of wheel, road, not 'wheell'"):
        Network(
            coordinates=("wheel",), masses=masses_of({"wheel": 1.0}), links=(spring_damper({"wheell": 1.0}, 1.0, 0.0),)
        ).system()


def test_seat_arm_may_lie_behind_the_centre_of_gravity():
    behind = dataclasses.replace(CAR, body=dataclasses.replace(CAR.body, seat_arm=-0.65))
    assert static_tyre_load(behind)[0] < static_tyre_load(CAR)[0]
