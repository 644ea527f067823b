"""Bushings and joints in series with an attachment that couples the axes: against complex stiffnesses, in a car."""

from dataclasses import replace

import numpy as np
import pytest

from tests.validation import validated
from vehicle.errors import ConfigurationError
from vehicle.model.assembly.connections import ElementLaw
from vehicle.model.assembly.coupled_attachment import coupled_law
from vehicle.model.parameters.composition import PlacedConnection
from vehicle.model.parameters.force_elements import Bushing, Hydromount
from vehicle.model.parameters.force_table import ForceTable
from vehicle.model.parameters.hardpoints import axes_along
from vehicle.runs.car import Car

SOFT = Bushing(stiffness=(6e5, 3e5, 5e5), damping=(1000.0, 100.0, 2000.0), rotational_stiffness=100.0)
STIFF = Bushing(stiffness=(3e7, 3e6, 0.0), damping=(1000.0, 100.0, 0.0), rotational_stiffness=100.0)
MOUNT = Hydromount(
    stiffness=(4e5, 8e5, 4e5), damping=(1000.0, 100.0, 0.0), rotational_stiffness=100.0, maxwell_stiffness=1e5,
    maxwell_damping=2000.0,
)  # fmt: skip


def flexibility():
    """Residual of a body in sheet metal: 1e-8 to 5e-8 m/N, far from diagonal."""
    root = np.random.default_rng(1).standard_normal((3, 3))
    return 1e-8 * root @ root.T


def connection(law, axes=None):
    return PlacedConnection(
        name="mount", moving="engine", carrier="body", point="mount", at=(0.0, 0.0, 0.0), law=law, ground=False,
        path="engine.bushings.mount", axes=axes,
    )  # fmt: skip


@pytest.mark.parametrize("axes", [None, axes_along((0.0, 0.0, 0.0), (1.0, 2.0, 0.5))])
@pytest.mark.parametrize("law", [SOFT, STIFF, MOUNT])
def test_the_rows_have_the_dynamic_stiffness_of_the_series(law, axes):
    """Z = (G + (K + s B + branch)^-1)^-1; exact at rest, the damper to first order in w G B."""
    compliance, turn = flexibility(), np.eye(3) if axes is None else np.array(axes)
    fields = coupled_law(connection(law, axes), compliance)
    rows, directions = ElementLaw(**fields), fields["directions"]
    k, b, k2, tau = rows.stiffness, rows.damping, rows.branch_stiffness, rows.branch_time
    for frequency, allowed in ((0.0, 1e-10), (5.0, 1e-3), (50.0, 5e-3)):
        s = 2j * np.pi * frequency
        own = np.diag(np.array(law.stiffness) + s * np.array(law.damping))
        if isinstance(law, Hydromount):
            own[2, 2] += 1e5 * 2000.0 * s / (2000.0 * s + 1e5)
        own = turn.T @ own @ turn
        exact = own @ np.linalg.inv(np.eye(3) + compliance @ own)
        found = directions.T @ np.diag(k + s * b + k2 * s * tau / (1.0 + s * tau)) @ directions
        place = "" if axes is None else ", turned"
        validated(
            "Bushings, springs and stops",
            f"{type(law).__name__} of {law.stiffness[0]:g} N/m behind sheet metal{place}, {frequency:g} Hz, error",
            np.linalg.norm(found - exact) / np.linalg.norm(exact), 0.0, abs=allowed,
            source="closed form: (G + Z^-1)^-1",
        )  # fmt: skip
        assert np.abs(found.imag - exact.imag).max() <= 5e-3 * np.abs(exact.imag).max()


def test_an_ideal_joint_becomes_the_sheet_metal_itself():
    compliance = flexibility()
    fields = coupled_law(connection(None), compliance)
    k, directions = fields["stiffness"], fields["directions"]
    validated(
        "Bushings, springs and stops", "stiffness of an ideal joint on sheet metal",
        directions.T @ np.diag(k) @ directions, np.linalg.inv(compliance), rel=1e-9, unit="N/m",
        source="closed form: inverse of the flexibility",
    )  # fmt: skip
    np.testing.assert_allclose(fields["damping"], 1e-4 * k)


