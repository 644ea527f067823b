"""A record with a wrong length or index is an exception in Python, not a crash or wrong numbers of the core."""

from typing import Any

import mujoco
import numpy as np
import pytest

from tests.core.recorded_march import recorded
from vehicle.core.records import checked, packed, records
from vehicle.engines.simulation.rows import Rows
from vehicle.engines.simulation.simulation_record import packed_simulation
from vehicle.runs.car import Car

CASES = ("stribeck", "presliding", "rolling, with rubber friction", "skyhook", "side forces")
"""Recorded marches that have every section between them."""


@pytest.fixture(scope="module")
def marches() -> dict[str, dict[str, Any]]:
    return {case: recorded(case) for case in CASES}


def shorter(value: Any) -> Any:
    """Return the first half of an array, of one row without its last column."""
    return value[: len(value) // 2] if len(value) > 1 or value.ndim == 1 else np.ascontiguousarray(value[:, :-1])


def refused(fields: dict[str, Any], **other: Any) -> str:
    """Return the name of the field for which a march with other values of these fields is refused, or nothing."""
    try:
        checked("March", packed("March", fields | other), 1)
    except ValueError as error:
        return str(error).partition(":")[0].removeprefix("March.")
    return ""


@pytest.mark.parametrize("case", CASES)
def test_the_records_of_real_runs_fit(marches, case):
    assert refused(marches[case]) == ""


def test_an_array_of_another_length_is_refused(marches):
    found: dict[str, set[str]] = {}
    for fields in marches.values():
        for name, value in fields.items():
            if isinstance(value, np.ndarray) and value.size:
                found.setdefault(name, set()).add(refused(fields, **{name: shorter(value)}))
    arrays = {name for _, name in records()["March"] if isinstance(marches["skyhook"].get(name), np.ndarray)}
    assert set(found) == arrays - {"changes", "own", "own_laws"}
    # Fewer samples, channels, cars or side forces than there is room for do no harm.
    harmless = {name for name, refusals in found.items() if refusals == {""}}
    assert harmless <= {"plate_z", "wanted", "cars", "sides"}, harmless


def test_a_count_or_a_first_row_that_does_not_fit_is_refused(marches):
    rows = marches["stribeck"]["rows"]
    for fields in marches.values():
        for name in ("inputs", "sums", "plates", "dampers"):
            assert refused(fields, **{name: fields[name] + 1000}), name
            assert refused(fields, **{name: -1}), name
        for _, name in records()["Sections"]:
            assert refused(fields, rows={**fields["rows"], name: -1}), name
    for name in ("slip", "gain", "law", "inputs", "work", "direct"):
        assert refused(marches["stribeck"], rows={**rows, name: 10**6}) == f"rows.{name}"
    for name in ("every", "check_every"):
        assert refused(marches["stribeck"], **{name: 0}) == name


@pytest.mark.parametrize("name", ["wanted", "cars", "owners", "sides", "controlled", "tyre_of"])
@pytest.mark.parametrize("value", [-2, 10**6])
def test_an_index_out_of_range_is_refused(marches, name, value):
    tried = 0
    for fields in marches.values():
        indices = np.array(fields[name])
        if indices.size:
            indices[-1] = value
            assert refused(fields, **{name: indices}) == name
            tried += 1
    assert tried


def test_rows_of_mujoco_that_do_not_fit_are_refused():
    car = Car.load("focus", {"front.damper.viscous_law": "degressive"}).model
    rows = Rows(car.model, car.static.preload)
    data = mujoco.MjData(car.model)
    packed_simulation(rows, data)
    dampers, bushings = rows.layout.dampers, rows.layout.bushings
    wrong = {
        "dampers.rows": rows.layout._replace(dampers=dampers._replace(rows=dampers.rows + 10**6)),
        "dampers.laws": rows.layout._replace(dampers=dampers._replace(laws=dampers.laws[:1])),
        "dampers.pieces": rows.layout._replace(dampers=dampers._replace(pieces=dampers.pieces[:-1])),
        "bushings.carriers": rows.layout._replace(bushings=bushings._replace(carriers=bushings.carriers - 10**6)),
        "row_count": rows.layout._replace(row_count=rows.layout.row_count + 3),
    }
    for name, layout in wrong.items():
        rows.layout = layout
        with pytest.raises(ValueError, match=rf"^Simulation\.{name}: its length, or an index in it"):
            packed_simulation(rows, data)
