"""Vehicle files and curves that are none: each one sentence with file and table, and the exit code 2."""

from pathlib import Path

import pytest

from vehicle.commands.command_line import FAULT, run_command
from vehicle.model.parameters.shipped import FOCUS_FILE
from vehicle.model.parameters.vehicle import load_vehicle

TEXT = FOCUS_FILE.read_text(encoding="utf-8")
NEW = "[outputs]"
"""Before this a new table is put."""

ARM = "inertia = [0.05, 0.02, 0.05]"
LINK = 'moving = "engine"\ncarrier = "body"\nat = [0.7, 0.1, 1.2]\n'


def put(text: str) -> tuple[str, str]:
    """A table more."""
    return NEW, f"{text}\n{NEW}"


VEHICLES = {
    # Keys that nobody knows.
    "of the car": ("gravity = 9.81", "gravity = 9.81\ncolour = 3", "colour: unknown parameter; did you mean"),
    "of the body": ("mass = 813.0", "mass = 813.0\nmas = 3", "body.mas: unknown parameter; did you mean mass"),
    "of an element": ("viscous =", "viscus = 1\nviscous =", "front.damper.viscus: unknown parameter; did you mean"),
    "of an axle": ("[front.damper]", "[front.dampers]", ("front.dampers: unknown parameter; did you mean")),
    "part of an axle": ("[front.parts.caliper]", "[front.parts.brake]", "front.parts.brake: unknown parameter; did"),
    "no value": ("viscous = 2250.0", "# nothing", "front.damper.viscous: missing"),
    "of a side": (*put("[front.left.bushing.arm_rear]\nstiffness = [1, 1, 1]"), "front.left.bushing: unknown"),
    "a bushing of a side": (*put("[front.left.bushings.arm_reer]"), "front.left.bushings.arm_reer: unknown parameter"),
    "deep in a side": (
        *put("[front.left.bushings.arm_rear]\nstifness = [1e5, 1e5, 1e5]"),
        "front.left.bushings.arm_rear.stifness: unknown parameter; did you mean stiffness",
    ),
    "deeper in a side": (
        *put("[front.left.damper.stop]\ndisplacment = [0, 1]"),
        "front.left.damper.stop.displacment: unk",
    ),
    "a side in a side": (*put("[front.left.left.damper]\nviscous = 1"), "front.left.left: unknown parameter"),
    "of a connection": (*put(f"[connection.x]\n{LINK}stifness = [1, 1, 1]"), "connection.x.stifness: unknown"),
    "of an output": (NEW, f"{NEW}\nx = {{ on = 'body', at = 'seat', in = 3 }}", "outputs.x.in: unknown parameter"),
    "a point": ("strut_top = ", "strut_tip = [0, 1, 2]\nstrut_top = ", "front.hardpoints.strut_tip: unknown"),
    # Templates.
    "no template": ('template = "blocks"', "", "rear.template: missing; the section needs template = NAME"),
    "no template below": (*put("[seat.driver]\nparts = {}"), "seat.driver.template: missing"),
    "a table of no kind": (*put("[reer]\nname = 1"), "reer: unknown parameter; did you mean rear"),
    "no such template": ('template = "blocks"', 'template = "bloks"', ("template 'bloks': the file is neither in")),
    "a number as template": ('template = "blocks"', "template = 3", "rear.template: must be a text in quotes, not 3"),
    "a name with a blank": (*put('["re ar"]\ntemplate = "blocks"'), "re ar: found 're ar', must consist of letters"),
    # Points.
    "missing": ("tie_outer = [", "tie_outr = [", "front.hardpoints.tie_outr: unknown parameter; did you mean"),
    "twice": ("seat = [", "seat = [1, 0, 1]\nseat = [", "not a TOML file: Cannot overwrite a value (at line"),
    "twice under two names": ("seat = [", "strut_top_fr = [1, 0, 1]\nseat = [", "hardpoints.strut_top_fr: a"),
    "of nothing": ("tie_inner = [0.985, 0.335, 0.66]", 'tie_inner = "subframe.tie"', "front.hardpoints.tie_inner"),
    "of itself": ("tie_inner = [0.985, 0.335, 0.66]", 'tie_inner = "front.tie_inner"', "tie_inner', which refers"),
    "in the plane": ("strut_top = [0.877, 0.548, 1.23]", "strut_top = [0.877, 0.548]", "must be a list of 3"),
    "not finite": (
        "0.548, 1.23]",
        "0.548, nan]",
        "front.hardpoints.strut_top: must be finite numbers [m], not [0.877, 0.548, nan]",
    ),
    "a text": ("0.548, 1.23]", '0.548, "high"]', "front.hardpoints.strut_top: must be a number, not 'high'"),
    "on the other side": (
        *put("[front.left.hardpoints]\ntie_inner = [0.985, 0.335, 0.66]"),
        "front.left.hardpoints.tie_inner: found y = 0.335 m",
    ),
    "of a rod at one place": (
        "tie_inner = [0.985, 0.335, 0.66]",
        "tie_inner = [0.985, 0.69, 0.648]",
        "front.hardpoints.tie_outer, front.hardpoints.tie_inner: coincide",
    ),
    "of a part": (ARM, f'{ARM}\nbetween = ["lower_bal"]', "front.parts.a_arm.between: unknown hardpoint 'lower_bal'"),
    "none of a part": (ARM, f"{ARM}\nbetween = []", "front.parts.a_arm.between: found no hardpoint"),
    # Numbers and types.
    "negative mass": (
        "mass = 4.05",
        "mass = -4.05",
        "front.parts.a_arm.mass: found -4.05 kg, must be greater than 0.0",
    ),
    "infinite mass": ("mass = 4.05", "mass = inf", "front.parts.a_arm.mass: found inf kg, must be a finite number"),
    "moments": (ARM, "inertia = [0.05, 0.02, 0.5]", "front.parts.a_arm.inertia: found [0.05, 0.02, 0.5] kg m2"),
    "products": (
        ARM,
        f"{ARM}\nproducts = [0.03, 0, 0]",
        "front.parts.a_arm.products: found [0.03, 0.0, 0.0] kg m2, too",
    ),
    "a word for numbers": (
        "stiffness = [2.5e5, 8.0e5, 8.0e5]",
        'stiffness = "soft"',
        "stiffness: must be a list, not 'soft'",
    ),
    "a number for a table": (
        *put("[front.left]\nbushings = 3"),
        "front.left.bushings: must be a section, not 3",
    ),
    "a number for a side": (
        "[front.hardpoints]",
        "left = 3\n[front.hardpoints]",
        "front.left: must be a section, not 3",
    ),
    "a date": (
        "mass = 4.05",
        "mass = 2026-11-22",
        "front.parts.a_arm.mass: must be a number, not datetime.date(2026, 11, 22)",
    ),
    "a list of tables": (
        "[solver]",
        "[[solver]]",
        "solver: must be a section, not [{'timestep': 0.001, 'record_rate': 1000.0}]",
    ),
    "not TOML": ("gravity = 9.81", "gravity = 9,81", "not a TOML file: "),
    # What is named and is not there, what is there and is not taken.
    "a port": ("[front.hardpoints]", 'ports = { bdy = "engine" }\n[front.hardpoints]', "front.ports.bdy: unknown"),
    "a part of a port": (
        "[front.hardpoints]",
        'ports = { body = "engin" }\n[front.hardpoints]',
        "front.ports.body: unknown part 'engin",
    ),
    "moving part": (*put(f"[connection.x]\n{LINK.replace('engine', 'engin')}"), "connection.x.moving: unknown part"),
    "carrier": (*put(f"[connection.x]\n{LINK.replace('body', 'bodi')}"), "connection.x.carrier: unknown part 'bodi'"),
    "the same part": (*put(f"[connection.x]\n{LINK.replace('body', 'engine')}"), "connection.x: connects engine to"),
    "place": (*put(f"[connection.x]\n{LINK.replace('at', '#')}"), "connection.x.at: missing"),
    "part of an output": ('on = "engine"', 'on = "engin"', "outputs.engine.on: unknown part 'engin'; did you mean"),
    "point of an output": ('at = "engine_cog"', 'at = "engine_kog"', "outputs.engine.at: unknown point 'engine_kog'"),
    "two of one name": (*put(f"[connection.arm_rear_fr]\n{LINK}"), "arm_rear_fr: two elements have this name"),
    "an alias": ("[alias]", '[alias]\nx = "front.nothing"', "alias.x: unknown parameter front.nothing"),
    "a bushing": ("[front.bushings.arm_rear]", "[front.bushings.arm_front]", "front.bushings.arm_rear: missing;"),
    "side of what exists once": (*put("[front.left.stabilizer]\ntorsional_stiffness = 1"), "front.left.stabilizer"),
    "side of what is not mirrored": (
        *put("[engine.left.bushings.hydromount]\nstiffness = [1e5, 1e5, 1e5]"),
        "engine.left.bushings.hydromount: three_mounts.toml does not use this section",
    ),
    "nothing to stand on": (TEXT[TEXT.index("[rear]") : TEXT.index("# Channels")], "", "found 0 m, must be 0.5 to 8 m"),
}


