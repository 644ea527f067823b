"""Tables of published cars: loads and ride frequencies by hand, and the same car from the table of the new car."""

import math

import numpy as np
import pytest

from tests.studies.tables.made_tables import CHRONO, HEAVE, TABLES, WISHBONES
from tests.validation import validated
from vehicle.commands.new import main
from vehicle.engines.kinematics.axle_ride import axle_rides
from vehicle.runs.car import Car
from vehicle.studies.design.axle_types import AXLE_TYPES, axle_type_names
from vehicle.studies.design.template_car import template_car
from vehicle.studies.tables.car_table import car_table

G = 9.81
TYPES = {name: axle_type_names(name) for name in AXLE_TYPES}


def made(folder, *words):
    assert main([str(folder), "--from", "sedan", "--json", *words]) == 0
    return Car.load(folder / "vehicle.toml")


def by_hand(table):
    """Return loads [kg] and ride frequencies [Hz]: m_s = load / 2 - m_u / 2, K = K_w K_t / (K_w + K_t)."""
    loads = (table.front, table.kerb - table.front)
    frequencies = []
    for load, unsprung, wheel, tyre in zip(loads, table.unsprung, table.wheel_rate, table.tyre, strict=True):
        sprung = (load - unsprung) / 2.0
        frequencies.append(math.sqrt(1.0 / (1.0 / wheel + 1.0 / tyre) / sprung) / (2.0 * math.pi))
    return np.array(loads), np.array(frequencies)


def of_car(car):
    loads, rides = car.static.tyre_load, axle_rides(car.model, roll=False)
    axles = [(loads["fr"] + loads["fl"]) / G, (loads["rr"] + loads["rl"]) / G]
    return np.array(axles), np.array([rides[name].ride_frequency for name in ("front", "rear")])


def numbers(path):
    return car_table([path], template_car("sedan").point_names, TYPES).numbers


@pytest.mark.parametrize("table", TABLES, ids=[table.name for table in TABLES])
def test_a_published_table_gives_its_loads_and_ride_frequencies_and_its_own_table_gives_the_same_car(table, tmp_path):
    file = table.write(tmp_path)
    car = made(tmp_path / "car", "--table", str(file))
    (loads, frequencies), (loads_by_hand, frequencies_by_hand) = of_car(car), by_hand(table)
    validated(
        "Published cars", f"table {table.name}: axle loads of the new car", loads, loads_by_hand,
        source=f"publication: {table.source}; closed form of its numbers", rel=2e-3, unit="kg",
    )  # fmt: skip
    validated(
        "Published cars", f"table {table.name}: ride frequencies of the new car", frequencies, frequencies_by_hand,
        source=f"publication: {table.source}; closed form of its numbers", rel=table.ride, unit="Hz",
    )  # fmt: skip
    # Round trip: its own table, in the words of the program, has the same numbers, and gives the same car.
    own, read = tmp_path / "car" / "table.csv", numbers(file)
    again = numbers(own)
    # Newton's method meets masses within 0.1 %.
    assert {key: again[key] for key in read} == pytest.approx(read, rel=1e-3)
    if table in (CHRONO, HEAVE, WISHBONES):
        again = made(tmp_path / "again", "--table", str(own))
        assert of_car(again)[0] == pytest.approx(loads, rel=1e-4)
        assert of_car(again)[1] == pytest.approx(frequencies, rel=1e-4)
        for axle in ("front", "rear"):
            for name, point in car.vehicle.table[axle]["hardpoints"].items():
                assert again.vehicle.table[axle]["hardpoints"][name] == pytest.approx(point, abs=3e-6), name
