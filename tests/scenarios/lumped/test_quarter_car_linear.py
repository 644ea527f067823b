"""The linear models of the family: published modes, Lagrange's equations by computer algebra, exact responses."""

import dataclasses

import numpy as np
import pytest
import sympy as sp

from scenarios.lumped.network import ROAD, Link, Mass, Network
from scenarios.lumped.quarter_car_network import quarter_car
from scenarios.lumped.quarter_car_parameters import load_quarter_car
from tests.validation import validated
from vehicle.engines.linear.natural_modes import natural_modes
from vehicle.engines.linear.response import frequency_response
from vehicle.errors import ConfigurationError
from vehicle.model.laws.elastomer import Kelvin

CAR = load_quarter_car()


def model(**parts):
    return quarter_car(CAR, **parts).first_order()


def test_published_modes():
    # Printed parameters to 0.01 Hz, half of it for rounding; the slip modes are undamped frequencies |lambda|/2 pi.
    by_hand = "closed form: frequencies of the printed parameters to 0.01 Hz, by hand"
    about = "publication: Bommer 2006, section 2.2.4, printed with 'about'"
    for damper, rounded in (("slip", [2.0, 12.5]), ("stick", [4.8, 25.0])):
        validated(
            "Published cars", f"quarter car, frequencies with the damper in {damper}",
            natural_modes(model(damper=damper)).frequency, np.array(rounded), rel=0.05, unit="Hz", source=about,
        )  # fmt: skip
    validated(
        "Quarter and half cars", "frequencies of the quarter car of Bommer 2006 with a sliding damper",
        natural_modes(model(damper="slip")).frequency, np.array([1.99, 12.86]), abs=0.005, unit="Hz", source=by_hand,
    )  # fmt: skip
    stick = natural_modes(model(damper="stick"))
    validated(
        "Quarter and half cars", "frequencies of the quarter car of Bommer 2006 with a stuck damper", stick.frequency,
        np.array([4.78, 25.13]), abs=0.005, unit="Hz", source=by_hand,
    )  # fmt: skip
    assert stick.damping_ratio == pytest.approx([0.0, 0.0], abs=1e-12)


def test_the_slip_model_follows_2_1_written_as_dynamic_stiffness():
    # Independent of states: the series of Kd and D has the complex stiffness Kd D s/(Kd + D s).
    frequency = np.linspace(0.1, 50.0, 60)
    s = 2j * np.pi * frequency
    z = 3e4 + 7e5 * 1500 * s / (7e5 + 1500 * s)
    determinant = (180 * s**2 + z) * (45 * s**2 + z + 2.5e5) - z**2
    body, wheel = z * 2.5e5 / determinant, (180 * s**2 + z) * 2.5e5 / determinant
    slip = model(damper="slip")
    # Fifteen digits less what the largest condition of the matrices (1e4) costs.
    for place, exact in (("body", body), ("wheel", wheel)):
        validated(
            "Quarter and half cars", f"sliding quarter car, FRF of the {place}",
            frequency_response(slip, frequency, place), exact, rel=1e-10, unit="m/m",
            source="closed form: dynamic stiffness with Kd D s / (Kd + D s)",
        )  # fmt: skip
    assert frequency_response(slip, frequency, "wheel", "acceleration") == pytest.approx(s**2 * wheel, rel=1e-10)


