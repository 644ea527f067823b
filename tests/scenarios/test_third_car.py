"""The shipped record of a worn damper is that of its script."""

import numpy as np

from scenarios.inputs.make_third_car import main
from vehicle.signals.formats.reader import read_record


def test_the_script_makes_the_shipped_record(tmp_path, monkeypatch):
    monkeypatch.setattr("sys.argv", ["make_third_car", "--output", str(tmp_path)])
    main()
    made, shipped = read_record(tmp_path / "third_car.csv"), read_record("third_car.csv")
    for one, other in zip(made.channels, shipped.channels, strict=True):
        # Rounded to 0.001 m/s2 and 0.1 km/h; another processor may round the last digit otherwise.
        np.testing.assert_allclose(one.values, other.values, rtol=0.0, atol=0.0011)
