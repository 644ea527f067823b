import numpy as np
import pytest

from scenarios.signals.bump import bump, bump_shape
from tests.validation import validated
from vehicle.errors import ConfigurationError


@pytest.mark.parametrize(("reading", "peak"), [("height", 7.5e-3), ("literal", 15e-3)])
def test_bump_is_one_period_with_its_peak_in_the_middle(reading, peak):
    t = np.array([0.0, 4.999, 5.0, 5.0 + 1 / 12, 5.0 + 1 / 6, 5.0 + 1 / 4, 5.0 + 1 / 3, 5.4])
    x = bump_shape(t, amplitude=7.5e-3, reading=reading)
    np.testing.assert_allclose(x, peak * np.array([0, 0, 0, 0.5, 1.0, 0.5, 0, 0]), rtol=0, atol=1e-15)
    # Independent form: (1 - cos a) / 2 = sin^2(a / 2).
    inside = np.linspace(5.001, 5.333, 50)
    expected = peak * np.sin(3.0 * np.pi * (inside - 5.0)) ** 2
    validated(
        "Roads and excitation", f"bump of 7.5 mm, read as {reading}",
        bump_shape(inside, amplitude=7.5e-3, reading=reading), expected, abs=1e-15, unit="m",
        source="closed form: sin^2(a / 2) for (1 - cos a) / 2",
    )  # fmt: skip


def test_bump_noise_has_its_rms_outside_and_runs_on_inside():
    signal = bump(amplitude=7.5e-3, wheel="fr")
    t, z = signal.time, signal.displacement["fr"]
    outside = (t <= 5.0) | (t >= 5.0 + 1.0 / 3.0)
    assert np.std(z[outside]) == pytest.approx(5e-5, rel=1e-12)  # rounding
    noise = z - bump_shape(t, amplitude=7.5e-3)
    assert 1e-5 < np.std(noise[~outside]) < 2e-4  # 1/3 s of a 5e-5 m noise that begins at 2 Hz
    # No seam: the noise changes by no more per step at the ends of the bump than elsewhere.
    steps = np.abs(np.diff(noise))
    at_ends = [4999, 5000, 5333, 5334]
    assert steps[at_ends].max() <= np.quantile(steps, 0.999)
    assert z[0] == 0.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"amplitude": -1.0}, "bump amplitude -1.0 m: must be above 0 and finite"),
        ({"start": 9.8}, "bump at 9.8 s; allowed: 0 to 9.66667 s, so that it ends within the record"),
        ({"noise_rms": -1.0}, "noise RMS -1.0 m: must be above 0 and finite"),
        ({"reading": "tall"}, "reading 'tall' of the bump; allowed: 'height', 'literal'"),
    ],
)
def test_bad_bumps_are_refused(change, message):
    with pytest.raises(ConfigurationError) as caught:
        bump(**{"amplitude": 1e-3, "wheel": "fr", **change})
    assert str(caught.value) == message