@pytest.mark.parametrize("engine", ["linear", "elastomer"])
def test_engine_on_its_mount_alone(engine):
    # A body of 1e9 kg stands still, so the engine vibrates alone; published: 12.7 Hz and 15 % on the linear mount.
    heavy = quarter_car(CAR, damper="stick", engine=engine, vary={"body.mass": 1e9})
    modes = natural_modes(heavy.first_order())
    engine_share = np.abs(modes.shape[:, heavy.coordinates.index("engine")])
    mode = int(np.argmax(engine_share - np.abs(modes.shape[:, heavy.coordinates.index("wheel")])))
    if engine == "linear":
        printed = "publication: Bommer 2006, section 2.3.3.1"
        validated(
            "Published cars", "engine on its linear mount, frequency", modes.frequency[mode], 12.7, abs=0.05, unit="Hz",
            source=printed,
        )  # fmt: skip
        validated(
            "Quarter and half cars", "engine on its linear mount, frequency", modes.frequency[mode], 12.73, abs=0.005,
            unit="Hz", source="closed form: sqrt(k / m) / (2 pi) of the printed parameters",
        )  # fmt: skip
        validated(
            "Published cars", "engine on its linear mount, damping ratio", modes.damping_ratio[mode], 0.15, abs=0.0005,
            source=printed,
        )  # fmt: skip
    else:
        # The pole of s^2 Me + K(s) = 0 itself.
        s = np.roots([125 * 6057, 125 * 3.4e5, (8e5 + 3.4e5) * 6057, 8e5 * 3.4e5])
        pole = s[np.argmax(s.imag)]
        # the body moves by 125/1e9
        validated(
            "Quarter and half cars", "engine on its elastomer mount, frequency", modes.frequency[mode],
            abs(pole) / 2 / np.pi, rel=1e-6, unit="Hz", source="closed form: root of s^2 m + K(s) = 0",
        )  # fmt: skip
        assert modes.damping_ratio[mode] == pytest.approx(-pole.real / abs(pole), rel=1e-5)


@pytest.mark.parametrize("small_mass", [False, True])
@pytest.mark.parametrize("engine", ["none", "linear", "elastomer"])
@pytest.mark.parametrize("strut", [False, True])
def test_the_friction_model_follows_lagrange(strut, engine, small_mass):
    """Derive equations 2.6, 2.7, 2.13 and D.28 to D.34 from T, V, the dissipation and the sliding force, by sympy."""
    t = sp.Symbol("t")
    yb, yt, u, xt, ye, ys, w, f2, fr = (sp.Function(n)(t) for n in ("yb", "yt", "u", "xt", "ye", "ys", "w", "f2", "fr"))
    a = sp.rad(sp.Rational(42, 10)) if strut else sp.Integer(0)
    if not strut:
        xt = sp.Integer(0)
    # Positions: the damper mass hangs on the body, displaced by u along the strut axis (sin a, cos a).
    damper = sp.Matrix([u * sp.sin(a), yb + u * sp.cos(a)])
    wheel = sp.Matrix([xt, yt])
    axis = sp.Matrix([sp.sin(a), sp.cos(a)])
    spring = (sp.Matrix([0, yb]) - wheel).dot(axis)
    sliding = (damper - wheel).dot(axis)
    kinetic = (
        180 * yb.diff(t) ** 2 / 2 + 45 * wheel.diff(t).dot(wheel.diff(t)) / 2 + damper.diff(t).dot(damper.diff(t)) / 2
    )
    potential = 3e4 * spring**2 / 2 + 7e5 * u**2 / 2 + 2.5e5 * (yt - w) ** 2 / 2
    dissipation = sp.Rational(1500, 2) * sliding.diff(t) ** 2
    power = -fr * sliding  # virtual work of the friction force
    coordinates, names = [yb, yt], ["body", "wheel"]
    if strut:
        potential += 7e5 * xt**2 / 2
        dissipation += sp.Rational(550, 2) * xt.diff(t) ** 2
        coordinates.append(xt)
        names.append("longitudinal")
    coordinates.append(u)
    names.append("mount")
    if engine != "none":
        kinetic += 125 * ye.diff(t) ** 2 / 2
        potential += 8e5 * (ye - yb) ** 2 / 2
        coordinates.append(ye)
        names.append("engine")
        if engine == "linear":
            dissipation += sp.Rational(3000, 2) * (ye - yb).diff(t) ** 2
        else:
            power += -f2 * (ye - yb)
    if small_mass:
        kinetic += ys.diff(t) ** 2 / 2
        potential += (2 * sp.pi * 50) ** 2 * (ys - yb) ** 2 / 2
        coordinates.append(ys)
        names.append("small_mass")
    equations = [
        kinetic.diff(q.diff(t)).diff(t)
        - kinetic.diff(q)
        + potential.diff(q)
        + dissipation.diff(q.diff(t))
        - power.diff(q)
        for q in coordinates
    ]
    accelerations = [q.diff(t, 2) for q in coordinates]
    mass, right = sp.linear_eq_to_matrix(equations, accelerations)
    inputs = [*coordinates, *[q.diff(t) for q in coordinates], f2, w, fr]
    plain = sp.symbols(f"z:{len(inputs)}")
    # Rates first: a coordinate is part of its own derivative.
    order = sorted(range(len(inputs)), key=lambda i: not isinstance(inputs[i], sp.Derivative))
    right = right.subs([(inputs[i], plain[i]) for i in order])
    lagrange = np.linalg.solve(np.array(mass.evalf(), float), np.array(right.jacobian(plain).evalf(), float))

    ours = model(damper="friction", strut=strut, engine=engine, small_mass=small_mass)
    assert ours.system.coordinates == tuple(names)
    n = len(names)
    branch = ours.state[n : 2 * n, 2 * n :] if engine == "elastomer" else np.zeros((n, 1))
    assembled = np.hstack([ours.state[n : 2 * n, : 2 * n], branch, ours.input[n : 2 * n], -ours.friction[n : 2 * n]])
    # A handful of operations: rounding of the largest entry.
    words = f"{'oblique' if strut else 'upright'} strut, engine {engine}" + (", small mass" if small_mass else "")
    validated(
        "Quarter and half cars", f"equations of motion of the quarter car, {words}", assembled, lagrange, rel=1e-12,
        abs=1e-9,
        source="second derivation: Lagrange equations by sympy, Bommer 2006, equations 2.6 to 2.13 and D.28 to D.34",
    )  # fmt: skip
    if engine == "elastomer":  # F2' = Ke2 (xe' - xb') - (Ke2/De) F2, below 2.13
        expected = np.zeros(2 * n + 1)
        expected[n + names.index("engine")], expected[n], expected[-1] = 3.4e5, -3.4e5, -3.4e5 / 6057
        assert ours.state[-1] == pytest.approx(expected, rel=1e-13)


