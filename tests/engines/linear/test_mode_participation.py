"""Contributions of body modes to a channel, and of attachments to a mode: both sums are exact."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.engines.linear.mode_participation import REMAINDER, participation
from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car

FREQUENCY = np.array([2.0, 9.7, 18.0, 26.0, 33.0, 42.0])


def of(car, channel, *, stuck=True, wheel="fr"):
    return participation(car.model, car.matrices, car.load_rows, channel, FREQUENCY, stuck=stuck, wheel=wheel)


@pytest.mark.parametrize("damper", ["stuck", "sliding"])
@pytest.mark.parametrize("channel", ["seat_rail_acc_z", "body_front_acc_x"])
def test_contributions_add_up_to_the_frf_by_poles(car, channel, damper):
    contributions = of(car, channel, stuck=damper == "stuck", wheel="fl")
    exact = car.matrix_frf([channel], FREQUENCY, damper=damper, wheel="fl")[0]
    validated(
        "Linear system", f"sum of the contributions of all modes to {channel}, dampers {damper}",
        contributions.total, exact,
        rel=1e-9, source="second derivation: FRF by poles",
    )  # fmt: skip
    assert contributions.shares.sum(axis=0) == pytest.approx(np.ones(6), abs=1e-12)
    assert len(contributions.names) == 6 + 9 and len(contributions.mode_frequency) == 9
    # No single part makes the sum, otherwise the shares would prove nothing.
    assert np.abs(contributions.shares[6:]).max() > 0.5 and np.abs(contributions.shares[:6]).max() > 0.5


@pytest.mark.parametrize("changes", [(), ("body.modes_up_to=30",)])
def test_forces_of_the_attachments_are_what_drives_a_mode(changes):
    # Without weight no preload turns: the forces of the elements, by their own laws, are all that reaches a mode of
    # q'' + 2 zeta w q' + w^2 q. With modes up to 30 Hz, residual flexibility couples the axes of every attachment.
    car = Car.load(overrides=["gravity=0", *changes])
    for stuck in (True, False):
        result = of(car, "seat_rail_acc_z", stuck=stuck)
        largest = np.abs(result.modal_forces).max(axis=(1, 2))
        assert result.attachments[-1] == REMAINDER
        assert (np.abs(result.modal_forces[:, -1]).max(axis=1) / largest).max() < 1e-6
        assert result.attachment_shares.sum(axis=1) == pytest.approx(np.ones((len(largest), 6)), abs=1e-9)
    assert result.modal_forces.shape[0] == (4 if changes else 9)


def test_at_26_hz_the_torsion_makes_the_seat_rail_loud(car):
    result = of(car, "seat_rail_acc_z", stuck=False)
    at = int(np.flatnonzero(FREQUENCY == 26.0)[0])
    loudest = int(np.argmax(result.shares[:, at]))
    assert result.names[loudest] == "mode 2 (torsion)"
    assert abs(result.mode_frequency[1] - 25.5) < 0.5
    driver = int(np.argmax(result.attachment_shares[1, :, at]))
    assert result.attachments[driver] == "suspension_mount_fr"  # of the driven wheel


def test_channels_off_a_flexible_body_are_rejected(car):
    with pytest.raises(ConfigurationError, match=r"^channel engine_acc_z: must be an acceleration of the body: "):
        of(car, "engine_acc_z")
    rigid = Car.load(overrides=["body.flexible=false"])
    with pytest.raises(ConfigurationError, match=r"the body is rigid, so it has no modes; set body\.flexible = true"):
        of(rigid, "seat_rail_acc_z")
