"""The pictures of a run: they exist, name their units, and are the same bytes every time."""

import dataclasses
import sys
from typing import Any

import matplotlib
import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from tests.drawing.rendering.conftest import FakeCar, FakeRun, fabricated
from vehicle.drawing.rendering import plots
from vehicle.drawing.rendering.excerpt import liveliest_window
from vehicle.drawing.rendering.figure import FADED, wrapped_phase
from vehicle.drawing.rendering.frf_plot import plot_frfs
from vehicle.drawing.rendering.plots import distinct, envelope, plot_frf, plot_time
from vehicle.drawing.rendering.recorded_run import liveliest
from vehicle.drawing.rendering.tornado_plot import ROUGHER, SMOOTHER, draw_tornado
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.analysis.motion_response import MotionResponse

CHANNELS = load_vehicle().acceleration_channels


@pytest.fixture(scope="module")
def long_run(car):
    recording = fabricated(car, 4.0)
    # Velocity white: displacement with 1/f, so that every frequency of the picture is driven.
    noise = np.random.default_rng(1).normal(size=recording.time.size)
    recording.channels["plate_fr_displacement"][:] = 1e-5 * np.cumsum(noise)
    return FakeRun(car=FakeCar(model=car), recording=recording)


@pytest.fixture(scope="module")
def response():
    frequency = np.arange(1.0, 50.0, 0.1)
    rows = len(CHANNELS)
    single = frequency**2 / (1.0 - (frequency / 28.0) ** 2 + 0.1j * frequency / 28.0)
    return FrequencyResponse(
        frequency=frequency,
        response=np.outer(np.arange(1, rows + 1), single).astype(np.complex128),
        coherence=np.full((rows, frequency.size), 0.9),
        random_error=0.05 * np.outer(np.arange(1, rows + 1), np.abs(single)),
        averages=np.full((rows, frequency.size), 7.0),
        segments=1,
        window="none",
        estimator="local rational model",
        resolution_hz=0.1,
        reasons=(),
    )


@pytest.fixture
def figures(monkeypatch):
    """Figures as they are saved."""
    kept = []
    save = Figure.savefig

    def keep(figure, *arguments, **options):
        kept.append(figure)
        save(figure, *arguments, **options)

    monkeypatch.setattr(Figure, "savefig", keep)
    return kept


def every_axis(figure):
    return [axis for part in (figure, *figure.subfigs) for axis in part.axes]


def test_frf_plot_names_quantities_and_caption_and_draws_the_asked_channel(long_run, response, tmp_path, figures):
    plot_frf(tmp_path / ".123.frf.png", long_run, response, "shake.csv, RMS 0.25 mm; estimator: local rational model")
    axes = every_axis(figures[0])
    assert {axis.get_ylabel() for axis in axes} - {""} == {
        "acceleration / plate displacement [(m/s²)/m]",
        "phase [deg]",
        "coherence [-]",
    }
    assert {axis.get_xlabel() for axis in axes} - {""} == {"frequency [Hz]"}
    assert axes[0].get_xscale() == axes[0].get_yscale() == "log"
    assert axes[0].get_xlim() == (1.0, 50.0)
    assert figures[0].get_supxlabel() == f"shake.csv, RMS 0.25 mm; estimator: local rational model; {FADED}"
    shown = {text.get_text() for axis in axes[:2] for text in axis.get_legend().get_texts()}
    assert shown >= {
        "knuckle at damper bottom",
        "damper top",
        "body at suspension mount",
        "engine",
        "seat rail",
        "body front",
        "roof, left rear",
    }
    lines = {line.get_label(): line for line in axes[0].get_lines()}
    row = CHANNELS.index("damper_top_fr_acc_z")
    drawn = lines["damper top"].get_ydata()
    there = np.isfinite(drawn)
    assert there.mean() > 0.9
    np.testing.assert_allclose(drawn[there], np.abs(response.response[row])[there])


def test_time_plot_names_quantities_and_leaves_no_global_figure(long_run, tmp_path, figures):
    before = "matplotlib.pyplot" in sys.modules
    plot_time(tmp_path / "time.png", long_run)
    assert ("matplotlib.pyplot" in sys.modules) == before
    axes = every_axis(figures[0])
    assert {axis.get_ylabel().replace("\n", " ") for axis in axes} - {""} == {
        "plate displacement [mm]",
        "acceleration z [m/s²]",
        "damper velocity [mm/s]",
        "tyre force z [kN]",
        "damper force [N]",
    }
    assert {axis.get_xlabel() for axis in axes} - {""} == {"time [s]", "damper velocity [mm/s]"}
    assert "RMS 0.25 mm" in figures[0].get_supxlabel() and "slip velocity" in figures[0].get_supxlabel()


