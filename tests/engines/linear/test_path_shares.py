"""Paths of a mode into the body: their sum, their forces, and a wheel that moves the body by its own axle."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.engines.linear.path_shares import REST, path_shares
from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car

WEAK = 0.1
"""Torsional stiffness of every bushing [N m/rad], a thousandth of the usual one."""

HIGHEST = 40.0
"""Highest mode [Hz]."""


def shares_of(car, mode, damper, channel="seat_rail_acc_z"):
    stuck = damper == "stuck"
    return path_shares(car.model, car.matrices, car.load_rows, channel, mode.frequency, stuck=stuck)


def modes_of(car, damper):
    return [mode for mode in car.modes(damper) if mode.frequency < HIGHEST]


def without_moments(name):
    """Without weight no preload rotates; moments of torsional stiffnesses, which are no load channels, are weak."""
    stiffnesses = Car.load(name).search("rotational_stiffness")
    return Car.load(name, ["gravity=0", *(f"{parameter.path}={WEAK}" for parameter in stiffnesses)])


@pytest.mark.parametrize("damper", ["stuck", "sliding"])
@pytest.mark.parametrize("name", ["focus", "sedan"])
def test_contributions_add_up_to_the_motion_of_the_mode(name, damper):
    car = without_moments(name)
    sums, exact = [], []
    for mode in modes_of(car, damper):
        result, row = shares_of(car, mode, damper), car.matrices.system.output("seat_rail_acc_z")[0]
        # In the scale of the eigenvector of `Mode`: its largest coordinate is that of both.
        scale = mode.shape[np.argmax(np.abs(mode.shape))]
        pole = 2.0 * np.pi * mode.frequency * (-mode.damping_ratio + 1j * np.sqrt(1.0 - mode.damping_ratio**2))
        assert result.pole == pytest.approx(pole, rel=1e-6)
        exact.append(pole**2 * (row @ mode.shape) / scale)
        sums.append(result.contributions[:-1].sum() / scale)
        assert result.shares.sum() == pytest.approx(1.0, abs=1e-9)
    assert len(sums) > 15
    validated(
        "Linear system", f"acceleration of the seat rail of {name} in its modes, sum of all paths, dampers {damper}",
        np.array(sums), np.array(exact),
        peak=1e-5, unit="m/s2", source="second derivation: shape of the mode, whose largest coordinate is 1",
    )  # fmt: skip


@pytest.mark.parametrize("name", ["focus", "focus_road_seated", "sedan"])
def test_forces_of_the_attachments_are_all_that_moves_the_body(name):
    """Newton's law of the body, rigid or flexible, holds with the forces alone."""
    car = without_moments(name)
    for damper in ("stuck", "sliding"):
        for mode in modes_of(car, damper)[::4]:
            forces = np.abs(shares_of(car, mode, damper).forces)
            straight = [0, 1, 2, *range(6, forces.shape[1])]
            assert forces[-1][straight].max() < 1e-6 * forces[:-1].max()


def test_the_rest_is_small_with_weight_and_moments(car):
    for mode in modes_of(car, "stuck"):
        result = shares_of(car, mode, "stuck")
        assert result.names[-1] == REST and abs(result.shares[-1]) < 0.03
        # No single path makes the sum, otherwise the shares would prove nothing.
        assert np.sum(np.abs(result.contributions) > 0.05 * np.abs(result.contributions).max()) > 1


@pytest.mark.parametrize("name", ["focus", "focus_road_seated", "sedan", "kinematic_reference"])
def test_a_wheel_hop_moves_the_body_by_its_own_axle(name):
    """Hop of both wheels of an axle, in phase, sliding: most of it comes by springs, dampers and links of this axle."""
    car, found = Car.load(name), 0
    for mode in car.modes("sliding"):
        axle = next((end for end in ("front", "rear") if mode.description == f"{end} wheel hop, sides in phase"), None)
        if axle is None:
            continue
        found += 1
        result = shares_of(car, mode, "sliding")
        corners = {"front": ("_fl", "_fr"), "rear": ("_rl", "_rr")}
        by_axle = {
            end: sum(share for each, share in zip(result.names, result.shares, strict=True) if each.endswith(both))
            for end, both in corners.items()
        }
        other = by_axle[{"front": "rear", "rear": "front"}[axle]]
        assert abs(other) < 0.2 and by_axle[axle] > 2.0 * abs(other)
    assert found == len(car.vehicle.wheels) // 2


def test_a_channel_off_the_body_is_rejected(car):
    with pytest.raises(ConfigurationError, match="knuckle_fl_acc_z: must be an acceleration of a point on the body"):
        shares_of(car, modes_of(car, "stuck")[0], "stuck", "knuckle_fl_acc_z")
