"""Body design: no geometry of the vehicle in the file, a source for every value, errors that name the entry."""

import re

import pytest

from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.body_design import read_design
from vehicle.model.flexbody.body_frame import body_frame
from vehicle.model.flexbody.body_model import BODY_DESIGN
from vehicle.model.flexbody.node_masses import NodeProperties
from vehicle.model.parameters.shipped import FOCUS_FILE
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.car import Car

LINE = re.compile(r"(?P<name>\w+) = .*  # \[(?P<unit>[^\]]+)\] (?P<source>.+)$|between = \[  # \[-\] assumed: .+$")
UNITS = {"place": "m", "mass": "kg", "freedom": "-", "attachment": "N/m", "width": "m", "wall": "m", "area": "m2"}


def test_every_number_has_a_unit_and_a_source():
    checked = 0
    for text in BODY_DESIGN.read_text(encoding="utf-8").splitlines():
        if not text or text.startswith(("#", "[", "  ", "]")):
            continue
        match = LINE.match(text)
        assert match, f"no unit and source behind: {text}"
        if match["name"] is not None:
            assert match["unit"] == UNITS.get(match["name"], match["unit"]), text
            assert re.search(r"assumed: |fitted: |section \d", match["source"]), text
        checked += 1
    assert checked > 180


def test_interface_and_output_points_are_those_of_the_vehicle_alone():
    design, points = read_design(BODY_DESIGN), load_vehicle().points
    placed = design.placed(points)
    nodes = {node: position for pair in placed.values() for node, position in pair.items()}
    attached = load_vehicle().composition.attachments()
    assert len(attached) == 20 and attached == {name: nodes[name] for name in attached}
    typed = {tuple(abs(x) for x in node.place) for node in design.nodes.values() if node.place is not None}
    assert len(typed) == 11
    assert not typed & {tuple(abs(x) for x in position) for position in points.values()}


BAD = {
    "misspelt key": ("freedom = 0.15", "fredom = 0.15", "nodes.arm_front.fredom: unknown parameter; did you mean"),
    "a mass missing": (
        "mass = 4.0  # [kg] assumed: A-arm bracket of the subframe\n",
        "",
        "nodes.arm_front.mass: missing",
    ),
    "negative mass": ("mass = 4.0", "mass = -4.0", "nodes.arm_front.mass: found -4.0 kg, must be greater than 0.0"),
    "text for a number": ("mass = 4.0", 'mass = "four"', "nodes.arm_front.mass: must be a number, not 'four'"),
    "two coordinates": (
        "[0.15, 0.52, 0.82]",
        "[0.15, 0.52]",
        "nodes.rail_front.place: must be a list of 3 numbers [m], not (0.15, 0.52)",
    ),
    "left side": ("[0.15, 0.52, 0.82]", "[0.15, -0.52, 0.82]", "nodes.rail_front.place: found y = -0.52 m, must be"),
    "place and mirror": (
        'mirror = "seat_rail"',
        'place = [2.0, 0.3, 0.7]\nmirror = "seat_rail"',
        "nodes.seat_rail_right.mirror: cannot be used together with place",
    ),
    "no such hardpoint": (
        "[nodes.strut_top]",
        "[nodes.strut_tip]",
        "nodes.strut_tip: the vehicle has no hardpoint strut_tip; did you mean strut_top",
    ),
    "mirror of nothing": (
        'mirror = "seat_rail"',
        'mirror = "seat_rial"',
        "nodes.seat_rail_right: the vehicle has no hardpoint seat_rial; did you mean seat_rail",
    ),
    "name made twice": ("[nodes.sill_rear]", "[nodes.seat_rail]", "Cannot declare ('nodes', 'seat_rail') twice"),
    "node made twice": (
        "[nodes.sill_rear]",
        "[nodes.cowl_right]\nplace = [1.0, 0.0, 1.0]\nmass = 1.0\nfreedom = 1.0\n[nodes.sill_rear]",
        "nodes: cowl_right defined twice",
    ),
    "member to nowhere": (
        '"rail_front-arm_front"',
        '"rail_front-arm_font"',
        "members.front_rails.between: 'rail_front-arm_font' has no node 'arm_font'; did you mean arm_front",
    ),
    "member to itself": (
        '"rail_front-arm_front"',
        '"seat-seat"',
        "members.front_rails.between: found 'seat-seat', must be 'a-b', 'a=b' crosswise, or 'a' across the",
    ),
    "chain of three": ('"rail_front-arm_front"', '"cowl-seat-arm_rear"', "found 'cowl-seat-arm_rear', must be"),
    "no members": ('between = ["rail_front"]', "between = []", "members.rail_bumper.between: the list is empty"),
    "half a section": (
        "wall = 0.0018  # [m] assumed: nominal section\n",
        "",
        ("members.front_rails.between: the section has width"),
    ),
    "tube and strut": ("width = 0.055", "area = 1e-5\nwidth = 0.055", "the section has width, wall, area;"),
    "factor of zero": ("factor = 1.0962", "factor = 0.0", "members.front_rails.factor: found 0.0, must be greater"),
    "a node without a tube": ('"seat-seat_rail"', '"seat_rail-seat_rail_right"', "nodes: seat could turn freely"),
    "nodes in one place": (
        "[0.15, 0.52, 0.82]",
        "[0.877, 0.548, 1.23]",
        "members.front_rails: rail_front_right at [0.877, 0.548, 1.23] m and strut_top_fr are 0 m apart but must be",
    ),
    "half a mode": ("mode_count = 9 ", "mode_count = 8.5 ", "mode_count: must be a whole number, not 8.5"),
    "damping in percent": ("damping_ratio = 0.03", "damping_ratio = 3.0", "damping_ratio: found 3.0, must be at"),
    "format": ('"body design 1"', '"body design 7"', "format: must be one of body design 1, not 'body design 7'"),
    "cut off": ("[members.front_rails]", "[members.front", "not a TOML file"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_designs_are_refused_by_name(case, tmp_path):
    old, new, message = BAD[case]
    text = BODY_DESIGN.read_text(encoding="utf-8")
    assert old in text
    (tmp_path / "mine.toml").write_text(text.replace(old, new, 1), encoding="utf-8")
    (tmp_path / "car.toml").write_text(
        FOCUS_FILE.read_text(encoding="utf-8").replace('"body_design.toml"', '"mine.toml"'), encoding="utf-8"
    )
    with pytest.raises(ConfigurationError) as caught:
        _ = Car.load(tmp_path / "car.toml").trimmed_body
    assert "mine.toml: " in str(caught.value) and message in str(caught.value), str(caught.value)


def test_more_modes_than_a_frame_has_are_refused(tmp_path):
    text = BODY_DESIGN.read_text(encoding="utf-8")
    nodes = {name: text.index(f"[nodes.{name}]") for name in ("arm_front", "arm_rear", "strut_top")}
    head, body = text[: nodes["arm_front"]], text[nodes["arm_front"] : text.index("[nodes.tie_inner]")]
    members = '[members.tubes]\nbetween = ["arm_front", "arm_front-arm_rear", "arm_rear-strut_top"]\n'
    file = tmp_path / "small.toml"
    file.write_text(head.replace("mode_count = 9", "mode_count = 13") + body + members + "width = 0.05\nwall = 0.001\n")
    vehicle = load_vehicle()
    with pytest.raises(ConfigurationError, match="mode_count: found 13, must be at most 12"):
        body_frame(read_design(file), vehicle.points, NodeProperties.of_body(vehicle.body, 0.0))