def said_of(folder: Path, capsys: pytest.CaptureFixture[str]) -> str:
    """What a command says of the car in a folder."""

    def job() -> None:
        load_vehicle(folder / "car.toml")

    assert run_command(job) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"error: {folder / 'car.toml'}: ") and said.count("\n") == 1 and FAULT not in said, said
    return said


@pytest.mark.parametrize("case", VEHICLES)
def test_vehicles(case, tmp_path, capsys):
    old, new, message = VEHICLES[case]
    assert old in TEXT
    (tmp_path / "car.toml").write_text(TEXT.replace(old, new, 1), encoding="utf-8")
    assert message in said_of(tmp_path, capsys)


def test_a_point_that_nothing_uses(tmp_path, capsys):
    rigid = "[hardpoints]\nspare = [1.0, 0.0, 1.0]", 'superelement = "body_design.toml"', "flexible = true"
    text = TEXT.replace("[hardpoints]", rigid[0], 1).replace(rigid[1], "", 1).replace(rigid[2], "flexible = false", 1)
    text = text.replace("attachment_flexibility = true", "attachment_flexibility = false", 1)
    (tmp_path / "car.toml").write_text(text, encoding="utf-8")
    assert "hardpoints.spare: nothing uses it" in said_of(tmp_path, capsys)
    force = '[force.push]\non = "engine"\nat = "spare"\nforce = [0, 0, 1]\nharmonics = [[1, 5, 0]]\nfrequency = 20.0\n'
    (tmp_path / "car.toml").write_text(f"{text}\n{force}", encoding="utf-8")
    assert load_vehicle(tmp_path / "car.toml").composition.forces[0].at == (1.0, 0.0, 1.0)


