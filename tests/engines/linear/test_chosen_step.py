"""A car without a time step gets the largest sufficient step."""

from vehicle.model.parameters.shipped import FOCUS_FILE
from vehicle.model.parameters.toml_file import read_table
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.runs.car import Car


def without_step(**mount):
    table = read_table(FOCUS_FILE)
    del table["solver"]["timestep"]
    table["front"]["bushings"]["suspension_mount"] |= mount
    return Car(vehicle_of(table, FOCUS_FILE.parent), folder=FOCUS_FILE.parent)


def test_the_step_is_halved_until_it_is_sufficient():
    assert without_step().stepped().vehicle.solver.timestep == 1e-3
    car = without_step(stiffness=[3e6, 3e6, 3e7])
    assert car.stepped().vehicle.solver.timestep == 5e-4  # what the refusal of 1e-3 advises
    assert car.stepped() is car.stepped()
