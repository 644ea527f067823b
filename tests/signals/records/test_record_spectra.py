"""Level of the road of recorded spectra."""

import numpy as np
import pytest

from vehicle.signals.formats.table import Record
from vehicle.signals.records.record_spectra import recorded_spectra


@pytest.mark.parametrize(("road", "wheels"), [({}, ["fr"]), ({"obstacle": "cleat:20x50"}, []), (None, [])])
def test_only_a_road_without_end_has_a_class(road, wheels):
    time = np.arange(0.0, 20.0, 1e-3)
    noise = np.random.default_rng(3).standard_normal(time.size)
    channels = {"plate_fr_displacement": 1e-5 * np.cumsum(noise), "seat_rail_acc_z": noise}
    record = Record(time=time, channels=channels, units={"plate_fr_displacement": "m", "seat_rail_acc_z": "m/s2"})
    road = None if road is None else {"speed_kmh": 80.0, **road}
    assert [*recorded_spectra(record, "run", "", ["seat_rail_acc_z"], road=road).road_levels] == wheels
