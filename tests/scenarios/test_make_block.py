"""The pavement of `scenarios.inputs.make_block`: its spectrum, its tracks, its file."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.signal import welch

from scenarios.inputs.make_block import BASE, EDGES, PUBLISHED, RMS, STEP, block_heights, main
from tests.validation import validated
from vehicle.signals.excitation.measured_road import read_road
from vehicle.signals.formats.crg_format import read_surface


def test_the_bands_are_those_of_the_pavement():
    """By the estimate of the published surface: a Hann window over pieces of 10 m, mean over pieces and sections."""
    heights = block_heights(400.0, 3)
    wavenumber, density = welch(heights, 1.0 / STEP, window="hann", nperseg=1001, detrend="linear", axis=0)
    bands = [(wavenumber >= low) & (wavenumber < high) for low, high in pairwise(EDGES)]
    levels = np.array([1e3 * np.sqrt(np.sum(density.mean(axis=1)[band]) * wavenumber[1]) for band in bands])
    published = np.array(PUBLISHED)
    # From 0.55 to 0.75 cycles/m the estimate holds nothing but what the window spreads from the band below.
    of_band = np.array(RMS) > 0.1
    validated(
        "Roads and excitation", "RMS of nine bands from 0.15 to 26 cycles/m of a stone pavement with random phases",
        levels[of_band], published[of_band], rel=0.05, unit="mm",
        source="publication: belgian_block.crg of ASAM OpenCRG, the same estimate",
    )  # fmt: skip
    assert levels[~of_band] == pytest.approx(published[~of_band], rel=0.2)
    assert np.std(1e3 * heights) == pytest.approx(np.sqrt(np.sum(np.square(RMS))), rel=0.01)
    assert abs(np.corrcoef(heights[:, 0], heights[:, -1])[0, 1]) < 0.3


def test_the_file_is_a_road(tmp_path, capsys):
    path = tmp_path / "block.crg"
    assert main(["--output", str(path), "--length", "20"]) == 0
    surface = read_surface(path)
    assert surface.z.shape == (2001, 5) and np.mean(surface.z) == pytest.approx(BASE, abs=1e-4)
    np.testing.assert_allclose(surface.z - BASE, block_heights(20.0, 1), atol=6e-7)
    assert read_road(path, 1.5).length == pytest.approx(20.0)
    with pytest.raises(SystemExit):
        main(["--output", str(path), "--length", "1"])
    assert "must be 10 to 2000 m" in capsys.readouterr().err
