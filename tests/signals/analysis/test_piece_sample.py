"""Totals from a sample of pieces: exact cases, and coverage of the stated interval."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.signals.analysis.piece_sample import half_interval, sample_pieces

NONE = np.zeros(40, dtype=bool)


def lognormal(seed: int, count: int = 40) -> np.ndarray:
    return np.exp(np.random.default_rng(seed).standard_normal(count))


def test_a_quantity_in_proportion_to_the_sizes_has_no_error():
    sizes = lognormal(1)
    sample = sample_pieces(sizes, sizes, 8, NONE)
    known = 3.0 * sizes
    total, residuals = sample.total(0.7 * known[sample.chosen], known)
    assert total == pytest.approx(0.7 * np.sum(known), rel=1e-12)
    assert half_interval(residuals) < 1e-10 * total


def test_all_pieces_give_their_sum_without_an_error():
    values, sizes = lognormal(2), lognormal(3)
    for count, always in ((40, NONE), (8, ~NONE)):
        sample = sample_pieces(sizes, sizes, count, always)
        total, residuals = sample.total(values, sizes)
        assert sample.chosen.tolist() == list(range(40)) and not sample.drawn.any()
        assert total == pytest.approx(np.sum(values), rel=1e-12) and half_interval(residuals) == 0.0


def test_large_and_chosen_pieces_are_certain_and_the_others_drawn_by_size():
    sizes = np.concatenate([[500.0, 100.0], np.arange(1.0, 39.0)])
    always = NONE.copy()
    always[20] = True
    sample = sample_pieces(sizes, sizes, 6, always)
    certain = sample.chosen[~sample.drawn].tolist()
    # Of sum 722 without the certain ones, a piece above 722/6 would reach the probability 1, but 100 does not.
    assert certain == [0, 20] and sample.drawn.sum() == 6 and len(set(sample.chosen.tolist())) == 8
    drawn = sample.chosen[sample.drawn]
    rest = np.sum(sizes) - np.sum(sizes[[0, 20]])
    assert sample.probability[sample.drawn] == pytest.approx(6.0 * sizes[drawn] / rest)
    # A piece of each sixth of the sum, in the order of size.
    parts = np.cumsum(np.sort(np.delete(sizes, [0, 20])))
    positions = np.searchsorted(parts, (np.arange(6) + 0.5) * rest / 6.0)
    assert sorted(sizes[drawn]) == np.sort(np.delete(sizes, [0, 20]))[positions].tolist()


def test_coverage_of_the_interval_where_the_ratio_changes_with_the_size():
    """3 % scatter of the ratio, and a ratio that falls with the level, as that of a car with friction."""
    inside, scatter = [], []
    for seed in range(2000):
        rng = np.random.default_rng(seed)
        sizes = np.exp(rng.standard_normal(60))
        values = sizes * (1.0 - 0.02 * np.log(sizes)) * (1.0 + 0.03 * rng.standard_normal(60))
        sample = sample_pieces(sizes, sizes, 8, np.zeros(60, dtype=bool))
        total, residuals = sample.total(values[sample.chosen], sizes)
        inside.append(abs(total - np.sum(values)) < half_interval(residuals))
        scatter.append(total / np.sum(values) - 1.0)
    validated(
        "Statistics and intervals", "coverage of a total from 8 of 60 pieces, 2000 records", np.mean(inside), 0.95,
        within=(0.93, 0.99), source="second derivation: the sums of all pieces",
    )  # fmt: skip
    assert abs(np.mean(scatter)) < 1e-3


def test_one_drawn_piece_has_no_error_to_state():
    assert half_interval(np.array([0.3])) == 0.0
