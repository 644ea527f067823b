"""Records of Python and of the core have one layout; arrays that do not fit are refused, not read as other numbers."""

from typing import NamedTuple, get_type_hints

import numpy as np
import pytest

from vehicle.core.records import LANE_BYTES, core_layout, dtype, layout, packed, records, stored
from vehicle.engines.simulation.element_records import Layout
from vehicle.engines.simulation.sampling import Samples
from vehicle.engines.simulation.step_records import State, Weights
from vehicle.model.laws.control_laws import SETTING


def test_sizes_and_offsets_are_those_of_the_compiler():
    ours = layout()
    assert len(ours) > 300 and ours == core_layout()


def test_a_control_law_has_the_fields_of_its_record():
    assert dtype("Setting") == SETTING


@pytest.mark.parametrize("kind", [Layout, Weights, State, Samples])
def test_records_of_mujoco_have_the_fields_of_their_classes(kind):
    waiting = [kind]
    while waiting:
        this = waiting.pop()
        assert tuple(field.name for field in records()[this.__name__]) == this._fields, this.__name__
        waiting += [hint for hint in get_type_hints(this).values() if hasattr(hint, "_fields")]


class Friction(NamedTuple):
    elements: np.ndarray
    axes: np.ndarray
    stiffness: np.ndarray
    limit: np.ndarray


def test_arrays_are_passed_by_address_and_shape():
    record = Friction(np.arange(3), np.zeros(3, dtype=np.int64), np.ones(3), np.arange(3.0))
    memory = packed("RubberFriction", record).memory
    assert memory.elements.at == record.elements.ctypes.data and list(memory.elements.n) == [3]
    assert memory.limit.at == record.limit.ctypes.data


@pytest.mark.parametrize(
    "wrong", [np.ones(3, dtype=np.float32), np.ones((3, 1)), np.ones(6)[::2], np.ones(3, dtype=np.int64)]
)
def test_another_type_shape_or_order_is_refused(wrong):
    right = np.zeros(3, dtype=np.int64)
    with pytest.raises(TypeError, match=r"RubberFriction\.limit: .* is no double of 1 dimensions"):
        packed("RubberFriction", Friction(right, right, np.ones(3), wrong))


def test_a_stored_record_has_its_arrays_where_it_says():
    record = Friction(np.arange(3), np.zeros(3, dtype=np.int64), np.array([1.5, 2.5, 3.5]), np.arange(3.0))
    content, extents = stored("RubberFriction", record, begin := 4 * LANE_BYTES)
    assert list(extents) == list(Friction._fields)
    for name, (offset, size) in extents.items():
        assert offset % LANE_BYTES == 0
        assert content[offset - begin :][:size] == getattr(record, name).tobytes(), name
