"""Input of the bench that its tests share."""

import pytest

from vehicle import read_signal
from vehicle.handover.bench.drive import bench_drive
from vehicle.signals.excitation.input_files import find_input


@pytest.fixture(scope="session")
def drive(car):
    return bench_drive(car, read_signal(find_input("high.csv"), wheel="fr"), seconds=5.0)
