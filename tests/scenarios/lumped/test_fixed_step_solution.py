"""The fixed-step solution of a stack compared with the stiff solver, its order, and rejected inputs."""

import numpy as np
import pytest

from scenarios.lumped.fixed_step_solution import fixed_step_solution
from scenarios.lumped.input_signals import Sampled
from scenarios.lumped.quarter_car_network import quarter_car, single_mass
from scenarios.lumped.quarter_car_parameters import load_quarter_car
from scenarios.lumped.stiff_solution import Tolerances, stiff_solution
from tests.validation import own_function, validated
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.laws.coulomb import Coulomb

CAR = load_quarter_car()
END = 0.75
FINE = Tolerances(relative=1e-8, displacement=1e-11, velocity=1e-9, force=1e-6)


def bumpy_road(time, size):
    """Smooth road that starts and stays at rest at first order: a sum of sines under a window."""
    rng = np.random.default_rng(5)
    shape = sum(
        rng.normal() / f * np.sin(2 * np.pi * f * time + rng.uniform(0, 6.28)) for f in (1.1, 2.3, 5.9, 13.7, 23.1)
    )
    return size * shape * np.sin(np.pi * time / END) ** 2


@pytest.mark.parametrize(
    ("parts", "size"),
    [({}, 0.001), ({}, 0.02), ({"engine": "elastomer", "strut": True}, 0.02), ({"degressive": True}, 0.001)],
    ids=["friction, stuck", "friction", "engine and strut", "degressive"],
)
def test_convergence_to_the_stiff_solution_with_second_order(parts, size):
    model = quarter_car(CAR, damper="friction", **parts).first_order()
    fine = np.linspace(0.0, END, 6001)
    road = bumpy_road(fine, size)
    reference = stiff_solution(model, fine[::8], road=Sampled(road, fine[1]), tolerances=FINE)
    histories = [fixed_step_solution(model, fine[n], road[::n], every=8 // n) for n in (8, 4, 2)]  # 1, 0.5, 0.25 ms
    errors = {name: relative_errors(histories, reference, name) for name in ("body", "wheel", "damper")}
    for name, (rough, _, finest) in errors.items():
        # The sample at which a stick begins or ends is off by the step times the jump of the friction. The light damper
        # feels that jump most and mixes both orders: found 1.3 to 2.1, and 1.8 to 2.0 for the others.
        assert np.log2(rough / finest) / 2 > (1.2 if name == "damper" else 1.75), name
    # The stuck strut of the small road is a mode of 25 Hz held at the ends of the steps: (w h)^2/12 of its phase.
    assert errors["body"][1] < (0.05 if size == 0.001 else 0.02)
    assert errors["damper"][2] < 0.15  # taken at the end of the step, the force of a stuck pair lags: 0.3 to 1.0


def relative_errors(histories, reference, name):
    """Return the RMS of the deviation in acceleration over RMS of the reference, for each history."""
    exact = reference.acceleration(name)
    return [np.sqrt(np.mean((h.acceleration(name) - exact) ** 2) / np.mean(exact**2)) for h in histories]


@pytest.fixture(scope="module")
def gentle():
    """Marches of three steps with a gentle friction law, and the stiff solution."""
    model = quarter_car(CAR, damper="friction", vary={"friction.steepness": 30.0}).first_order()
    fine = np.linspace(0.0, END, 6001)
    road = bumpy_road(fine, 0.02)
    reference = stiff_solution(model, fine[::8], road=Sampled(road, fine[1]), tolerances=FINE)
    return [fixed_step_solution(model, fine[n], road[::n], every=8 // n) for n in (4, 2, 1)], reference


@pytest.mark.parametrize("name", ["body", "wheel", "damper"])
def test_the_order_is_two_for_a_law_of_any_slope(gentle, name):
    """A gentle law changes over the whole step: taken at its end the motion is first order."""
    histories, reference = gentle
    rough, _, finest = relative_errors(histories, reference, name)
    validated(
        "Quarter and half cars", f"order of convergence of the march with a gentle friction law, {name}",
        np.log2(rough / finest) / 2, 2.0, abs=0.2, source=own_function("scipy", "lumped quarter car, LSODA"),
    )  # fmt: skip


def test_without_friction_the_solution_is_exact_for_straight_roads():
    model = quarter_car(CAR, damper="friction", engine="elastomer", vary={"friction.limit": 0.0}).first_order()
    coarse = 0.02 * np.array([0.0, 1.0, -0.5, 0.25, 0.25, 0.0])
    rough = fixed_step_solution(model, 0.1, coarse)
    fine = np.interp(np.arange(0, 0.5 + 1e-9, 1e-3), np.arange(0, 0.6, 0.1)[:6], coarse)
    smooth = fixed_step_solution(model, 1e-3, fine, every=100)
    # Both are exact; rounding of matrix exponentials with norms of 1e5 costs half of the digits at most.
    assert rough.state == pytest.approx(smooth.state, rel=1e-7, abs=1e-9)


def test_law_parameters_define_a_stack_too():
    model = quarter_car(CAR, damper="friction", vary={"friction.limit": np.array([0.0, 75.0, 150.0])}).first_order()
    assert model.models == (3,)
    history = fixed_step_solution(model, 1e-3, bumpy_road(np.linspace(0.0, END, 751), 0.005))
    assert history.sliding_force.shape == (751, 3, 1)
    assert np.abs(history.sliding_force[:, 0]).max() == 0.0


def test_a_stack_moves_as_the_single_cars():
    fine = np.linspace(0.0, END, 751)
    road = bumpy_road(fine, 0.005)
    mounts, limits = np.array([4e5, 7e5]), np.array([75.0, 150.0])
    stack = quarter_car(
        CAR, damper="friction", vary={"mount.stiffness": mounts, "friction.limit": limits}
    ).first_order()
    stacked = fixed_step_solution(stack, fine[1], road)
    both_roads = fixed_step_solution(stack, fine[1], np.stack([road, 2 * road], axis=1))
    assert stacked.acceleration("damper").shape == (751, 2)
    for i in range(2):
        model = quarter_car(
            CAR, damper="friction", vary={"mount.stiffness": mounts[i], "friction.limit": limits[i]}
        ).first_order()
        single = fixed_step_solution(model, fine[1], road)
        for output in ("body", "wheel", "damper"):
            # The same operations in the same order, except for the summation inside the matrix products.
            assert stacked.acceleration(output)[:, i] == pytest.approx(single.acceleration(output), rel=1e-6, abs=1e-8)
        assert stacked.sliding_velocity()[:, i] == pytest.approx(single.sliding_velocity(), abs=1e-10)
        assert both_roads.velocity("body")[:, i] == pytest.approx(
            fixed_step_solution(model, fine[1], (1 + i) * road).velocity("body"), abs=1e-10
        )


def test_another_stiff_method_agrees():
    model = quarter_car(CAR, damper="friction", engine="elastomer").first_order()
    time = np.linspace(0.0, 0.5, 501)
    road = Sampled(bumpy_road(time, 0.01), time[1])
    default = stiff_solution(model, time, road=road)
    other = stiff_solution(model, time, road=road, method="Radau")
    # Each within its relative tolerance of 1e-6 per step, some thousand steps: 1e-4 of the largest value; the wheel
    # feels the friction force itself, which turns within microseconds, so single samples differ more.
    for output in ("body", "wheel", "engine"):
        a, b = default.acceleration(output), other.acceleration(output)
        validated(
            "Quarter and half cars", f"acceleration of the {output} of a quarter car with friction, against Radau",
            a, b, abs=(3e-3 if output == "wheel" else 1e-4) * np.abs(a).max(), unit="m/s2",
            source=own_function("scipy", "lumped quarter car, Radau"),
        )  # fmt: skip


def test_velocity_and_acceleration_are_derivatives_of_the_displacement():
    model = quarter_car(CAR, damper="friction", engine="elastomer").first_order()
    time = np.linspace(0.0, END, 7501)
    history = stiff_solution(model, time, road=Sampled(bumpy_road(time, 0.01), time[1]), tolerances=FINE)
    for output in ("body", "wheel", "engine"):
        x, v, a = history.displacement(output), history.velocity(output), history.acceleration(output)
        # Central differences over 0.1 ms: curvature of 50 Hz motion 1e-4, solver noise 1e-9/1e-4.
        assert np.gradient(x, time)[1:-1] == pytest.approx(v[1:-1], abs=1e-3 * np.abs(v).max())
        jumps = 2e-2 if output == "wheel" else 2e-3  # the wheel's acceleration jumps by Fd/Mt where the motion turns
        rms = np.sqrt(np.mean((np.gradient(v, time)[1:-1] - a[1:-1]) ** 2))
        assert rms < jumps * np.sqrt(np.mean(a**2))


def test_refusals():
    law = Coulomb(friction_limit=1.0, smoothing=1e5)
    single = single_mass(mass=1.0, stiffness=1.0, friction=law).first_order()
    stack = single_mass(mass=np.array([1.0, 2.0]), stiffness=1.0, friction=law).first_order()
    road = np.zeros(10)
    with pytest.raises(ConfigurationError, match=r"^timestep: found 0\.0 s, must be finite and greater than 0\.0$"):
        fixed_step_solution(single, 0.0, road)
    with pytest.raises(ConfigurationError, match=r"^every: found 0, must be at least 1$"):
        fixed_step_solution(single, 1e-3, road, every=0)
    with pytest.raises(ConfigurationError, match=r"^road: found shape \(10, 3\)"):
        fixed_step_solution(stack, 1e-3, np.zeros((10, 3)))
    with pytest.raises(ConfigurationError, match=r"^road: all displacements must be finite$"):
        fixed_step_solution(single, 1e-3, road + np.nan)
    with pytest.raises(ConfigurationError, match=r"^fixed_step_solution: found 0 sliding pairs, must be one$"):
        fixed_step_solution(quarter_car(CAR, damper="slip").first_order(), 1e-3, road)
    with pytest.raises(ConfigurationError, match=r"^stiff_solution: found a stack of \(2,\) models"):
        stiff_solution(stack, [0.0, 1.0])
    with pytest.raises(ConfigurationError, match=r"^time: must be at least two finite, strictly increasing"):
        stiff_solution(single, [0.0, 0.0])
    with pytest.raises(ConfigurationError, match=r"^initial: must be 2 finite numbers$"):
        stiff_solution(single, [0.0, 1.0], initial=[1.0])
    with pytest.raises(ConfigurationError, match=r"^Tolerances\.relative: found 0\.0"):
        Tolerances(relative=0.0)
    with pytest.raises(DataError, match=r"^sampled signal: must have at least two finite samples"):
        Sampled([0.0, np.nan], 1e-3)
    with pytest.raises(ConfigurationError, match=r"^sampled signal: timestep -1\.0 s"):
        Sampled([0.0, 1.0], -1.0)


def test_the_friction_of_every_step_is_the_law_at_its_end_however_rough_the_road():
    """Jumps of the road throw the velocity across the steep part of the law in single steps."""
    limits = np.linspace(0.0, 300.0, 60)
    model = quarter_car(
        CAR, damper="friction", vary={"friction.limit": limits, "friction.steepness": 1e6}
    ).first_order()
    road = np.cumsum(np.random.default_rng(3).normal(scale=2e-3, size=400))
    history = fixed_step_solution(model, 1e-3, road)
    law = Coulomb(friction_limit=limits, smoothing=1e6)
    velocity, force = history.sliding_velocity()[1:], history.sliding_force[1:, :, 0]
    slides = np.abs(velocity) > 0.05
    assert 0.3 < slides.mean() < 1.0
    # The law has a slope of up to 0.08 N s/m there: 1e-4 of the jumps of 600 N go into a pair taken for stuck by that.
    assert force[slides] == pytest.approx(law.force(velocity)[slides], abs=0.05)
    # The force of a stuck pair is between the forces of two steps, each within the limit.
    assert (np.abs(force) <= limits + 1e-9).all()


def test_the_viscous_law_is_centred():
    """A degressive damper that never reaches its knee is a plain one, which the propagator takes exactly."""
    fine = np.linspace(0.0, END, 1501)
    road = bumpy_road(fine, 0.01)
    no_friction = {"friction.limit": 0.0, "damper.mass": 5.0}
    plain = quarter_car(CAR, damper="friction", vary={**no_friction, "damper.damping": 3000.0}).first_order()
    knee = {"degressive.low_damping": 3000.0, "degressive.knee_velocity": 100.0}
    bent = quarter_car(CAR, damper="friction", degressive=True, vary={**no_friction, **knee}).first_order()
    errors = []
    for stride in (2, 1):
        exact = fixed_step_solution(plain, fine[stride], road[::stride]).acceleration("body")
        error = fixed_step_solution(bent, fine[stride], road[::stride]).acceleration("body") - exact
        errors.append(np.sqrt(np.mean(error**2) / np.mean(exact**2)))
    # Smooth motion: the order is 2 and shows clearly; taken at the end of the step it would be 1.
    validated(
        "Quarter and half cars", "order of convergence of the centred viscous law", np.log2(errors[0] / errors[1]), 2.0,
        abs=0.1, source="second derivation: the same damper in the exact propagator",
    )  # fmt: skip
