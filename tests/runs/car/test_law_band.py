"""Cars with the edges of the band of a fitted damper."""

from html import unescape

import numpy as np
import pytest

from tests.validation import validated
from vehicle import Car, road
from vehicle.__main__ import main
from vehicle.digits import number
from vehicle.errors import ConfigurationError
from vehicle.model.laws.damper import damper_curve
from vehicle.runs.car.law_band import edge_overrides
from vehicle.runs.report.finished_run import read_run
from vehicle.runs.report.sections import dampers
from vehicle.signals.records.law_band_summary import band_rows, band_sentence

SUBJECT = "Dampers and friction"
LAW = {
    "viscous_law": "degressive",
    "viscous": 1200.0,
    "degressive_viscous": 5000.0,
    "degressive_velocity": 0.06,
    "friction_law": "coulomb",
    "coulomb_friction": 60.0,
    "gas_force": 150.0,
    "tested.band_velocity": [-0.5, -0.1, -0.001, 0.001, 0.1, 0.5],
    "tested.band_soft": [-60.0, -30.0, -10.0, -10.0, -30.0, -80.0],
    "tested.band_firm": [50.0, 20.0, 5.0, 5.0, 20.0, 50.0],
}


def banded(**changes):
    """The car with this damper in front."""
    return Car.load("focus_road", {f"front.damper.{name}": value for name, value in (changes | LAW | changes).items()})


def force(law, velocity):
    """Curve and friction at velocities, which are above those of the smoothing."""
    return damper_curve(law).force(velocity) + law.coulomb_friction * np.sign(velocity)


def test_the_edges_have_the_force_of_the_band():
    car = banded()
    law = car.vehicle.composition.dampers[0].law
    velocity = np.array(LAW["tested.band_velocity"])
    for edge, name in zip(car.law_band(), ("band_soft", "band_firm"), strict=True):
        other = edge.vehicle.composition.dampers[0].law
        change = np.sign(velocity) * (force(other, velocity) - force(law, velocity))
        assert change == pytest.approx(np.array(LAW[f"tested.{name}"]), abs=1e-6)
        assert other.tested is None and other.gas_force == law.gas_force
        assert np.all(np.diff(other.force) >= 0.0)


def test_the_band_of_some_velocities_leaves_the_others():
    car = banded()
    law = car.vehicle.composition.dampers[0].law
    velocity = np.array(LAW["tested.band_velocity"])
    (soft, _) = car.law_band(velocities=(0.05, 0.2))
    change = np.sign(velocity) * (force(soft.vehicle.composition.dampers[0].law, velocity) - force(law, velocity))
    assert change == pytest.approx([0.0, -30.0, 0.0, 0.0, -30.0, 0.0], abs=1e-6)


def test_beyond_the_band_the_change_continues_with_its_last_slope():
    """A law with a bend beyond its band: the changes at 2 m/s are those of both ends, -60 and -80 N, by closed form."""
    velocity = [-3.0, -1.0, -0.06, 0.0, 0.06, 1.0, 3.0]
    bent = banded(viscous_law="table", velocity=velocity, force=[-5e3, -1.5e3, -300.0, 0.0, 300.0, 1.5e3, 5e3])
    laws = [car.vehicle.composition.dampers[0].law for car in (bent, bent.law_band()[0])]
    before, after = (force(law, np.array([-2.0, 2.0])) for law in laws)
    assert after - before == pytest.approx([60.0 + 1.5 * 30.0 / 0.4, -80.0 - 1.5 * 50.0 / 0.4], abs=1e-3)


def test_each_side_has_its_own_edge():
    """A side with a table of its own keeps its law, with the edge of its own band if it has one."""
    weak = {"front.left.damper.coulomb_friction": 20.0}
    band = {f"front.left.damper.{name}": value for name, value in LAW.items() if name.startswith("tested")}
    for left, expected in ((weak, 20.0), (weak | band, 10.0)):
        (soft, _) = banded().with_(left).law_band()
        laws = [damper.law for damper in soft.vehicle.composition.dampers[:2]]
        assert [law.coulomb_friction for law in laws] == pytest.approx([50.0, expected])


def test_a_run_states_comfort_and_stick_at_both_edges(tmp_path, capsys):
    """The run with MuJoCo, against the reduced engine from Python."""
    car, drive = banded(), road("B", 80, duration=4)
    car.save(tmp_path / "car.toml")
    command = ["shaker", "--vehicle", str(tmp_path / "car.toml"), "--road", "B", "--speed", "80", "--duration", "4"]
    assert main([*command, "--law-band", "--no-figures", "--output", str(tmp_path / "run")]) == 0
    run = read_run(tmp_path / "run", car=car)
    band = run.summary.law_band
    assert band is not None and band.dampers == ["front.damper"]
    for name, each, edge in zip(("soft", "firm"), car.law_band(), (band.soft, band.firm), strict=True):
        reduced = each.run(drive, engine="reduced", stated_errors=False)
        validated(SUBJECT, f"{name} edge of a band: comfort of both engines on class B",
                  reduced.comfort().weighted.overall, edge.weighted_rms["seat_rail"], rel=0.005, unit="m/s2",
                  source="second derivation: MuJoCo against the reduced engine")  # fmt: skip
        assert edge.slip_share["fl"] == pytest.approx(reduced.slip_share("fl"), abs=0.02)
        validated(SUBJECT, f"{name} edge of a band: energy residual on class B", edge.energy_residual, 0.0, abs=3e-4,
                  source="conservation: energy balance")  # fmt: skip
    comfort, slip = run.summary.comfort["seat_rail"].weighted, run.summary.slip_share["fl"]
    assert band.soft.weighted_rms["seat_rail"] < comfort < band.firm.weighted_rms["seat_rail"]
    (line,) = (line for line in capsys.readouterr().out.splitlines() if line.startswith("band "))
    for edge in (band.soft, band.firm):
        assert f"{100.0 * (edge.weighted_rms['seat_rail'] / comfort - 1.0):+.2g} %" in line
    rows = {words: values for words, *values in band_rows(run.summary)}
    assert rows["front left damper, share of the time that it sticks [%]"][1] == number(100.0 * (1.0 - slip), 3)
    section = unescape(str(dampers(run)))
    assert band_sentence(run.summary)[1:] in section and rows["seat rail, weighted acceleration [m/s²]"][0] in section


def test_a_car_without_a_band_is_refused(capsys):
    with pytest.raises(ConfigurationError, match="none of the dampers front"):
        Car.load("focus_road").law_band()
    assert main(["shaker", "--input", "bump_7p5mm.csv", "--law-band"]) == 2
    assert "fit one with fit-damper and take over all lines of its damper.toml" in capsys.readouterr().err
    law = banded().vehicle.composition.dampers[0].law
    assert set(edge_overrides({"a": law}, "soft")) == {
        f"a.{name}" for name in ("viscous_law", "velocity", "force", "coulomb_friction")
    }
