"""Stepped half car: order of convergence, controlled dampers, tyres that leave the road."""

import dataclasses

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from scenarios.lumped.bump_response import bump_passage, bump_response
from scenarios.lumped.half_car_rider_model import half_car_rider, lift_off, linear_tyre_load, static_tyre_load
from scenarios.lumped.half_car_rider_parameters import half_car_rider_parameters
from scenarios.lumped.semi_active_half_car import simulate_bump
from tests.validation import foreign, validated
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.model.parameters.semi_active_damper import LAWS

CAR = half_car_rider_parameters()
SPEED = 20.0 / 3.6


def at(car, **limits):
    return dataclasses.replace(car, semi_active=dataclasses.replace(car.semi_active, **limits))


def displacements(history):
    return history.state[:, :7]


def test_passive_car_converges_to_the_exact_response_with_order_two():
    exact = bump_response(half_car_rider(CAR), bump_passage(CAR.bump, SPEED, 2.8), time_step=1e-3, duration=1.0)
    errors = []
    for step in (1e-3, 5e-4, 2.5e-4):
        (history,) = simulate_bump([CAR], [SPEED], duration=1.0, largest_step=step)
        errors.append(np.abs(displacements(history)[:: round(1e-3 / history.time[1])] - displacements(exact)).max())
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    # jumps of the road slope fall anywhere within a step
    validated(
        "Quarter and half cars", "order of convergence of the stepped half car", orders, 2.0, abs=0.1,
        source="second derivation: exact response of the linear car",
    )  # fmt: skip
    assert errors[1] < 1e-5 * np.abs(displacements(exact)).max()


def test_runs_of_a_batch_do_not_act_on_each_other():
    heavy = dataclasses.replace(CAR, body=dataclasses.replace(CAR.body, mass=700.0))
    batch = simulate_bump([CAR, heavy], [SPEED, 12.0], law="skyhook", one_sided_tyres=True, duration=0.4)
    single = simulate_bump([heavy], [12.0], law="skyhook", one_sided_tyres=True, duration=0.4)[0]
    # batched products may add in another order
    np.testing.assert_allclose(batch[1].state, single.state, rtol=0, atol=1e-12)


@pytest.mark.parametrize("law", LAWS)
def test_damper_without_range_is_a_passive_damper(law):
    fixed = at(CAR, minimum_damping=1000.0, maximum_damping=1000.0)
    (controlled,) = simulate_bump([fixed], [SPEED], law=law, duration=0.5)
    (passive,) = simulate_bump([CAR], [SPEED], duration=0.5)
    validated(
        "Semi-active dampers", f"half car, damper without range under {law}, displacements", displacements(controlled),
        displacements(passive), abs=1e-15, unit="m", source="second derivation: passive car",
    )  # fmt: skip


def test_settings_are_held_for_a_control_period():
    (history,) = simulate_bump([at(CAR, control_period=2e-3)], [SPEED], law="skyhook", duration=0.5)
    substeps = round(2e-3 / history.time[1])
    assert substeps == 4
    for pair in (0, 1):
        speed = history.sliding_velocity(pair)[:-1].reshape(-1, substeps)
        setting = history.sliding_force[:-1, pair].reshape(-1, substeps) / np.where(speed == 0.0, 1.0, speed)
        moving = (np.abs(speed) > 1e-6).all(axis=1)
        np.testing.assert_allclose(setting[moving], setting[moving, :1].repeat(substeps, axis=1), rtol=1e-9)
        assert np.unique(setting[moving].round(6)).size > 50  # the continuous law does use its range


def test_skyhook_calms_the_body_and_groundhook_the_wheel():
    def rms(law, name):
        (history,) = simulate_bump([CAR], [SPEED], law=law, duration=3.0)
        return np.sqrt(np.mean(history.velocity(name) ** 2))

    assert rms("skyhook", "heave") < rms("passive", "heave") < rms("groundhook", "heave")
    assert rms("groundhook", "front_wheel") < rms("passive", "front_wheel") < rms("skyhook", "front_wheel")


