"""Plates of long runs: made in blocks, which change nothing."""

import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from vehicle.engines.simulation import plate_arrays
from vehicle.engines.simulation.plate_arrays import PlateArrays

ROAD = random_road(rms=5e-4, seed=2, wheel="fr", duration=3.0)


@pytest.mark.parametrize(
    "rows", [(0, 1), (0, 40), (1, 9), (2, 3), (700, 900), (5990, 6001), (6000, 6003), (6002, 6011)]
)
def test_some_rows_are_those_of_all(rows):
    arguments = (ROAD, 5e-4, 6000, ("fr", "fl"), 10)
    every, some = PlateArrays.of(*arguments), PlateArrays.of(*arguments, slice(*rows))
    for name in ("displacement", "velocity", "acceleration", "row_velocity", "slope_velocity"):
        whole = getattr(every, name)
        assert len(whole) == 6011
        np.testing.assert_allclose(
            getattr(some, name), whole[slice(*rows)], rtol=0.0, atol=1e-9 * np.max(np.abs(whole)), err_msg=name
        )


def test_a_run_in_blocks_is_the_same(car, monkeypatch):
    whole = car.run(ROAD)
    monkeypatch.setattr(plate_arrays, "BLOCK", 0)
    blocks = car.run(ROAD)
    np.testing.assert_array_equal(blocks.recording.pose_time, whole.recording.pose_time)
    np.testing.assert_allclose(blocks.recording.poses, whole.recording.poses, rtol=0.0, atol=1e-9)
    for name, values in whole.recording.channels.items():
        size = np.max(np.abs(values))
        np.testing.assert_allclose(blocks[name], values, rtol=0.0, atol=1e-7 * size, err_msg=name)
    ends = blocks.recording.statistics.energies, whole.recording.statistics.energies
    assert ends[0].work_in == pytest.approx(ends[1].work_in, rel=1e-9)
    assert ends[0].dissipated == pytest.approx(ends[1].dissipated, rel=1e-9)
