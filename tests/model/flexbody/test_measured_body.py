"""Body model from a modal test only: car with this body against car with the tested body."""

import numpy as np
import pytest

from tests.model.flexbody.modal_test import true_body, write_modes
from tests.validation import validated
from vehicle.commands import body as command
from vehicle.errors import DataError
from vehicle.model.flexbody.sources.residual_table import read_residuals
from vehicle.model.flexbody.superelement_file import read_superelement
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.car import Car
from vehicle.signals.analysis.modal_assurance import mac

RIGID = "body.attachment_flexibility=false"
"""A modal test has no residual flexibility; it is compared with a body that has none either."""


@pytest.fixture(scope="module")
def measured(tmp_path_factory):
    """Return cars with modes of a modal test, exact and with the errors of a careful test."""
    folder = tmp_path_factory.mktemp("test")
    cars = {}
    for name, errors in (("exact", {}), ("noisy", {"noise": 0.02, "scale": 0.03})):
        write_modes(folder / f"{name}.uff", **errors)
        arguments = ["import", str(folder / f"{name}.uff"), "--output", str(folder / f"{name}.toml")]
        assert command.main(arguments) == 0
        cars[name] = Car(load_vehicle(None, [f"body.superelement={name}.toml"]), folder=folder)
    return folder, cars


def frequencies(car):
    """Return the frequencies of the lightly damped modes up to 40 Hz [Hz]."""
    return np.array(
        [mode.frequency for mode in car.modes("stuck") if mode.frequency < 40.0 and mode.damping_ratio < 0.2]
    )


def seat_rail(car, piece):
    """Return the RMS of the vertical acceleration of the seat rail, 2 to 50 Hz [m/s2]."""
    return car.run(piece, engine="reduced").comfort().unweighted.z


def test_shapes_of_a_test_are_mapped_and_scaled(measured):
    folder, _ = measured
    body, want = read_superelement(folder / "exact.toml"), true_body()
    np.testing.assert_allclose(body.frequencies, want.frequencies, rtol=1e-5)  # six digits in the file
    for point in load_vehicle(None).composition.attachments():
        shape = body.shape_at(point)
        sign = np.sign(np.sum(shape * want.shape_at(point), axis=0))
        np.testing.assert_allclose(shape * sign, want.shape_at(point), atol=2e-5 * np.abs(want.shapes).max())
    noisy = read_superelement(folder / "noisy.toml")
    assert np.diag(mac(noisy.shapes, body.shapes)).min() > 0.999  # 2 % of a component: 1 - 0.02^2


def test_the_car_on_exact_modes_is_the_car_on_the_body(measured, high_piece):
    _, cars = measured
    true = Car.load(overrides=[RIGID])
    # places have five digits
    validated(
        "Body models", "frequencies of the car on modes of a modal test", frequencies(cars["exact"]), frequencies(true),
        rel=1e-3, unit="Hz", source="second derivation: car on the body that was tested",
    )  # fmt: skip
    assert seat_rail(cars["exact"], high_piece) == pytest.approx(seat_rail(true, high_piece), rel=1e-3)


def test_errors_of_a_test_change_the_car_less_than_themselves(measured, high_piece):
    """A scale error of 3 % is a modal-mass error of 6 %: at most 3 % of a frequency with all energy in this mode."""
    _, cars = measured
    true = Car.load(overrides=[RIGID])
    noisy, want = frequencies(cars["noisy"]), frequencies(true)
    validated(
        "Body models", "frequencies of the car on modes of a test with noise and 3 % of scale", noisy, want, rel=0.01,
        unit="Hz", source="second derivation: car on the body that was tested",
    )  # fmt: skip
    assert np.abs(noisy / want - 1.0).max() > 1e-3  # the errors did reach the car
    assert seat_rail(cars["noisy"], high_piece) == pytest.approx(seat_rail(true, high_piece), rel=0.03)


def test_what_a_test_does_not_see_is_the_residual_flexibility(measured, high_piece, car):
    """Without local flexibility of mounts, the engine mounts are up to 8 % too stiff; the seat rail hardly changes."""
    _, cars = measured
    ratio = frequencies(cars["exact"]) / frequencies(car)
    assert 1.05 < ratio.max() < 1.08 and ratio.min() > 0.999
    assert seat_rail(cars["exact"], high_piece) == pytest.approx(seat_rail(car, high_piece), rel=0.02)


def test_measured_residuals_bring_back_what_a_test_does_not_see(measured, car):
    """With the local stiffness of every attachment measured on the true body [N/mm], the car equals the true car."""
    folder, _ = measured
    rows = ["point,x [N/mm],y [N/mm],z [N/mm]"]
    for name, flexibility in car.trimmed_body.residual.items():
        rows.append(f"{name}," + ",".join(f"{1e-3 / value:.9g}" for value in np.diag(flexibility)))
    (folder / "stiffness.csv").write_text("\n".join(rows), encoding="utf-8")
    arguments = ["import", str(folder / "exact.uff"), "--output", str(folder / "whole.toml")]
    assert command.main([*arguments, "--residual", str(folder / "stiffness.csv")]) == 0
    whole = Car(load_vehicle(None, ["body.superelement=whole.toml"]), folder=folder)
    np.testing.assert_allclose(frequencies(whole), frequencies(car), rtol=1e-3)  # 7 % without them
    assert "measured residual flexibility at 15 points" in whole.trimmed_body.provenance


@pytest.mark.parametrize(
    ("text", "message"),
    {
        "no unit": ("point,x,y,z\nseat,1,1,1", r"must be point,x \[N/m\],y \[N/m\],z \[N/m\] for stiffnesses"),
        "unknown": ("point,x [m/N],y [m/N],z [m/N]\nbonnet,1e-7,1e-7,1e-7", "'bonnet' is not a point of the car"),
        "twice": ("point,x [N/m],y [N/m],z [N/m]\nseat,1e7,1e7,1e7\nseat,1e7,1e7,1e7", "'seat' occurs twice"),
        "zero": (
            "point,x [N/m],y [N/m],z [N/m]\nseat,1e7,0,1e7",
            "seat: found 1e[+]07,0,1e[+]07, must be three numbers",
        ),
        "word": ("point,x [N/m],y [N/m],z [N/m]\nseat,1e7,stiff,1e7", "must be three numbers above 0"),
        "empty": ("", "found the header ''"),
    }.values(),
)
def test_a_bad_table_of_residuals_is_refused(text, message, tmp_path):
    file = tmp_path / "residual.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(DataError, match=message):
        read_residuals(file, ("seat", "seat_rail"))
