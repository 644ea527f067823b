"""Contributions of body modes to a place, and of attachments to a mode: both sums are exact."""

from __future__ import annotations

import numpy as np
import pytest

from tests.validation import validated
from vehicle.engines.linear.participation import REST, participation
from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car

FREQUENCY = np.array([2.0, 9.7, 18.0, 26.0, 33.0, 42.0])


def of(car, place, *, stuck=True, wheel="fr"):
    return participation(car.model, car.matrices, car.load_rows, place, FREQUENCY, stuck=stuck, wheel=wheel)


@pytest.mark.parametrize("damper", ["stuck", "sliding"])
@pytest.mark.parametrize("place", ["seat_rail_acc_z", "body_front_acc_x"])
def test_contributions_add_up_to_the_frf_by_poles(car, place, damper):
    found = of(car, place, stuck=damper == "stuck", wheel="fl")
    exact = car.matrix_frf([place], FREQUENCY, damper=damper, wheel="fl")[0]
    validated(
        "Linear system", f"sum of the contributions of all modes to {place}, dampers {damper}", found.total, exact,
        rel=1e-9, source="second derivation: FRF by poles",
    )  # fmt: skip
    assert found.shares.sum(axis=0) == pytest.approx(np.ones(6), abs=1e-12)
    assert len(found.names) == 6 + 9 and len(found.mode_frequency) == 9
    # No part alone makes the sum, or the shares would say nothing.
    assert np.abs(found.shares[6:]).max() > 0.5 and np.abs(found.shares[:6]).max() > 0.5


@pytest.mark.parametrize("changes", [(), ("body.modes_up_to=30",)])
def test_forces_of_the_attachments_are_what_drives_a_mode(changes):
    # Without weight no preload turns: the forces of the elements, by their own laws, are all that reaches a mode of
    # q'' + 2 zeta w q' + w^2 q. With modes up to 30 Hz, residual flexibility couples the axes of every attachment.
    car = Car.load(overrides=["gravity=0", *changes])
    for stuck in (True, False):
        found = of(car, "seat_rail_acc_z", stuck=stuck)
        largest = np.abs(found.modal_forces).max(axis=(1, 2))
        assert found.attachments[-1] == REST
        assert (np.abs(found.modal_forces[:, -1]).max(axis=1) / largest).max() < 1e-6
        assert found.attachment_shares.sum(axis=1) == pytest.approx(np.ones((len(largest), 6)), abs=1e-9)
    assert found.modal_forces.shape[0] == (4 if changes else 9)


def test_at_26_hz_the_torsion_makes_the_seat_rail_loud(car):
    found = of(car, "seat_rail_acc_z", stuck=False)
    at = int(np.flatnonzero(FREQUENCY == 26.0)[0])
    loudest = int(np.argmax(found.shares[:, at]))
    assert found.names[loudest] == "mode 2 (torsion)"
    assert abs(found.mode_frequency[1] - 25.5) < 0.5
    driver = int(np.argmax(found.attachment_shares[1, :, at]))
    assert found.attachments[driver] == "suspension_mount_fr"  # of the driven wheel


def test_what_is_no_place_of_a_flexible_body_is_refused(car):
    with pytest.raises(ConfigurationError, match=r"^place engine_acc_z: no acceleration on the body; there are "):
        of(car, "engine_acc_z")
    rigid = Car.load(overrides=["body.flexible=false"])
    with pytest.raises(ConfigurationError, match=r"its body is rigid; modes that take part need body\.flexible = true"):
        of(rigid, "seat_rail_acc_z")
