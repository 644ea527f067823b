"""What a car, a run and its FRFs look like in a notebook, and as tables of pandas and xarray."""

import sys
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.axes import Axes

from vehicle.drawing.notebook.picture import HEIGHT, WIDTH, line_drawing
from vehicle.drawing.notebook.run_orders import named_orders
from vehicle.errors import ConfigurationError, MissingPartError
from vehicle.runs.car import Car
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.analysis.order_lines import OrderLines
from vehicle.signals.analysis.seat_value import weighted_rms_of


@pytest.fixture(scope="module")
def run(car, high_piece):
    return car.run(high_piece, engine="reduced")


@pytest.fixture(scope="module")
def response(run):
    return run.frf(["seat_rail_acc_z", "engine_acc_z"])


def test_each_says_itself_in_a_line(run, response):
    assert repr(Car.load(overrides=["body.mass=900"])) == "Car(focus, wheels fr, fl, body.mass=900)"
    for one in (run.car, run, response):
        assert "\n" not in repr(one) and len(repr(one)) < 200
    assert "4 s, reduced, Car(focus, wheels fr, fl)" in repr(run)
    assert "FRFs of seat_rail_acc_z, engine_acc_z from plate_fr_displacement" in repr(response)


def test_each_has_a_table_and_a_drawing(run, response):
    for one in (run.car, run, response):
        page = ElementTree.fromstring(one._repr_html_())  # well-formed
        assert page.find(".//table") is not None and page.find(".//{http://www.w3.org/2000/svg}svg") is not None
    assert f"{run.comfort().unweighted.overall:.4g} m/s²" in run._repr_html_()


def test_every_plot_returns_axes_and_draws_on_those_of_the_user(run, response, tmp_path):
    pyplot.switch_backend("agg")
    spectra = run.psd(["seat rail z", "engine z"])
    for one, count in ((run, 4), (response, 3), (spectra, 6)):
        axes = one.plot()
        assert axes.size == count and all(isinstance(axis, Axes) and axis.has_data() for axis in axes.ravel())
        axes.ravel()[0].set_title("edited")
        axes.ravel()[0].figure.savefig(tmp_path / "figure.png")
    for one, drawn in ((response, 2), (spectra, 3)):
        _, axis = pyplot.subplots()
        assert one.plot(ax=axis) is axis and len(axis.lines) == drawn
        assert one.plot(ax=axis) is axis and len(axis.lines) == 2 * drawn
        colours = [line.get_color() + str(line.get_linestyle()) for line in axis.lines]
        assert len(set(colours)) == min(len(colours), 5)  # a second plot goes on with the colours
    mixed = run.psd(["seat rail z", "damper force fr", "knuckle fr z"])
    axes = mixed.plot()
    units = {each.name: each.unit for each in mixed.channels}
    assert units["damper_fr_force"] == "N" and axes.shape == (3, 3)
    for one, first in zip(axes.T, axes.T[0:1].repeat(3, axis=0), strict=True):
        same = units[one[0].get_title()] == units[first[0].get_title()]
        assert all(a.get_shared_y_axes().joined(a, b) == same for a, b in zip(one, first, strict=True))
    assert [axis.get_ylabel() for axis in axes[0]] == ["density [(m/s²)²/Hz]", "", "density [N²/Hz]"]
    _, axis = pyplot.subplots()
    for refused in (mixed.plot, lambda ax: [run.plot(name, ax=ax) for name in ("damper force fr", "seat rail z")]):
        with pytest.raises(ConfigurationError, match=r"ax: .* N"):
            refused(ax=axis)
    again = mixed.plot(ax=axes)
    assert [len({line.get_color() for line in axis.lines}) for axis in again[0]] == [2, 2, 2]
    softer = run.car.with_({"damper.viscous": 900}).run(run.signal, "reduced")
    for plot in (lambda one, ax: one.plot("seat rail z", ax), lambda one, ax: one.frf("seat rail z").plot(ax),
                 lambda one, ax: one.psd("seat rail z").plot(ax)):  # fmt: skip
        _, axis = pyplot.subplots()
        texts = [text.get_text() for text in (plot(run, axis), plot(softer, axis))[1].get_legend().get_texts()]
        assert texts[0].startswith("focus") and "damper.viscous" not in texts[0] and "damper.viscous=900" in texts[-1]
    _, axis = pyplot.subplots()
    assert run.plot("seat rail z", ax=axis) is axis
    np.testing.assert_array_equal(axis.lines[0].get_ydata(), run["seat_rail_acc_z"])
    with pytest.raises(ConfigurationError, match="ax: found 2 axes, must be 1"):
        run.plot("seat rail z", ax=[axis, axis])
    pyplot.close("all")