def test_a_table_in_series_is_rejected():
    table = replace(SOFT, table_z=ForceTable(displacement=(-0.01, 0.0, 0.01), force=(-100.0, 0.0, 100.0)))
    with pytest.raises(ConfigurationError, match=r"engine\.bushings\.mount\.table_z: found a table"):
        coupled_law(connection(table), flexibility())


def test_rubber_friction_in_series_is_rejected():
    rubber = replace(SOFT, friction_force=(0.0, 0.0, 50.0), friction_stroke=(0.0, 0.0, 1e-3))
    with pytest.raises(ConfigurationError) as caught:
        coupled_law(connection(rubber), flexibility())
    assert str(caught.value) == (
        "engine.bushings.mount.friction_force: found [0.0, 0.0, 50.0] N, but the body is flexible at this point "
        "and its flexibility couples the axes, which excludes friction_force; remove friction_force, use a body "
        "model with a separate stiffness for each axis, or set body.attachment_flexibility = false"
    )


@pytest.fixture(scope="module")
def truncated():
    """The Focus with modes to 35 Hz: those above answer statically, in the sheet metal of its attachments."""
    return Car.load(None, ["body.modes_up_to=35"])


def test_modes_that_are_left_out_answer_statically(truncated):
    whole = Car.load()
    count = len(truncated.model.superelement.frequencies)
    assert 3 < count < len(whole.model.superelement.frequencies)
    channels, low = ["seat_rail_acc_z", "knuckle_fr_acc_z", "engine_acc_z"], np.linspace(2.0, 12.0, 21)
    exact, found = (car.matrix_frf(channels, low) for car in (whole, truncated))
    bare = Car(Car.load(None, ["body.modes_up_to=35"]).vehicle)
    dropped = replace(whole.trimmed_body, **_without(whole.trimmed_body, count))
    bare.__dict__["trimmed_body"] = dropped
    error, without = (
        np.linalg.norm(other - exact, axis=1) / np.linalg.norm(exact, axis=1)
        for other in (found, bare.matrix_frf(channels, low))
    )
    # What a force at one attachment moves at another is left out, so half of it is mended: 1.8 for 3.1 %.
    assert error.max() < 0.02
    assert np.all(error < 0.65 * without)


def _without(body, count):
    names = ("frequencies", "damping_ratio", "shapes", "mode_names")
    return {name: getattr(body, name)[:count] for name in names} | {"derived": True}


def test_both_engines_run_it_and_the_energy_closes(truncated, high_piece):
    both = {engine: truncated.run(high_piece, engine=engine) for engine in ("mujoco", "reduced")}
    energies = both["mujoco"].recording.statistics.energies
    assert energies is not None and energies.residual < 1e-3
    for name in ("engine_acc_z", "seat_rail_acc_z", "knuckle_fr_acc_z"):
        size = np.std(both["mujoco"][name])
        assert np.std(both["reduced"][name]) == pytest.approx(size, rel=5e-3)
    loads = {
        engine: truncated.run(high_piece, engine=engine, channels=["suspension_mount_fr_force_z"])
        for engine in ("mujoco", "reduced")
    }
    sizes = [np.std(run["suspension_mount_fr_force_z"]) for run in loads.values()]
    assert sizes[1] == pytest.approx(sizes[0], rel=1e-2)


def test_a_limit_below_all_modes_is_refused():
    with pytest.raises(ConfigurationError, match=r"body\.modes_up_to: found 5 Hz, below the first mode at 1"):
        Car.load(None, ["body.modes_up_to=5"]).model  # noqa: B018
    with pytest.raises(ConfigurationError, match=r"body\.modes_up_to: .* flexible = true and"):
        Car.load(None, ["body.modes_up_to=35", "body.attachment_flexibility=false"])
