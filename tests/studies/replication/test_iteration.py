"""The iteration on systems whose answer is known in closed form: two masses between two plates, and a false FRF."""

from __future__ import annotations

import numpy as np
import pytest
import scipy

from tests.validation import validated
from vehicle.studies.replication.inverse import LEAST_SHARE, Lines, regularised_inverse
from vehicle.studies.replication.iteration import HALVINGS, replicate

STEP, SAMPLES, BAND = 1e-3, 8000, (1.0, 50.0)
MASS, SPRING, DASHPOT = np.diag([40.0, 60.0]), np.array([[2.5e5, -4e4], [-4e4, 3e5]]), np.diag([900.0, 1200.0])
PLATES = np.diag([2.1e5, 2.6e5])
"""M x'' + C x' + K x = B z."""


class TwoMasses:
    """Marches the states exactly for plates that are straight between the samples; knows its FRF in closed form.

    Straight pieces weaken 30 Hz by sinc^2(30 Hz STEP), 0.3 %.
    """

    def __init__(self, sign: float = 1.0, outputs: int = 2) -> None:
        self.sign, self.outputs, self.runs = sign, outputs, 0

    def run(self, drive):
        self.runs += 1
        inverse = np.linalg.inv(MASS)
        state = np.block([[np.zeros((2, 2)), np.eye(2)], [-inverse @ SPRING, -inverse @ DASHPOT]])
        push = np.vstack([np.zeros((2, 2)), inverse @ PLATES])
        system = scipy.signal.StateSpace(state, push, state[2:], push[2:])
        found = scipy.signal.lsim(system, drive.T, STEP * np.arange(drive.shape[1]))[1].T
        return np.vstack([found, found.sum(axis=0)])[: self.outputs]

    def frf(self, frequency):
        s = 2j * np.pi * frequency[:, None, None]
        found = s**2 * np.linalg.solve(MASS * s**2 + DASHPOT * s + SPRING, PLATES.astype(complex))
        found = np.concatenate([found, found.sum(axis=1, keepdims=True)], axis=1)
        return self.sign * np.moveaxis(found, 0, -1)[: self.outputs]


@pytest.fixture(scope="module")
def plates():
    """Two unrelated plates that hold 2 to 30 Hz, and rest at both ends."""
    random = np.random.default_rng(3)
    sections = scipy.signal.butter(4, (2.0, 30.0), "bandpass", fs=1.0 / STEP, output="sos")
    window = scipy.signal.windows.tukey(SAMPLES, 0.2)
    return 1e-3 * window * scipy.signal.sosfiltfilt(sections, random.standard_normal((2, SAMPLES)))


@pytest.mark.parametrize("outputs", [2, 3])
def test_a_linear_system_is_met_in_few_steps(plates, outputs):
    """As many responses as plates, and one more that follows from the others.

    What the first step leaves is the share that the regularisation keeps back, 1 % where T is a tenth of its largest.
    """
    plant, lines = TwoMasses(outputs=outputs), Lines(SAMPLES, STEP, BAND)
    target = plant.run(plates)
    found = replicate(plant, target, lines, iterations=9, gain=1.0, tolerance=1e-3)
    assert found.reached and found.steps[0].error < 0.02 and len(found.steps) <= 3
    assert (np.std(lines.in_band(found.drive - plates), axis=1) < 0.01 * np.std(plates)).all()


def test_a_smaller_gain_leaves_its_rest(plates):
    """Each step of the gain G leaves 1 - G of the error of a linear system."""
    plant, lines = TwoMasses(), Lines(SAMPLES, STEP, BAND)
    found = replicate(plant, plant.run(plates), lines, iterations=3, gain=0.6, tolerance=1e-6)
    validated(
        "Sweeps, tuning and optimisation", "error of a drive after one, two and three iterations with gain 0.6",
        np.array([step.error for step in found.steps]), np.array([0.4, 0.16, 0.064]), rel=0.05,
        source="closed form: (1 - G)^n",
    )  # fmt: skip
    assert not found.reached and "3 iterations" in found.outcome


def test_a_false_frf_diverges_and_is_stopped(plates):
    """Its sign is wrong: every step makes the error larger, and is taken back."""
    plant, lines = TwoMasses(sign=-1.0), Lines(SAMPLES, STEP, BAND)
    target = plant.run(plates)
    found = replicate(plant, target, lines, iterations=20, gain=0.8, tolerance=1e-3)
    assert [step.gain for step in found.steps] == [0.8 / 2**n for n in range(HALVINGS)]
    assert "diverging" in found.outcome and found.error > 1.0 and not found.drive.any()


def test_what_cannot_be_run_ends_it(plates):
    plant, lines = TwoMasses(), Lines(SAMPLES, STEP, BAND)
    target = plant.run(plates)
    found = replicate(
        plant, target, lines, iterations=9, gain=0.5, tolerance=1e-3,
        possible=lambda drive: (drive, "too far" if np.std(drive[0]) > 0.8 * np.std(plates[0]) else ""),
    )  # fmt: skip
    assert found.outcome == "too far" and [step.kept for step in found.steps] == [True, True]
    assert found.error == pytest.approx(0.25, rel=0.05)


def test_weak_lines_are_not_inverted():
    """T = 1 is inverted but for a share of the limit squared; T = 1e-4 gives next to nothing, not ten thousand."""
    frequency = np.array([2.0, 10.0])
    square = (2j * np.pi * frequency) ** 2
    found = regularised_inverse((square * [1.0, 1e-4])[None, None], frequency, np.array([7.0]))[:, 0, 0]
    assert found[0] * square[0] == pytest.approx(1.0 / (1.0 + LEAST_SHARE**2), rel=1e-12)
    assert abs(found[1] * square[1]) == pytest.approx(1e-4 / (1e-8 + LEAST_SHARE**2), rel=1e-9)
