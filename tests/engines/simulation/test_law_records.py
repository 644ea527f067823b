"""A law along three axes with more numbers than those of today."""

import numpy as np

from tests.engines.simulation.row_model import Stepper, add_bushing, add_free_body, element_law, empty_spec

FURTHER = np.arange(26.0) + 0.5


def stepper(further: np.ndarray) -> Stepper:
    """Return two masses on bushings, the second of which has further numbers in its law."""
    spec = empty_spec(1e-3)
    for name, more in (("a", np.zeros(0)), ("b", further)):
        body = add_free_body(spec, f"mass_{name}", 1.0, [1.0] * 3)
        law = element_law([1e4] * 3, [10.0] * 3, [2e3] * 3, [0.01] * 3)
        add_bushing(spec, name, body, spec.worldbody, np.concatenate([law, more]))
    run = Stepper(spec)
    run.data.qpos[[0, 7]] = 1e-3
    return run


def test_a_law_along_three_axes_with_40_numbers_gives_the_same_forces() -> None:
    short, long = stepper(np.zeros(0)), stepper(FURTHER)
    assert short.rows.layout.bushings.further.shape == (2, 0)
    np.testing.assert_array_equal(long.rows.layout.bushings.further, [np.zeros(26), FURTHER])
    expected = short.step(50, short.position)
    np.testing.assert_array_equal(long.step(50, long.position), expected)
    assert not np.array_equal(expected[0], expected[-1])