@pytest.mark.parametrize("which", ["frf", "time"])
def test_plots_are_the_same_bytes_whatever_the_user_has_set(long_run, response, tmp_path, which):
    def draw(path):
        if which == "frf":
            plot_frf(path, long_run, response, "caption")
        else:
            plot_time(path, long_run)
        return path.read_bytes()

    first = draw(tmp_path / "first.png")
    with matplotlib.rc_context({"axes.facecolor": "yellow", "xtick.labelsize": 20.0, "axes.grid": False}):
        second = draw(tmp_path / "second.png")
    assert first[:8] == b"\x89PNG\r\n\x1a\n"
    assert first == second


def test_phase_breaks_where_it_wraps():
    angle = np.radians([100.0, 170.0, 190.0, 260.0])
    phase = wrapped_phase(np.exp(1j * angle))
    np.testing.assert_allclose(phase[[0, 1, 3]], [100.0, 170.0, -100.0])
    assert np.isnan(phase[2])


def test_frf_plot_is_grey_where_the_input_tells_nothing_and_shows_the_random_error(
    long_run, response, tmp_path, figures
):
    blank = response.response.copy()
    blank[:, (response.frequency > 20.0) & (response.frequency < 30.0)] = np.nan
    plot_frf(tmp_path / "frf.png", long_run, dataclasses.replace(response, response=blank), "")
    magnitude = every_axis(figures[0])[0]
    grey = next(part for part in magnitude.collections if part.get_label() == "no FRF: no input")
    edges = np.concatenate([path.vertices[:, 0] for path in grey.get_paths()])
    assert (edges.min(), edges.max()) == pytest.approx((20.0, 30.0), abs=0.2)
    bands: Any = [part for part in magnitude.collections if isinstance(part, PolyCollection) and part is not grey]
    assert len(bands) == 4
    top = max(path.vertices[:, 1].max() for path in bands[0].get_paths())
    row = CHANNELS.index("knuckle_fr_acc_z")
    shown = np.abs(response.response[row][(response.frequency < 20.0) | (response.frequency > 30.0)])
    assert top == pytest.approx((1.0 + 1.96 * 0.05) * shown.max(), rel=1e-6)


def test_frfs_to_several_plates_are_lines_that_name_them(long_run, response, tmp_path, figures):
    factors = {"fr": 1.0, "fl": 0.3}
    responses = [
        MotionResponse(motion={wheel: 1.0}, response=dataclasses.replace(response, response=factor * response.response))
        for wheel, factor in factors.items()
    ]
    plot_frfs(tmp_path / "frf.png", long_run, responses, "caption")
    axes = every_axis(figures[0])
    assert figures[0].get_suptitle() == "FRFs from each of 2 plates, which act at once"
    assert [axis.get_title() for axis in axes[:3]] == [
        "Seat rail, vertical",
        "Engine, vertical",
        "Wheel carrier right, vertical",
    ]
    lines = {line.get_label(): line for line in axes[0].get_lines()}
    assert {label for label in lines if label[0] != "_"} == {"plate right", "plate left"}
    row = CHANNELS.index("seat_rail_acc_z")
    drawn = lines["plate left"].get_ydata()
    there = np.isfinite(drawn)
    assert there.mean() > 0.5
    np.testing.assert_allclose(drawn[there], 0.3 * np.abs(response.response[row])[there])
    assert axes[6].get_ylabel() == "multiple coherence [-]"


def test_a_common_motion_is_said_in_the_title(long_run, response, tmp_path, figures):
    for left, words in ((1.0, "right, left"), (-1.0, "right (+1), left (-1)")):
        plot_frfs(
            tmp_path / "frf.png",
            long_run,
            [MotionResponse(motion={"fr": 1.0, "fl": left}, response=response)],
            "",
        )
        assert figures[-1].get_suptitle() == f"FRFs from the common motion of plates {words}"


def test_a_cloud_keeps_its_rare_dots_once():
    common = np.linspace(-1.0, 1.0, 11)
    speed, force = np.tile(common, 1000), np.tile(2.0 * common, 1000)
    speed[4321], force[4321] = 7.0, 3.0
    drawn = set(zip(*distinct(speed, force), strict=True))
    assert drawn == {*zip(common, 2.0 * common, strict=True), (7.0, 3.0)}
    assert [part.tolist() for part in distinct(np.zeros(5), np.zeros(5))] == [[0.0], [0.0]], "a car at rest"


def test_liveliest_stretch():
    time = np.arange(1001) / 100.0
    values = np.where((time > 4.0) & (time < 5.0), 1.0, 0.1)
    assert liveliest(time, values, 1.0) == pytest.approx(4.0, abs=0.011)
    assert liveliest(time, values, 99.0) == 0.0


def test_without_slip_the_knuckle_decides(run):
    start, reason = liveliest_window(run.recording, "fl", "knuckle_fl_acc_z", 1.0, 0.1)
    assert reason == "largest knuckle motion; no slip"
    assert 0.0 <= start <= 0.2


