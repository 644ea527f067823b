"""Gravity in the mean of an accelerometer shows a wrong unit or range, and is no motion."""

import numpy as np
import pytest

from vehicle.commands.comfort import main as comfort
from vehicle.signals.records.channel_findings import channel_findings
from vehicle.signals.records.finding import FindingError
from vehicle.signals.records.gravity import gravity_findings

G = 9.80665


@pytest.mark.parametrize(
    ("unit", "mean", "remedy"),
    [
        ("g", G * G, "m/s2"),  # says g, holds m/s2
        ("m/s2", 1.0, "g"),  # says m/s2, holds g
        ("m/s2", 2.0 * G, "0.5 m/s2"),
        ("g", 2.0 * G, "0.5 g"),
        ("m/s2", -4.0 * G, "0.25 m/s2"),
        ("mm/s2", 1e-3 * G, "m/s2"),
        ("m/s2", 1e3 * G, "mm/s2"),
    ],
)
def test_158_gravity_checks_unit_and_range(unit, mean, remedy):
    """The printed advice removed the mean: 2.615, 0.0272 and 0.5334 for 0.2667 m/s2."""
    (finding,) = gravity_findings({"z": mean}, {"z": 0.03}, {"z": unit})
    assert finding.kind == "unit" and finding.options == ("--unit", f"z={remedy}")
    assert finding.endswith(f"offset of the sensor --unit z={unit}")
    assert gravity_findings({"z": mean}, {"z": 0.03}, {"z": unit}, stated=["z"]) == []


@pytest.mark.parametrize(("mean", "remedy"), [(1.0, "g"), (4.95, "2 m/s2")])
def test_an_offset_or_a_tilt_of_one_axis_is_a_question(mean, remedy):
    """A seat sensor with an offset of 1.00 m/s2 and an engine sensor at 60 degrees were refused."""
    (finding,) = gravity_findings({"z": mean}, {"z": 0.5}, {"z": "m/s2"})
    assert finding.kind == "doubt" and not finding.options and "tilt" in finding and f"z={remedy}" in finding
    axes = {"x": 0.0, "y": 0.0, "z": mean}
    (finding,) = gravity_findings(axes, dict.fromkeys(axes, 0.5), dict.fromkeys(axes, "m/s2"))
    assert finding.kind == "unit"
    time = np.arange(3000) / 100.0
    values = mean + 0.7 * np.sin(20.0 * time)
    assert [each.kind for each in channel_findings("", time, {"z": values}, {"z": "m/s2"})] == ["doubt"]


@pytest.mark.parametrize("tilt", [0.0, 5.0, 30.0])
def test_three_axes_show_gravity_at_any_tilt(tilt):
    means = {"x": G * np.sin(np.radians(tilt)), "y": 0.0, "z": G * np.cos(np.radians(tilt))}
    (finding,) = gravity_findings(means, means, dict.fromkeys(means, "m/s2"))
    assert finding.kind == "gravity" and finding.options == ("--detrend",)
    (finding,) = gravity_findings({axis: mean / G for axis, mean in means.items()}, means, dict.fromkeys(means, "m/s2"))
    assert finding.options == ("--unit", "x=g", "--unit", "y=g", "--unit", "z=g")


@pytest.mark.parametrize("means", [{"z": 0.3}, {"z": 3.0}, {"x": 1.0}, {"x": 1.0, "y": 0.1}, {"z": 0.0}])
def test_another_mean_is_not_taken_for_gravity(means):
    """A car that brakes with 1 m/s2 has this mean along x."""
    assert gravity_findings(means, dict.fromkeys(means, 0.5), dict.fromkeys(means, "m/s2")) == []


def test_a_mean_that_drifts_is_not_gravity():
    time = np.arange(4000) / 100.0
    rising = np.linspace(0.0, 2.0 * G, time.size)
    assert channel_findings("", time, {"z": rising}, {"z": "m/s2"}) == []
    with pytest.raises(FindingError, match=r"9\.81 m/s2, .*--unit z=g"):
        channel_findings("", time, {"z": 1.0 + 0.05 * np.sin(20.0 * time)}, {"z": "m/s2"})


@pytest.mark.parametrize(
    ("head", "factor"), [("[g]", 1.0), ("[m/s2]", 1.0 / G), ("[m/s2]", 2.0), ("[m/s2]", 1.0)], ids=str
)
def test_accepted_advice_gives_the_comfort_of_the_right_unit(tmp_path, capsys, head, factor):
    random, time = np.random.default_rng(1), np.arange(3000) / 100.0
    motion = 0.3 * random.standard_normal(time.size)

    def weighted(name, offset, scale, unit, *words):
        rows = [f"{t:.2f},{scale * (a + offset):.6f}" for t, a in zip(time, motion, strict=True)]
        file = tmp_path / f"{name}.csv"
        file.write_text("\n".join([f"Time [s],Seat Z {unit}", *rows, ""]))
        code = comfort(["--input", str(file), "--channel", "z=Seat Z", *words])
        said = capsys.readouterr()
        values = [line.split()[2] for line in said.out.splitlines() if line.startswith("weighted RMS")]
        return code, said.err, float(values[0]) if values else None

    _, _, right = weighted("right", 0.0, 1.0, "[m/s2]", "--offset", "remove")
    code, said, value = weighted("wrong", G, factor, head, "--offset", "remove", "--accept-advice")
    assert code == 0 and value == pytest.approx(right, rel=2e-3)
    assert said.count("accepted: ") == (0 if factor == 1.0 and head == "[m/s2]" else 1)
    code, said, value = weighted("refused", G, factor, head, "--offset", "refuse")
    assert code == 3 and value is None and ("set --unit" in said or "--detrend" in said)