def test_a_stack_of_cars_equals_the_single_ones():
    mounts, dampings = np.array([5e5, 7e5, 9e5]), np.array([1000.0, 1500.0, 3000.0])
    frequency = np.linspace(1.0, 50.0, 30)
    stack = quarter_car(
        CAR, damper="slip", engine="elastomer", vary={"mount.stiffness": mounts, "damper.damping": dampings}
    )
    stacked = frequency_response(stack.first_order(), frequency, "body", "acceleration")
    assert stacked.shape == (3, 30)
    for i in range(3):
        car = dataclasses.replace(
            CAR,
            mount=dataclasses.replace(CAR.mount, stiffness=float(mounts[i])),
            damper=dataclasses.replace(CAR.damper, damping=float(dampings[i])),
        )
        single = frequency_response(
            quarter_car(car, damper="slip", engine="elastomer").first_order(), frequency, "body", "acceleration"
        )
        assert stacked[i] == pytest.approx(single, rel=1e-10)


def test_angles_can_be_stacked_and_zero_angle_is_the_vertical_car():
    stack = quarter_car(CAR, damper="stick", strut=True, vary={"strut.angle": np.array([0.0, 4.2, 8.4])}).first_order()
    frequency = np.linspace(1.0, 45.0, 40)
    response = frequency_response(stack, frequency, "body")
    vertical = frequency_response(model(damper="stick"), frequency, "body")
    assert response[0] == pytest.approx(vertical, rel=1e-9)
    assert not np.allclose(response[2], vertical, rtol=1e-3)