def test_an_envelope_keeps_every_sample_and_has_no_gaps():
    """Each sample is between minimum and maximum of its segment; neighbouring segments share a sample."""
    count = 12_347
    time, values = np.linspace(0.0, 1e-3 * (count - 1), count), np.random.default_rng(1).normal(size=count)
    values[[0, 5003, count - 1]] = 90.0, -80.0, 70.0  # of a single sample each, at both ends too
    at, low, high = envelope(time, values)
    assert at.size == low.size == high.size == plots.SEGMENTS and np.all(np.diff(at) > 0.0)
    length = time[-1] / plots.SEGMENTS
    for middle, bottom, top in zip(at, low, high, strict=True):
        inside = values[np.abs(time - middle) <= 0.5 * length - 1e-3]
        around = values[np.abs(time - middle) <= 0.5 * length + 1e-3]
        assert around.min() <= bottom <= inside.min() and inside.max() <= top <= around.max()
    assert np.all(low[1:] <= high[:-1]) and np.all(low[:-1] <= high[1:])
    assert (low.min(), high[0], high[-1]) == (-80.0, 90.0, 70.0)
    for part in envelope(time[: plots.SEGMENTS], values[: plots.SEGMENTS])[1:]:
        np.testing.assert_array_equal(part, values[: plots.SEGMENTS])


def test_no_error_band_where_the_coherence_is_low(long_run, response, tmp_path, figures):
    """There the band would be wider than the magnitude."""
    low = (response.frequency > 8.0) & (response.frequency < 12.0)
    coherence = np.where(low, 0.49, response.coherence)
    plot_frf(tmp_path / "frf.png", long_run, dataclasses.replace(response, coherence=coherence), "")
    bands: Any = [part for part in every_axis(figures[0])[0].collections if isinstance(part, PolyCollection)]
    assert len(bands) == 4
    for band in bands:
        edges = np.concatenate([path.vertices[:, 0] for path in band.get_paths()])
        assert edges.min() < 8.0 and edges.max() > 12.0
        assert not np.any((edges > 8.0) & (edges < 12.0))


def test_figures_of_runs_that_are_compared_have_equal_scales(long_run, tmp_path, figures):
    louder = dataclasses.replace(
        long_run,
        recording=dataclasses.replace(
            long_run.recording, channels={name: 3.0 * values for name, values in long_run.recording.channels.items()}
        ),
    )
    for run in (long_run, louder):
        plot_time(tmp_path / "time.png", run, page=True, others=[long_run, louder])
    plot_time(tmp_path / "time.png", long_run, page=True)
    limits = [[axis.get_ylim() for axis in every_axis(figure)] for figure in figures]
    assert limits[0] == limits[1] != limits[2]


def test_the_colour_of_a_bar_says_smoother_or_rougher_and_its_text_which_value():
    axis: Any = Figure().subplots()
    changes = np.array([[24.5, -14.8], [-11.4, np.nan]])
    draw_tornado(axis, ["body.mass", "tyre"], changes, np.array([4.1, np.nan]), [("-20 %", "+20 %")] * 2)
    bars = {bar.get_width(): matplotlib.colors.to_hex(bar.get_facecolor()) for bar in axis.patches}
    assert bars == {24.5: ROUGHER, -14.8: SMOOTHER, -11.4: SMOOTHER, 0.0: SMOOTHER}
    texts = [(text.get_text(), *text.xy) for text in axis.texts]
    assert texts == [
        ("-20 %", pytest.approx(28.6), -0.19),
        ("-20 %", -11.4, 0.81),
        ("+20 %", pytest.approx(-18.9), 0.19),
        ("+20 % failed", 0.0, 1.19),
    ]
    assert axis.get_xlabel().endswith("blue: smoother, amber: rougher")


def test_title_and_labels_of_long_parameters_have_room(tmp_path):
    """The title of the axis lies inside the picture, and the text at a bar inside the axes."""
    labels = ["front_subframe.bushings.hydromount.stiffness.z  150000 N/m", "body.mass  1200 kg"]
    figure = Figure(figsize=(8.0, 2.6), layout="constrained")
    axis: Any = figure.subplots()
    draw_tornado(axis, labels, np.array([[-24.5, 14.8], [3.0, -2.0]]), np.array([4.1, 0.5]), [("-20 %", "+20 %")] * 2)
    figure.savefig(tmp_path / "effects.png")
    title, frame = axis.xaxis.label.get_window_extent(), axis.get_window_extent()
    assert figure.bbox.x0 <= title.x0 and title.x1 <= figure.bbox.x1
    for text in axis.texts:
        box = text.get_window_extent()
        assert frame.x0 <= box.x0 and box.x1 <= frame.x1, text.get_text()
