"""Notice on the mode whose peak a run-up lowers: delay without damping, and modes that the force does not excite."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from vehicle.runs.car.run_up_notice import run_up_notice
from vehicle.signals.analysis.run_up_peak import run_up_peak


def test_a_mode_without_damping_passes_like_a_chirp():
    """First maximum of |C + i S| from -infinity at v = 1.2172 (Abramowitz and Stegun, table 7.7), v = t sqrt(2 r)."""
    for damping in (1e-4, 1e-12):
        _, late = run_up_peak(15.0, damping, 3.8)
        assert late == pytest.approx(1.2172 * np.sqrt(3.8 / 2.0), rel=0.01)  # grid of 801 points


def test_the_notice_names_no_mode_that_the_force_does_not_excite():
    """An undamped mode across the force was "5.9e+11 Hz late"."""

    def mode(frequency, damping, shape):
        return SimpleNamespace(frequency=frequency, damping_ratio=damping, shape=np.array(shape, dtype=complex),
                               modal_a=100.0 + 0j, description=f"at {frequency} Hz")  # fmt: skip

    modes = [mode(40.0, 0.03, [1.0, 1e-9]), mode(30.0, 1e-12, [1e-9, 1.0])]
    force = SimpleNamespace(run_up=True, harmonics={2.0 * 314.0: 40.0 + 0j}, speed=314.0)
    run_up = SimpleNamespace(speeds=(73.0, 314.0), times=(0.0, 8.0))
    composition = SimpleNamespace(forces=[force], crank_run_up=run_up)
    system = SimpleNamespace(outputs=["a"], output=lambda name: (np.eye(2), np.zeros((2, 0))))
    matrices = SimpleNamespace(system=system, force_rows=np.array([[1.0, 0.0]]))
    car: Any = SimpleNamespace(vehicle=SimpleNamespace(composition=composition), matrices=matrices)
    car.modes = lambda highest: modes
    (notice,) = run_up_notice(car)
    assert "the mode at 40 Hz" in notice and "Hz late" in notice
    matrices.force_rows = np.array([[0.0, 1.0]])
    assert "the mode at 30 Hz" in run_up_notice(car)[0]
