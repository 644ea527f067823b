"""Rows of signals as they stand, and what is refused of them."""

import numpy as np
import pytest

from vehicle.errors import DataError
from vehicle.signals.analysis.samples import checked_rows


def test_a_sequence_of_rows_is_not_copied():
    """A long record stands in memory once."""
    rows = [np.arange(5.0), np.ones(5)]
    found = checked_rows("responses", rows)
    assert [row.shape for row in found] == [(5,), (5,)]
    assert all(np.shares_memory(one, own) for one, own in zip(found, rows, strict=True))


@pytest.mark.parametrize("signals", [np.arange(6.0).reshape(2, 3), [[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]]])
def test_a_table_is_returned_as_rows(signals):
    assert np.array_equal(checked_rows("responses", signals), [[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]])


def test_one_signal_is_one_row():
    assert np.array_equal(checked_rows("responses", np.arange(3.0)), [[0.0, 1.0, 2.0]])


def test_a_lost_sample_is_named_with_its_row():
    with pytest.raises(DataError, match="responses 1: found nan at sample 2"):
        checked_rows("responses", [np.zeros(4), np.array([0.0, 1.0, np.nan, 3.0])])


@pytest.mark.parametrize("signals", [[], [np.zeros(0)], [np.zeros((2, 3)), np.zeros((2, 3))]])
def test_signals_of_wrong_shape_or_length_are_rejected(signals):
    with pytest.raises(DataError, match="responses"):
        checked_rows("responses", signals)
