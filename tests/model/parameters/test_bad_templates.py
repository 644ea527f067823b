"""Templates that are none: each one sentence with file and table, and the exit code 2."""

import pytest

from tests.model.parameters.test_bad_cars import TEXT, said_of
from vehicle.model.parameters.template import SHIPPED

MACPHERSON = (SHIPPED / "macpherson.toml").read_text(encoding="utf-8")
MOUNT = 'suspension_mount = { shape = "top_mount", points = ["strut_top"] }'
LINE = 'along = ["damper_bottom", "strut_top"]'

TEMPLATES = {
    "unknown list": ("above = [", "abuve = [", "abuve: unknown key; did you mean above"),
    "unknown key": ('kind = "ball"', 'kynd = "ball"', "joint.lower_ball.kynd: unknown parameter; did you mean"),
    "unknown kind": ('kind = "ball"', 'kind = "bell"', "joint.lower_ball.kind: must be one of free"),
    "unknown part": ('parent = "a_arm"', 'parent = "a_arn"', "joint.lower_ball.parent: unknown name 'a_arn'"),
    "unknown moving part": ('moving = "damper_top"', 'moving = "damper_tip"', "connection.suspension_mount.moving"),
    "unknown point": ('at = "tie_outer"', 'at = "tie_outa"', "unknown name 'tie_outa'; did you mean tie_outer"),
    "unknown joint": ('joint = "damper"', 'joint = "dampr"', "damper.damper.joint: unknown name 'dampr'"),
    "side of a part": (
        'child = "a_arm"',
        'child = "a_arm:lft"',
        "joint.2.child: the side must be left, right or middle, not 'lft'",
    ),
    "side of a point": (
        'at = "tie_outer"',
        'at = "tie_outer:links"',
        "the side must be left, right or middle, not 'links'",
    ),
    "a number for a part": ('child = "a_arm"', "child = 3", "joint.2.child: must be a list, not 3"),
    "a number for all": ("joint = [", "spring = 3\njoint = [", "not a TOML file"),
    "a word for a table": ("joint = [", 'joint = ["a",', "joint: must be a section, not 'a'"),
    "a word for a switch": ("mirrored = true", 'mirrored = "yes"', "mirrored: must be true or false, not 'yes'"),
    "a number as meaning": (
        'tie_inner = "steering rod on the body"',
        "tie_inner = 3",
        "hardpoints.tie_inner: must be a text in quotes, not 3",
    ),
    "a number for two points": ("above = [", "above = [3,", "above: must be a list, not 3"),
    "a default of no port": ('rack = "body"', 'rak = "body"', "port_defaults.rak: unknown name 'rak'; did you mean"),
    "a port as no part": ('rack = "body"', 'rack = "bodi"', "port_defaults.rack: unknown name 'bodi'; did you mean"),
    "one point above": ("above = [", 'above = [["strut_top"],', "above: found ['strut_top'], must be two points"),
    "not TOML": ("mirrored = true", "mirrored = tru", "not a TOML file: Invalid value (at line"),
    "no axis": (f", {LINE}", "", "joint.damper.along: a joint of kind slide needs either two points in along, or axis"),
    "two axes": (LINE, f"{LINE}, axis = [0, 0, 1]", "joint.damper.along: a joint of kind slide needs either two"),
    "an axis of no length": (LINE, "axis = [0, 0, 0]", "joint.damper.axis: must not be a zero vector"),
    "an axis in the plane": (
        LINE,
        "axis = [0, 1]",
        "joint.damper.axis: must be a list of 3 numbers [-], not (0.0, 1.0)",
    ),
    "along one point": (
        LINE,
        'along = ["strut_top"]',
        "joint.damper.along: must be two different points, not ['strut_top']",
    ),
    "a damper between a point": (LINE, 'along = ["strut_top", "strut_top"]', "must be two different points"),
    "a spring between a point": (
        'upper = { part = "body", at = "strut_top" } }',
        'upper = { part = "main_spring_lower", at = "spring_lower" } }',
        "front.main_spring, lower end, upper end: coincide",
    ),
    "a damper on a ball": ('joint = "damper"', 'joint = "lower_ball"', "joint: 'lower_ball' is a ball but must be a"),
    "one end of a spring": (', upper = { part = "body", at = "strut_top" } }', " }", "spring.main_spring.lower: a"),
    "a loop": (
        '{ kind = "free", child = "a_arm" }',
        '{ kind = "ball", name = "x", child = "a_arm", parent = "knuckle", at = "lower_ball" }',
        "form a loop without a free part",
    ),
    "on itself": (
        'carrier = "body", at = "arm_front"',
        'carrier = "a_arm", at = "arm_front"',
        "connects a_arm_fr to itself",
    ),
    "held twice": (
        '{ kind = "free", child = "a_arm" }',
        '{ kind = "free", child = ["a_arm", "knuckle"] }',
        "joint of knuckle: the part already has the parent world",
    ),
    "fixed and hinged": (
        '{ kind = "free", child = "a_arm" }',
        '{ kind = "free", child = "a_arm" }, { kind = "fixed", child = "suspension_mount", parent = "damper_top" }',
        "joint of suspension_mount: the part already has a joint",
    ),
    "free on a part": ('child = "a_arm" }', 'child = "a_arm", parent = "knuckle" }', "joint.2.parent: found"),
    "held by nothing": (', "main_spring_lower"]', "]", "main_spring_lower_fr has no joint; add a joint"),
    "both wheels on one half": (
        '{ template = "wheel", with = { hub = "knuckle" } }',
        '{ template = "wheel", with = { hub = "knuckle:left" } }',
        "tyre_fr has no joint; its joint names a side (knuckle:left)",
    ),
    "a joint on the body": (
        '{ kind = "fixed", child = "main_spring_upper", parent = "body", at = "strut_top" }',
        '{ kind = "ball", child = "main_spring_upper", parent = "body", at = "strut_top" }',
        "a part on the trimmed body must be fixed, with a point in at",
    ),
    "a part on a bracket": (
        '["damper_bottom", "main_spring_lower"], parent = "knuckle" }',
        '"damper_bottom", parent = "knuckle" }, { kind = "slide", child = "main_spring_lower", '
        'parent = "main_spring_upper", at = "spring_lower", axis = [0, 0, 1] }',
        "joint of main_spring_lower_fr: main_spring_upper_fr is fixed to the trimmed body",
    ),
    "a part of others": ('child = "a_arm" }', 'child = ["a_arm", "body"] }', "joint of body: is not a part of this"),
    "no points": (MOUNT, MOUNT.replace('"strut_top"', ""), "parts.suspension_mount.points: empty"),
    "a point too many": ("tie_inner = ", 'spare = "nothing"\ntie_inner = ', "hardpoints.spare: not used in the"),
    "a point of another": ("tie_inner = ", 'wheel_center = "x"\ntie_inner = ', "hardpoints.wheel_center: defined"),
    "two connections": ('name = "arm_front"', 'name = "arm_rear"', "arm_rear_fl: two elements have this name"),
    "two joints": ('name = "lower_ball"', 'name = "damper"', "joint.damper: defined twice; rename one joint"),
    "two outputs": ('name = "damper_top", on', 'name = "knuckle", on', "knuckle_fl: two elements have this name"),
    "two wheels": (
        "use = [",
        'use = [{ template = "wheel", prefix = "b_", with = { hub = "knuckle" } },',
        "wheel: defined",
    ),
    "a wheel twice": ("use = [", 'use = [{ template = "wheel", with = { hub = "knuckle" } },', "defined twice; set a"),
    "a name with a slash": ('name = "arm_front"', 'name = "arm/front"', "connection.arm/front.name: found 'arm/front'"),
    "no such template": ('template = "wheel"', 'template = "weel"', ("'weel': the file is neither in the")),
    "uses itself": ('template = "wheel"', 'template = "mine"', "template 'mine': uses itself"),
    "a key of use": ('with = { hub = "knuckle" }', 'wiht = { hub = "knuckle" }', "must have template, and may have"),
    "a number as prefix": ('with = { hub = "knuckle" }', "prefix = 3", "use.0.prefix: must be a text in quotes, not 3"),
    "unbound port": (', with = { hub = "knuckle" }', "", "use.with.hub: missing"),
    "no such port": ("hub = ", "hob = ", "use.with.hob: wheel.toml has no port of this name, only ['hub']"),
    "a port without part": ('hub = "knuckle"', 'hub = "knukle"', "unknown name 'knukle'; did you mean knuckle"),
}


@pytest.mark.parametrize("case", TEMPLATES)
def test_templates(case, tmp_path, capsys):
    old, new, message = TEMPLATES[case]
    assert old in MACPHERSON
    (tmp_path / "mine.toml").write_text(MACPHERSON.replace(old, new, 1), encoding="utf-8")
    (tmp_path / "car.toml").write_text(TEXT.replace('"macpherson"', '"mine"'), encoding="utf-8")
    assert message in said_of(tmp_path, capsys)