def one_sided_reference(car, passage, time):
    """Forces written out element by element and integrated by a stiff adaptive solver, free of the matrices."""
    static = static_tyre_load(car)
    body, f, r = car.body, car.front, car.rear

    def slope(t, s):
        x3, x2, xse, xb, xf, xr, th = s[:7]
        v3, v2, vse, vb, vf, vr, om = s[7:]
        z, dz = passage.heights(t), passage.rates(t)
        upper = car.upper_limb.stiffness * (xse - x3) + car.upper_limb.damping * (vse - v3)
        lower = car.lower_limb.stiffness * (xse - x2) + car.lower_limb.damping * (vse - v2)
        seat = car.seat.stiffness * (xb - body.seat_arm * th - xse) + car.seat.damping * (vb - body.seat_arm * om - vse)
        front = f.suspension_stiffness * (xf - xb + body.front_arm * th)
        front += f.suspension_damping * (vf - vb + body.front_arm * om)
        rear = r.suspension_stiffness * (xr - xb - body.rear_arm * th)
        rear += r.suspension_damping * (vr - vb - body.rear_arm * om)
        tyres = [
            max(0.0, static[0] + f.tyre_stiffness * (z[0] - xf) + f.tyre_damping * (dz[0] - vf)) - static[0],
            max(0.0, static[1] + r.tyre_stiffness * (z[1] - xr) + r.tyre_damping * (dz[1] - vr)) - static[1],
        ]
        return [
            *s[7:],
            upper / car.upper_limb.mass,
            lower / car.lower_limb.mass,
            (seat - upper - lower) / car.seat.mass,
            (front + rear - seat) / body.mass,
            (tyres[0] - front) / f.unsprung_mass,
            (tyres[1] - rear) / r.unsprung_mass,
            (-body.front_arm * front + body.rear_arm * rear + body.seat_arm * seat) / body.pitch_inertia,
        ]

    solved = solve_ivp(slope, (0.0, time[-1]), np.zeros(14), t_eval=time, rtol=1e-7, atol=1e-9, max_step=1e-3)
    return solved.y


def test_one_sided_tyre_agrees_with_forces_written_out():
    (history,) = simulate_bump([CAR], [SPEED], one_sided_tyres=True, duration=0.8)
    reference = one_sided_reference(CAR, bump_passage(CAR.bump, SPEED, 2.8), history.time)
    # the reference crosses the jumps of the road rate with steps of up to 1 ms: about 1e-4 of the motion
    validated(
        "Quarter and half cars", "half car whose wheels leave the road, displacements", displacements(history).T,
        reference[:7], peak=3e-4, unit="m", source=foreign("scipy", "RK45 on forces written out element by element"),
    )  # fmt: skip
    glued = simulate_bump([CAR], [SPEED], duration=0.8)[0]
    assert np.abs(displacements(glued).T - reference[:7]).max() > 0.05 * np.abs(reference[:7]).max()


def test_one_sided_tyre_is_linear_while_the_wheels_stay_down():
    small = dataclasses.replace(CAR, bump=dataclasses.replace(CAR.bump, height=0.005))
    one_sided, glued = (
        simulate_bump([small], [SPEED], one_sided_tyres=flag, duration=1.0)[0] for flag in (True, False)
    )
    np.testing.assert_array_equal(one_sided.state, glued.state)
    assert all(not lift_off(glued.time, load) for load in linear_tyre_load(small, glued))


def test_wheel_in_the_air_is_pulled_by_nothing_but_its_suspension():
    (history,) = simulate_bump([CAR], [SPEED], one_sided_tyres=True, duration=0.3)
    (start, end), *_ = lift_off(history.time, linear_tyre_load(CAR, history)[0])
    air = (history.time > start) & (history.time < end)
    pull = 16812.0 * history.displacement("front_travel") + 1000.0 * history.velocity("front_travel")
    pull -= static_tyre_load(CAR)[0]
    validated(
        "Quarter and half cars", "force on a wheel in the air", 60.0 * history.acceleration("front_wheel")[air],
        pull[air], rel=1e-9, unit="N",
        source="conservation: Newton, spring, damper and static load of the suspension alone",
    )  # fmt: skip


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            {"law": "sky"},
            f"half car: law: found 'sky', must be one of passive, {', '.join(LAWS)}",
        ),
        ({"speeds": [1.0, 2.0]}, "half car: found 1 cars and 2 speeds, must be one speed for each car"),
        ({"largest_step": 0.0}, "half car: largest_step: found 0.0 s, must be greater than 0.0"),
        ({"duration": 0.0}, "half car: duration: found 0.0 s, must be at least 0.0005 s"),
    ],
)
def test_bad_arguments_are_refused(arguments, message):
    with pytest.raises(ConfigurationError) as caught:
        simulate_bump(**{"cars": [CAR], "speeds": [5.0], **arguments})
    assert str(caught.value) == message


def test_cars_with_different_controllers_are_refused():
    with pytest.raises(ConfigurationError, match="half car: semi_active: all cars of one call must have the same"):
        simulate_bump([CAR, at(CAR, maximum_damping=4000.0)], [5.0, 5.0])


def test_unstable_step_is_reported_with_its_time():
    slow = at(CAR, control_period=0.5)
    with (
        np.errstate(over="ignore", invalid="ignore"),
        pytest.raises(SimulationError, match=r"half car: motion not finite at .* s with a step of 0.5 s"),
    ):
        simulate_bump([slow], [1.0], duration=500.0, largest_step=0.5)