def test_words_name_a_channel(run):
    np.testing.assert_array_equal(run["seat rail vertical"], run["seat_rail_acc_z"])
    np.testing.assert_array_equal(run["damper velocity front left"], run["damper_fl_velocity"])
    assert run.frf("seat rail z").names == ("seat_rail_acc_z",)
    assert run.psd("knuckle fr z").channels[0].name == "knuckle_fr_acc_z"
    with pytest.raises(ConfigurationError, match=r"channel 'steering wheel z'.*choose from"):
        run.frf("steering wheel z")
    with pytest.raises(ConfigurationError, match=r"'damper velocity'.* choose from damper_f"):
        run["damper velocity"]


def test_frfs_of_a_run_are_frfs(run, response):
    assert response.names == ("seat_rail_acc_z", "engine_acc_z")
    assert isinstance(response, FrequencyResponse)
    everything = run.frf()
    row = everything.names.index("engine_acc_z")
    np.testing.assert_allclose(everything.response[row], response.response[1], rtol=1e-9)


def test_tables_hold_the_channels(run, response):
    frame, dataset, table = run.to_dataframe(), run.to_xarray(), response.to_dataframe()
    assert list(frame.columns) == list(run.recording.channels) and frame.index.name == "time [s]"
    np.testing.assert_array_equal(frame["seat_rail_acc_z"].to_numpy(), run["seat_rail_acc_z"])
    assert frame.attrs["units"]["seat_rail_acc_z"] == dataset["seat_rail_acc_z"].attrs["units"] == "m/s2"
    np.testing.assert_array_equal(dataset["damper_fr_velocity"].sel(time=run.time[7]), run["damper_fr_velocity"][7])
    values = table["engine_acc_z"]
    again = values["magnitude"] * np.exp(1j * np.radians(values["phase"]))
    np.testing.assert_allclose(again.to_numpy(), response.response[1], rtol=1e-12)


@pytest.mark.parametrize(("library", "call"), [("pandas", "to_dataframe"), ("xarray", "to_xarray")])
def test_a_missing_library_is_one_sentence(library, call, run, monkeypatch):
    monkeypatch.setitem(sys.modules, library, None)
    one = np.ones((1, 1))
    lines = OrderLines(orders=one[0], frequency=one[0], amplitude=one.astype(complex), error=one, segments=1)
    orders = named_orders(lines, ("seat_rail_acc_z",), ("m/s2",), "crank")
    for each in (run, orders) if library == "pandas" else (run,):
        with pytest.raises(MissingPartError, match=rf"{call}.*{library}.*pip install '.*\[notebook\]'"):
            getattr(each, call)()


def test_a_drawn_line_keeps_its_extremes():
    along = np.linspace(0.0, 1.0, 5000)
    values = np.sin(40.0 * along)
    values[1234] = 5.0
    drawing = ElementTree.fromstring(line_drawing(along, values, "a"))
    line = drawing.find("{http://www.w3.org/2000/svg}polyline")
    assert line is not None
    points = np.array([pair.split(",") for pair in line.attrib["points"].split()], dtype=float)
    assert len(points) <= 2 * WIDTH and points[:, 1].min() == 16.0 and points[:, 1].max() == HEIGHT - 20
    assert line_drawing(along[:1], values[:1], "a") == ""


def test_spectra_and_both_comfort_values(run):
    spectra = run.psd(["seat_rail_acc_z", "engine_acc_z"])
    assert repr(spectra).startswith("Spectra of seat_rail_acc_z, seat_rail_acc_z Wk, engine_acc_z: ")
    assert list(spectra.to_dataframe().columns.levels[0]) == ["engine_acc_z", "seat_rail_acc_z", "seat_rail_acc_z Wk"]
    assert ElementTree.fromstring(spectra._repr_html_()).find(".//table") is not None
    comfort = run.comfort()
    weighted = weighted_rms_of(run.recording.timestep, run.at("seat_rail"))
    assert comfort.weighted.overall == weighted[3] and comfort.weighted.z == weighted[2]
    assert repr(comfort).startswith("seat rail: unweighted 0.") and "ISO 2631-1" in repr(comfort)


def test_files_of_a_run(run, tmp_path):
    assert (run.save(tmp_path / "run") / "summary.json").exists()
    assert "<h1>" in run.report(tmp_path / "run.html").read_text(encoding="utf-8")
    with pytest.raises(ConfigurationError, match=r"run\.mp4.*engine='mujoco'"):
        run.film(tmp_path / "run.mp4")
