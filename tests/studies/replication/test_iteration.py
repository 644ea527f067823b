"""The iteration on systems with closed-form responses: two masses between two plates, and a wrong FRF."""

import numpy as np
import pytest
import scipy

from tests.validation import validated
from vehicle.studies.replication.drive_settings import DriveSettings
from vehicle.studies.replication.inverse import LEAST_SHARE, Lines, regularised_inverse
from vehicle.studies.replication.iteration import HALVINGS, Plant, replicate

STEP, SAMPLES, BAND = 1e-3, 8000, (1.0, 50.0)
MASS, SPRING, DASHPOT = np.diag([40.0, 60.0]), np.array([[2.5e5, -4e4], [-4e4, 3e5]]), np.diag([900.0, 1200.0])
PLATES = np.diag([2.1e5, 2.6e5])
"""M x'' + C x' + K x = B z."""


class TwoMasses(Plant):
    """Two masses with an exact time integration for piecewise linear plate signals, and closed-form FRFs.

    Linear interpolation weakens 30 Hz by sinc^2(30 Hz STEP), 0.3 %.
    """

    def __init__(self, sign: float = 1.0, outputs: int = 2) -> None:
        self.sign, self.outputs, self.runs = sign, outputs, 0

    def run(self, drive):
        self.runs += 1
        inverse = np.linalg.inv(MASS)
        state = np.block([[np.zeros((2, 2)), np.eye(2)], [-inverse @ SPRING, -inverse @ DASHPOT]])
        push = np.vstack([np.zeros((2, 2)), inverse @ PLATES])
        system = scipy.signal.StateSpace(state, push, state[2:], push[2:])
        response = scipy.signal.lsim(system, drive.T, STEP * np.arange(drive.shape[1]))[1].T
        return np.vstack([response, response.sum(axis=0)])[: self.outputs]

    def frf(self, frequency):
        s = 2j * np.pi * frequency[:, None, None]
        frf = s**2 * np.linalg.solve(MASS * s**2 + DASHPOT * s + SPRING, PLATES.astype(complex))
        frf = np.concatenate([frf, frf.sum(axis=1, keepdims=True)], axis=1)
        return self.sign * np.moveaxis(frf, 0, -1)[: self.outputs]


@pytest.fixture(scope="module")
def plates():
    """Return two independent plate signals of 2 to 30 Hz, at rest at both ends."""
    random = np.random.default_rng(3)
    sections = scipy.signal.butter(4, (2.0, 30.0), "bandpass", fs=1.0 / STEP, output="sos")
    window = scipy.signal.windows.tukey(SAMPLES, 0.2)
    return 1e-3 * window * scipy.signal.sosfiltfilt(sections, random.standard_normal((2, SAMPLES)))


@pytest.mark.parametrize("outputs", [2, 3])
def test_a_linear_system_is_met_in_few_steps(plates, outputs):
    """Use as many responses as plates, and one redundant response more.

    The error after the first step is due to the regularisation, 1 % where T is a tenth of its maximum.
    """
    plant, lines = TwoMasses(outputs=outputs), Lines(SAMPLES, STEP, BAND)
    target = plant.run(plates)
    replication = replicate(plant, target, lines, DriveSettings(iterations=9, gain=1.0, target_error=1e-3))
    assert replication.reached and replication.steps[0].error < 0.02 and len(replication.steps) <= 3
    assert (np.std(lines.in_band(replication.drive - plates), axis=1) < 0.01 * np.std(plates)).all()


def test_a_smaller_gain_leaves_a_share_of_the_error(plates):
    """Check that a step of gain G leaves 1 - G of the error of a linear system."""
    plant, lines = TwoMasses(), Lines(SAMPLES, STEP, BAND)
    replication = replicate(plant, plant.run(plates), lines, DriveSettings(iterations=3, gain=0.6, target_error=1e-6))
    validated(
        "Sweeps, tuning and optimisation", "error of a drive after one, two and three iterations with gain 0.6",
        np.array([step.error for step in replication.steps]), np.array([0.4, 0.16, 0.064]), rel=0.05,
        source="closed form: (1 - G)^n",
    )  # fmt: skip
    assert not replication.reached and "3 iterations" in replication.outcome


def test_a_false_frf_diverges_and_is_stopped(plates):
    """Use an FRF of the wrong sign: every step increases the error and is undone."""
    plant, lines = TwoMasses(sign=-1.0), Lines(SAMPLES, STEP, BAND)
    target = plant.run(plates)
    replication = replicate(plant, target, lines, DriveSettings(iterations=20, gain=0.8, target_error=1e-3))
    assert [step.gain for step in replication.steps] == [0.8 / 2**n for n in range(HALVINGS)]
    assert "diverging" in replication.outcome and replication.error > 1.0 and not replication.drive.any()


def test_an_infeasible_drive_ends_the_iteration(plates, monkeypatch):
    plant, lines = TwoMasses(), Lines(SAMPLES, STEP, BAND)
    target = plant.run(plates)
    limit = 0.8 * np.std(plates[0])
    monkeypatch.setattr(plant, "possible", lambda drive: (drive, "too far" if np.std(drive[0]) > limit else ""))
    replication = replicate(plant, target, lines, DriveSettings(iterations=9, gain=0.5, target_error=1e-3))
    assert replication.outcome == "too far" and [step.kept for step in replication.steps] == [True, True]
    assert replication.error == pytest.approx(0.25, rel=0.05)


def test_weak_lines_are_not_inverted():
    """Check that T = 1 is inverted within the limit squared, and that T = 1e-4 gives about 1, not ten thousand."""
    frequency = np.array([2.0, 10.0])
    square = (2j * np.pi * frequency) ** 2
    inverse = regularised_inverse((square * [1.0, 1e-4])[None, None], frequency, np.array([7.0]))[:, 0, 0]
    assert inverse[0] * square[0] == pytest.approx(1.0 / (1.0 + LEAST_SHARE**2), rel=1e-12)
    assert abs(inverse[1] * square[1]) == pytest.approx(1e-4 / (1e-8 + LEAST_SHARE**2), rel=1e-9)
