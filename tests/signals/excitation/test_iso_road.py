"""Two tracks of ISO 8608: level, relation of the tracks against the integral, delay of the rear, speed."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from tests.validation import foreign, validated
from vehicle.errors import ConfigurationError
from vehicle.signals.analysis.evaluated_span import evaluated_span
from vehicle.signals.analysis.road_level import CLASSES
from vehicle.signals.excitation.iso_road import IsoRoad, Side, drive, isotropic_coherence
from vehicle.signals.excitation.tyre_envelope import CAM_SETS, TyreEnvelope

SPEED, TRACK = 20.0, 1.49


def lines(signal, wheel, skip=2.0):
    """Wavenumber and complex amplitude of the lines of a wheel's road behind the rise."""
    late = signal.time > skip
    z = signal.displacement[wheel][late][:-1]
    window = np.hanning(z.size)
    return np.fft.rfftfreq(z.size, signal.timestep) / SPEED, np.fft.rfft(z * window) / np.sqrt(np.sum(window**2))


def test_each_class_is_four_times_the_one_before():
    assert CLASSES["A"] == 16e-6 and CLASSES["C"] == 256e-6
    validated(
        "Roads and excitation", "levels of the classes A to E", np.array([CLASSES[name] for name in "ABCDE"]),
        np.array([16e-6, 64e-6, 256e-6, 1024e-6, 4096e-6]), rel=1e-12, unit="m3",
        source="standard: ISO 8608, road classes",
    )  # fmt: skip
    assert [CLASSES[b] / CLASSES[a] for a, b in zip("ABCDEFG", "BCDEFGH", strict=True)] == [4.0] * 7


@pytest.mark.parametrize("n", [0.02, 0.1, 0.5])
def test_the_isotropic_plane_against_its_integral(n):
    """Cross spectrum of two parallel tracks as the integral over the cross waves m of an isotropic surface."""

    def surface(m):
        return (n**2 + m**2) ** -1.5

    across = quad(surface, 0.0, np.inf, weight="cos", wvar=2.0 * np.pi * TRACK)[0]
    validated(
        "Roads and excitation", f"coherence of two tracks of an isotropic road at {n:g} cycles/m",
        isotropic_coherence(np.array([n]), TRACK)[0], across / quad(surface, 0.0, np.inf)[0], rel=1e-6,
        source=foreign("scipy", "quad over the cross waves"),
    )  # fmt: skip


def test_the_level_is_that_of_the_class_and_the_tracks_are_related_as_asked():
    powers, cross = [], []
    for seed in range(6):
        road = IsoRoad(level=CLASSES["C"], seed=seed, track=TRACK)
        signal = drive(road, speed=SPEED, wheels={"fr": (0.0, "right"), "fl": (0.0, "left")}, duration=60.0)
        n, right = lines(signal, "fr")
        _, left = lines(signal, "fl")
        powers.append(0.5 * (np.abs(right) ** 2 + np.abs(left) ** 2))
        cross.append((right * left.conj()).real)
    for low, high in ((0.05, 0.1), (0.1, 0.2), (0.5, 1.0), (2.0, 4.0)):
        band = (n >= low) & (n < high)
        # One-sided density over wavenumber: 2 |Z|^2 / rate for the frequency, times the speed.
        density = 2.0 * np.mean(powers, axis=0)[band] / 1000.0 * SPEED
        validated(
            "Roads and excitation", f"level of a road of class C, {low:g} to {high:g} cycles/m",
            np.mean(density * (n[band] / 0.1) ** 2), 256e-6, rel=0.12, unit="m3",
            source="standard: ISO 8608, Gd(0.1 cycles/m) of class C",
        )  # fmt: skip
        share = np.mean(np.mean(cross, axis=0)[band] * n[band] ** 2) / np.mean(np.mean(powers, 0)[band] * n[band] ** 2)
        validated(
            "Roads and excitation", f"relation of two tracks of a made road, {low:g} to {high:g} cycles/m", share,
            np.mean(isotropic_coherence(n[band], TRACK)), abs=0.15, source="closed form: isotropic surface",
        )  # fmt: skip


