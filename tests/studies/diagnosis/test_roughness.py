"""Roughness index of simulated roads: the closed form of a class, and levels of pieces of 100 m."""

import numpy as np
import pytest

from vehicle.signals.analysis.roughness_index import AVERAGED, INPUT, SPEED, STATE
from vehicle.signals.excitation.road_drive import CONTACT_PATCH
from vehicle.signals.excitation.signal import Signal, uniform_time
from vehicle.studies.diagnosis.drawn_road import DrawnRoad
from vehicle.studies.diagnosis.learned import Posterior
from vehicle.studies.diagnosis.roughness import PieceFit, Pieces, road_index

RATE, V = 250.0, 22.0


@pytest.mark.parametrize(("level", "waviness"), [(64e-6, 2.0), (256e-6, 1.8)])
def test_the_index_is_that_of_the_density(level, waviness):
    """IRI = sqrt(2/pi) sigma of a Gaussian road, sigma^2 = integral of (2 pi n)^2 G(n) |H(n)|^2 dn."""
    road = DrawnRoad(level=level, waviness=waviness, track=1.5, variation=0.0, speed=V)
    signal = road.signal({"fl": (0.0, "left"), "fr": (0.0, "right")}, 400.0, RATE, 80.0, np.random.default_rng(1))
    found, ratios = road_index(signal, ["fl", "fr"], V / RATE, 0)
    n = np.geomspace(0.011, 3.6, 4000)
    states = np.linalg.solve(2j * np.pi * n[:, None, None] * SPEED * np.eye(4) - STATE, INPUT[:, None])[:, :, 0]
    gain = np.abs(states[:, 0] - states[:, 2]) * np.sinc(n * AVERAGED) * np.sinc(n * CONTACT_PATCH)
    sigma = np.sqrt(np.trapezoid((2.0 * np.pi * n * gain) ** 2 * level * (n / 0.1) ** -waviness, n))
    # 8.8 km of each of two tracks: 0.5 % by chance.
    assert 10.0**found == pytest.approx(1e3 * np.sqrt(2.0 / np.pi) * sigma, rel=0.02)
    # The pieces of a steady road: 5 % by chance, mean of two tracks.
    assert np.std(ratios[:-1]) < 0.07
    assert np.mean(ratios[:-1]) == pytest.approx(0.0, abs=0.02)


def test_a_piece_twice_as_rough_has_twice_the_index():
    """A sensor that measures the height itself: levels of pieces follow the road exactly."""
    rng = np.random.default_rng(2)
    pieces = Pieces.of(RATE, V, 40.0)
    levels, ratios = [], []
    for _ in range(6):
        factors = np.repeat(rng.uniform(0.5, 2.0, 8), pieces.samples)
        noise = rng.standard_normal((1, factors.size)) * factors
        heights = 1e-4 * np.cumsum(noise[0])
        plates = Signal(time=uniform_time(samples=heights.size, timestep=1.0 / RATE), displacement={"fl": heights},
                        source="made")  # fmt: skip
        levels.append(pieces.levels([noise]))
        ratios.append(road_index(plates, ["fl"], V / RATE, 0)[1])
    fit = PieceFit.of(levels, ratios)
    assert fit is not None
    # ln IRI over the logarithm of a mean square: the coefficients of all bands add up to one half.
    assert fit.coefficients[1:].sum() == pytest.approx(0.5, abs=0.05)
    overall = Posterior(draws=np.full(100, np.log10(4.0)), weights=np.full(100, 0.01), prior=1.0)
    quiet, rough = fit.index(overall, np.log(np.array([[0.5], [2.0]]) ** 2) * np.ones(len(pieces.edges) - 1))
    # A piece with the mean square of the drive; the mean of |x| is at most 8 % below its RMS over 0.5 to 2.
    (usual,) = fit.index(overall, np.zeros((1, len(pieces.edges) - 1)))
    assert usual.quantile(0.5) == pytest.approx(4.0, rel=0.1)
    assert rough.quantile(0.5) / quiet.quantile(0.5) == pytest.approx(4.0, rel=0.1)


def test_short_drives_have_no_pieces():
    pieces = Pieces.of(RATE, 8.0, 40.0)
    levels = pieces.levels([np.random.default_rng(3).standard_normal((2, 2000))])
    assert levels.shape == (0, 2 * (len(pieces.edges) - 1))
    assert PieceFit.of([levels], [np.zeros(0)]) is None
