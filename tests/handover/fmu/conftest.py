"""FMUs of the car of Bommer 2006 that several tests share."""

import pytest

from vehicle.runs.car import Car


@pytest.fixture(scope="session", params=["2", "3"])
def focus_fmu(request, car: Car, tmp_path_factory):
    """FMU of the car, FMI 2.0 and 3.0."""
    pytest.importorskip("fmpy", reason="FMPy is missing: pip install 'vehicle-on-shaker[oracles]'")
    from tests.handover.fmu.master import written

    return written(car, tmp_path_factory.mktemp("fmu"), fmi=request.param)