def test_a_critically_damped_model_has_no_full_set_of_eigenvectors_and_is_right_all_the_same():
    row = {"mass": 1.0, ROAD: -1.0}
    network = Network(
        coordinates=("mass",),
        masses=(Mass(mass=1.0, axes=({"mass": 1.0},)),),
        links=(Link(row=row, law=Kelvin(stiffness=100.0, damping=20.0)),),
        outputs={"mass": {"mass": 1.0}, "extension": row},
    )
    frequency = np.linspace(0.1, 5.0, 20)
    s = 2j * np.pi * frequency
    expected = (20 * s + 100) / (s + 10) ** 2
    response = frequency_response(network.first_order(), frequency, "mass")
    assert response == pytest.approx(expected, rel=1e-12)
    assert frequency_response(network.first_order(), frequency, "extension") == pytest.approx(expected - 1.0, rel=1e-11)


BAD = [
    ({"damper": "slip", "vary": {"body.mass": -1.0}}, "body.mass: found -1.0 kg, must be greater than 0.0"),
    ({"damper": "slip", "vary": {"mount.stiffness": 0.0}}, "mount.stiffness: found 0.0 N/m, must be greater than 0.0"),
    (
        {"damper": "friction", "vary": {"friction.steepness": np.array([1e5, 0.0])}},
        "friction.steepness: found 0.0 s/m, must be greater than 0.0",
    ),
    (
        {"damper": "slip", "vary": {"wheel.tyre_stiffness": float("nan")}},
        "wheel.tyre_stiffness: found nan N/m, must be a finite number (vertical tyre stiffness Kt)",
    ),
    (
        {"damper": "slip", "vary": {"mount.stifness": 1.0}},
        "unknown parameter mount.stifness; did you mean mount.stiffness?",
    ),
    ({"damper": "stuck"}, "damper: found 'stuck', must be slip, stick or friction"),
    ({"damper": "friction", "friction": "stick"}, "friction: found 'stick', must be one of coulomb, stribeck"),
    ({"damper": "slip", "engine": "diesel"}, "engine: found 'diesel', must be none, linear or elastomer"),
    ({"damper": "slip", "degressive": True}, "degressive: found damper='slip', must be damper='friction'"),
]


@pytest.mark.parametrize(("parts", "message"), BAD)
def test_bad_compositions_are_refused_by_name(parts, message):
    with pytest.raises(ConfigurationError) as caught:
        quarter_car(CAR, **parts)
    assert str(caught.value) == message


def test_the_friction_law_is_chosen_by_its_word():
    numbers = {
        "limit": 60.0,
        "steepness": 1e6,
        "static_limit": 90.0,
        "stribeck_velocity": 0.02,
        "stribeck_exponent": 1.5,
    }
    vary = {f"friction.{name}": value for name, value in numbers.items()}
    (pair,) = quarter_car(CAR, damper="friction", friction="stribeck", vary=vary).slides
    speed = np.array([0.002, 0.02, 0.2])
    # Equation 3.2 with the arc tangent of equation 2.4.
    expected = (60.0 + 30.0 * np.exp(-((speed / 0.02) ** 1.5))) * (2.0 / np.pi) * np.arctan(1e6 * speed)
    np.testing.assert_allclose(pair.friction.force(speed), expected, rtol=1e-14)


def test_stacks_of_different_length_are_refused():
    network = quarter_car(CAR, damper="slip", vary={"body.mass": np.full(3, 180.0), "wheel.mass": np.full(4, 45.0)})
    with pytest.raises(
        ConfigurationError, match=r"^network: parameters of shapes .*\(3,\), \(4,\).* do not broadcast together$"
    ):
        network.first_order()


def test_a_model_with_friction_has_no_frequency_response():
    with pytest.raises(ConfigurationError, match="a model with sliding pairs has no frequency response"):
        frequency_response(model(damper="friction"), 1.0, "body")
    with pytest.raises(ConfigurationError, match="natural_modes: the model must be a single linear model"):
        natural_modes(model(damper="friction"))
    with pytest.raises(ConfigurationError, match="output 'engine': unknown; choose from body, wheel"):
        frequency_response(model(damper="slip"), 1.0, "engine")
    with pytest.raises(ConfigurationError, match="frequency: must be finite numbers"):
        frequency_response(model(damper="slip"), -1.0, "body")