def test_the_rear_meets_the_same_road_later_by_a_part_of_a_step():
    road = IsoRoad(level=CLASSES["B"], seed=4, track=TRACK, highest=2.0)
    wheelbase = 2.64 + 0.009
    wheels: dict[str, tuple[float, Side]] = {"fr": (0.0, "right"), "fl": (wheelbase, "right")}
    slow = drive(road, speed=SPEED, wheels=wheels, duration=20.0)
    # Sampled a thousand times finer than the delay's fraction, the front signal is looked up where the rear is.
    late = wheelbase / SPEED
    time = slow.time[3000:19000]
    front = np.array([np.sinc((t - late - slow.time) * 1000.0) @ slow.displacement["fr"] for t in time[::997]])
    validated(
        "Roads and excitation", "road of the rear wheel is that of the front wheel, delayed",
        slow.displacement["fl"][3000:19000:997], front, abs=1e-6 * np.max(np.abs(front)) + 2e-6, unit="m",
        source="second derivation: sinc interpolation",
    )  # fmt: skip
    assert not slow.displacement["fl"][: int(late * 1000)].any()


def relative_lines(road, steps, step):
    """Complex amplitudes of the tracks on the lines of a road of one period, over those of the class; (2, lines)."""
    tracks = np.array([np.fft.rfft(road.height(0.0, step, steps, side, 0.4 / step)) for side in ("right", "left")])
    n = np.fft.rfftfreq(steps, step)
    inside = np.flatnonzero((n >= road.lowest) & (n <= road.highest))
    inside = inside[: inside.size // 4 * 4]
    size = np.sqrt(2.0 * road.level * (n[inside] / 0.1) ** -2.0 / (steps * step)) * np.sinc(n[inside] * road.patch)
    return n[inside], tracks[:, inside] * 2.0 / steps / size


@pytest.mark.parametrize("coherence", [0.0, 0.5, 0.9])
def test_over_four_lines_each_track_has_the_power_of_the_class(coherence):
    """Cross terms of mean and difference cancel over a quadruple, on single lines they do not."""
    road = IsoRoad(level=CLASSES["B"], seed=3, track=TRACK, coherence=coherence, patch=0.1)
    _, tracks = relative_lines(road, 10_000, 0.02)
    power = np.abs(tracks) ** 2
    quadruples = power.reshape(2, -1, 4).mean(axis=2)
    cross = (tracks[0] * tracks[1].conj()).reshape(-1, 4).mean(axis=1)
    for name, found, expected in (
        ("level of each track over four lines", quadruples, 1.0),
        ("cross spectrum of the tracks over four lines", cross.real, coherence),
        ("quadrature of the tracks over four lines", cross.imag, 0.0),
    ):
        validated(
            "Roads and excitation", f"{name}, coherence {coherence:g}", found, np.full(found.shape, expected), abs=1e-9,
            source="closed form: class of ISO 8608",
        )  # fmt: skip
    # 1 +- sqrt(1 - g^2) cos(psi - phi), with any phase difference.
    assert np.ptp(power) == pytest.approx(2.0 * np.sqrt(1.0 - coherence**2), rel=0.02)


def test_on_an_isotropic_road_a_quadruple_keeps_a_second_difference():
    """g changes within four lines: the signs + - - + leave 1/2 (Delta^2 sqrt(1 - g^2)) cos theta of a quadruple."""
    road = IsoRoad(level=CLASSES["B"], seed=3, track=TRACK)
    n, tracks = relative_lines(road, 10_000, 0.02)
    cross_terms = np.sqrt(1.0 - isotropic_coherence(n, TRACK) ** 2).reshape(-1, 4)
    rest = np.abs(cross_terms @ [1.0, -1.0, -1.0, 1.0]) / 4.0
    found = np.abs((np.abs(tracks) ** 2).reshape(2, -1, 4).mean(axis=2) - 1.0)
    assert (found <= rest + 1e-9).all() and rest.max() < 0.003
    np.testing.assert_allclose((tracks[0] * tracks[1].conj()).real, isotropic_coherence(n, TRACK), atol=1e-9)
    independent = replace(road, quadruples=False)
    power = (np.abs(relative_lines(independent, 10_000, 0.02)[1]) ** 2).reshape(2, -1, 4).mean(axis=2)
    assert np.abs(power - 1.0).max() > 0.5


def test_a_road_repeats_after_the_evaluated_span():
    """The lead-in is the end of the period, for the late rear wheels and with cams as well."""
    tyre = TyreEnvelope.of(next(iter(CAM_SETS.values())), radius=0.3, patch=0.12)
    wheels: dict[str, tuple[float, Side]] = {"fr": (0.0, "right"), "rl": (2.649, "left")}
    for envelope in (None, tyre):
        road = IsoRoad(level=CLASSES["C"], seed=5, track=TRACK, envelope=envelope)
        signal = drive(road, speed=SPEED, wheels=wheels, duration=9.5, begin=3.5)
        for name in wheels:
            for each in (signal.displacement, signal.profile, signal.slope_velocity):
                if name in each:
                    # From the end of the rise at the rear wheels, 1.13 s, to the end.
                    np.testing.assert_array_equal(each[name][1140:3501], each[name][7140:])
        assert "repeats after 6 s" in signal.source


def test_the_span_holds_each_wave_of_the_class_whole():
    """All of the road is on the lines k/6 s, with the level of the class over quadruples, nothing between them."""
    road = IsoRoad(level=CLASSES["C"], seed=5, track=TRACK, coherence=0.5)
    signal = drive(road, speed=SPEED, wheels={"fr": (0.0, "right")}, duration=9.5, begin=3.5)
    span = signal.displacement["fr"][evaluated_span(signal.time.size, signal.timestep, 3.5)]
    power = np.abs(np.fft.rfft(span)) ** 2 / span.size**2 * 2.0
    frequency = np.fft.rfftfreq(span.size, 1e-3)
    assert span.size == 6000 and 2.0 in frequency
    inside = (frequency >= 0.011 * SPEED) & (frequency <= 10.0 * SPEED)
    assert power[~inside][1:].max() < 1e-20 * power.max()
    n = frequency[inside] / SPEED
    count = n.size // 4 * 4
    relative = (power[inside] * 120.0 / (CLASSES["C"] * (n / 0.1) ** -2.0))[:count].reshape(-1, 4)
    # Where waves are a third of a picometre high, rounding of the heights counts.
    np.testing.assert_allclose(relative.mean(axis=1), 1.0, rtol=1e-6)


def test_the_record_without_a_begin_is_longer_than_the_drive_and_repeats_nowhere():
    road = IsoRoad(level=CLASSES["C"], seed=5, track=TRACK, quadruples=False)
    signal = drive(road, speed=SPEED, wheels={"fr": (0.0, "right"), "rr": (2.6, "right")}, duration=9.5)
    # The sum of waves of the equation in the module, with one pair of phases a line and the period of the record.
    length = (9500 + 1 + 130) * SPEED / 1000.0
    k = np.arange(int(np.ceil(0.011 * length)), int(10.0 * length) + 1)
    n, g = k / length, isotropic_coherence(k / length, TRACK)
    phi, psi = 2.0 * np.pi * np.random.Generator(np.random.PCG64(5)).random((int(k[-1]), 2))[k - 1].T
    size = np.sqrt(2.0 * CLASSES["C"] * (n / 0.1) ** -2.0 / length)
    for sample in (2000, 9500):
        turn = 2.0 * np.pi * n * SPEED * sample / 1000.0
        z = size @ (np.sqrt((1 + g) / 2) * np.cos(turn + phi) + np.sqrt((1 - g) / 2) * np.cos(turn + psi))
        assert signal.displacement["fr"][sample] == pytest.approx(z, abs=1e-12)


def test_tracks_can_be_equal_or_unrelated():
    wheels: dict[str, tuple[float, Side]] = {"fr": (0.0, "right"), "fl": (0.0, "left")}
    for value in (1.0, 0.0):
        road = IsoRoad(level=CLASSES["A"], seed=1, track=TRACK, coherence=value)
        z = drive(road, speed=SPEED, wheels=wheels, duration=30.0).displacement
        if value:
            np.testing.assert_array_equal(z["fr"], z["fl"])
        else:
            assert abs(np.corrcoef(np.diff(z["fr"]), np.diff(z["fl"]))[0, 1]) < 0.05


def test_the_contact_patch_takes_out_waves_of_its_own_length():
    road = IsoRoad(level=CLASSES["A"], seed=1, track=TRACK, coherence=1.0, patch=0.2)
    flat = IsoRoad(level=CLASSES["A"], seed=1, track=TRACK, coherence=1.0)
    steps, step = 20000, 0.01
    with_patch, without = (np.fft.rfft(r.height(0.0, step, steps, "right", 40.0)) for r in (road, flat))
    n = np.fft.rfftfreq(steps, step)
    band = (n > 0.02) & (n < 9.9)
    ratio = np.abs(with_patch[band] / without[band])
    validated(
        "Roads and excitation", "a contact patch of 0.2 m on a road, by wavenumber", ratio,
        np.abs(np.sinc(0.2 * n[band])), abs=1e-9, source="closed form: sinc(n a)",
    )  # fmt: skip
    assert np.min(ratio) < 1e-9  # a wave of 0.2 m is not felt


def test_cams_on_a_periodic_road_know_no_first_position():
    """The cams reach over the ends of the period: a later start is the same road, turned."""
    tyre = TyreEnvelope.of(next(iter(CAM_SETS.values())), radius=0.3, patch=0.12)
    road = IsoRoad(level=CLASSES["E"], seed=1, track=TRACK, envelope=tyre)
    steps, step, later = 4000, 0.02, 1500
    first, second = (road.contact(start, step, steps, "right", 40.0) for start in (0.0, later * step))
    assert first[1] is not None and second[1] is not None
    for before, after in ((first[0], second[0]), (first[1], second[1])):
        np.testing.assert_allclose(np.roll(before, -later), after, atol=1e-9 * np.max(np.abs(before)))


def test_the_slope_of_cams_is_that_of_the_road_that_rises():
    """On waves far longer than the tyre, V tan(beta) w + w' z is the rate of the height, in the rise too."""
    tyre = TyreEnvelope.of(next(iter(CAM_SETS.values())), radius=0.3, patch=0.12)
    road = IsoRoad(level=CLASSES["C"], seed=2, track=TRACK, highest=0.1, envelope=tyre)
    signal = drive(road, speed=SPEED, wheels={"fr": (0.0, "right")}, duration=12.0)
    rate = np.gradient(signal.displacement["fr"], signal.timestep)
    # The cams are 0.1 m apart and 0.5 m long on waves of 10 m: second order in their ratio.
    np.testing.assert_allclose(signal.slope_velocity["fr"], rate, atol=0.01 * np.max(np.abs(rate)))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"level": 0.0}, "level of the road 0.0 m3: .* 0 "),
        ({"coherence": 1.5}, "coherence 1.5: .* 0 to 1"),
        ({"lowest": 2.0, "highest": 1.0}, "wavenumbers 2.0 to 1.0 cycles/m"),
        ({"patch": -0.1}, "contact patch -0.1 m"),
    ],
)
def test_refusals(change, message):
    with pytest.raises(ConfigurationError, match=message):
        IsoRoad(**{"level": 1e-4, "seed": 1, "track": TRACK, **change})


def test_a_road_that_repeats_within_its_shortest_wave_is_refused():
    """One sample of 0.02 m, as of --duration 2.001, holds no wave of at least 0.1 m."""
    road = IsoRoad(level=1e-4, seed=1, track=TRACK)
    with pytest.raises(ConfigurationError, match="less than its shortest wave of 0"):
        road.height(0.0, 0.02, 1, "right", 18.0)
