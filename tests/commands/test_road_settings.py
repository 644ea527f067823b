"""Settings of a road: declared once, for the command line, for Python and for its documentation."""

from vehicle.commands.input_options import input_of
from vehicle.commands.shaker import parser
from vehicle.runs.car.road import Road, road_of
from vehicle.signals.excitation.input_settings import DriveInput
from vehicle.signals.excitation.road_settings import SETTINGS

VALUES = {
    "duration": 12.5,
    "precision": 1.0,
    "rate": 2000.0,
    "seed": 3,
    "period": "record",
    "coherence": 0.5,
    "patch": 0.2,
    "contact": "cams",
    "tyre": "standing",
}


def made(words: list[str]) -> Road:
    """Return the road of a command line of `shaker`."""
    source = input_of(parser().parse_args(words))
    assert isinstance(source, DriveInput)
    return road_of(source)


def test_the_options_of_a_road_make_the_road_of_python():
    words = ["--road", "C", "--speed", "80"]
    for name, value in VALUES.items():
        words += [f"--{name}", str(value)]
    assert made(words) == Road("C", 80.0, **VALUES)  # type: ignore[arg-type]
    assert VALUES.keys() == SETTINGS.keys()


def test_a_setting_that_is_not_given_has_its_default():
    assert made(["--road", "C", "--speed", "80"]) == Road("C", 80.0)
    assert repr(Road("C", 80, seed=2, tyre="rolling")) == "road('C', 80, seed=2, tyre='rolling')"


def test_help_and_documentation_have_the_declared_meaning():
    text = " ".join(parser().format_help().split())
    for name, declared in SETTINGS.items():
        assert declared["meaning"] in text
        assert f"{name}: {declared['meaning']}." in str(Road.__doc__)