HEAD = "velocity [m/s],force [N]\n"
CURVES = {
    "missing": (None, "does not exist"),
    "empty": ("", "test.csv: the file is empty"),
    "binary": ("\0\0\0", "test.csv:1:1: contains a NUL character"),
    "head": ("speed [m/s],force [N]\n-1,-1\n1,1\n", "test.csv:1: column 'velocity [m/s]' is missing"),
    "unit": ("velocity [mm/s],force [N]\n-1,-1\n1,1\n", "test.csv:1: column 'velocity [m/s]' is missing"),
    "of a spring": ("displacement [m],force [N]\n-1,-1\n1,1\n", "1: column 'velocity [m/s]' is missing"),
    "NaN": (HEAD + "-1,-1\n0,nan\n1,1\n", "test.csv:3:2: column 'force [N]' is 'nan' but must be a finite number"),
    "a word": (HEAD + "-1,-1\nfast,0\n1,1\n", "test.csv:3:1: column 'velocity [m/s]' is 'fast' but must be a"),
    "unsorted": (HEAD + "1,1\n-1,-1\n", "front.damper.velocity: found -1.0 after 1.0, must be ascending"),
    "falling": (HEAD + "-1,1\n1,-1\n", "front.damper.force: found -1.0 N after 1.0 N, must not decrease"),
    "a point": (HEAD + "1,1\n", "front.damper.velocity: found 1 points, must be 2 to 40"),
    "one direction": (HEAD + "0,0\n1,1\n", "front.damper.velocity: found 0.0 to 1.0, must lie on both sides of 0"),
}


@pytest.mark.parametrize("case", CURVES)
def test_curves_of_a_damper_test(case, tmp_path, capsys):
    text, message = CURVES[case]
    if text is not None:
        (tmp_path / "test.csv").write_text(text, encoding="utf-8")
    law = 'viscous_law = "table"\ncurve = "test.csv"'
    (tmp_path / "car.toml").write_text(TEXT.replace('viscous_law = "linear"', law, 1), encoding="utf-8")
    said = said_of(tmp_path, capsys)
    assert message in said and "front.damper." in said
