"""A bushing along a line: its stiffness in the matrices, in MuJoCo at rest, and in the kinematics of an axle."""

from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from tests.validation import validated
from vehicle.engines.kinematics.axle_statics import AxleStatics
from vehicle.engines.simulation.callbacks import installed
from vehicle.engines.simulation.rows import Rows
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.hardpoints import axes_along
from vehicle.model.parameters.shipped import FOCUS_FILE
from vehicle.model.parameters.template import SHIPPED
from vehicle.model.parameters.toml_file import read_table
from vehicle.model.parameters.vehicle import load_vehicle, vehicle_of
from vehicle.runs.car import Car

STIFFNESS, DAMPING = [3e5, 1e5, 2e4], [300.0, 100.0, 20.0]
AT, ENDS = [0.7, 0.1, 1.2], ("engine_cog", "hydromount")


def linked(**more: Any) -> Car:
    """A rigid car with a bushing between engine and body, without weight."""
    table = read_table(FOCUS_FILE)
    table["gravity"] = 0.0
    table["body"] |= {"flexible": False, "attachment_flexibility": False}
    if more:
        table["connection"] = {"link": {"moving": "engine", "carrier": "body", "at": AT, "stiffness": STIFFNESS,
                                        "damping": DAMPING, "rotational_stiffness": 0.0, **more}}  # fmt: skip
    return Car(vehicle_of(table, FOCUS_FILE.parent), folder=FOCUS_FILE.parent)


def test_axes_lie_along_the_line_and_y_is_level():
    axes = np.array(axes_along((1.0, 2.0, 3.0), (2.0, 1.5, 3.7)))
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(axes) == pytest.approx(1.0) and axes[1, 2] == 0.0
    np.testing.assert_allclose(np.cross(axes[0], [1.0, -0.5, 0.7]), 0.0, atol=1e-15)
    np.testing.assert_array_equal(axes_along((0.0, 0.0, 0.0), (0.0, 0.0, 2.0))[1], (0.0, 1.0, 0.0))


def test_the_matrices_hold_the_turned_stiffness():
    without, with_it = linked(), linked(axes=list(ENDS))
    model = with_it.model.model
    data, moved, carried = mujoco.MjData(model), np.zeros((3, model.nv)), np.zeros((3, model.nv))
    mujoco.mj_forward(model, data)
    mujoco.mj_jac(model, data, moved, None, np.array(AT), model.body("engine").id)
    mujoco.mj_jac(model, data, carried, None, np.array(AT), model.body("body").id)
    points = with_it.vehicle.points
    turn = np.array(axes_along(*(points[name] for name in ENDS)))
    row = turn @ (moved - carried)
    assert abs(turn[0, 2]) > 0.2 and abs(turn[0, 1]) > 0.5
    for name, law in (("stiffness", STIFFNESS), ("damping", DAMPING)):
        expected = row.T @ np.diag(law) @ row
        added = getattr(with_it.matrices.system, name) - getattr(without.matrices.system, name)
        validated(
            "Linear system", f"{name} matrix of a bushing along a line", added, expected, peak=1e-6,
            source="closed form: J' T' K T J with the Jacobians of MuJoCo",
        )  # fmt: skip
    # In MuJoCo: the engine is shifted, and the force of the bushing is that of the same matrix in world axes.
    rows, shift = Rows(model, with_it.model.static.preload), np.array([1e-4, -2e-4, 3e-4])
    data.qpos[model.joint("engine").qposadr[0] : model.joint("engine").qposadr[0] + 3] += shift
    with installed(rows):
        mujoco.mj_forward(model, data)
    own = rows.layout.bushings.rows[rows.names.index("bushing/link")]
    np.testing.assert_allclose(
        turn.T @ rows.state.explicit[own], -turn.T @ np.diag(STIFFNESS) @ turn @ shift, rtol=1e-9
    )


def test_a_run_with_turned_axes_balances_its_energy(tmp_path, high_piece):
    text = FOCUS_FILE.read_text(encoding="utf-8").replace(
        "[outputs]",
        f"""[connection.link]
moving = "engine"
carrier = "body"
at = {AT}
axes = {list(ENDS)}
stiffness = {STIFFNESS}
damping = {DAMPING}
rotational_stiffness = 10.0

[outputs]""",
    )
    (tmp_path / "car.toml").write_text(text, encoding="utf-8")
    car = Car.load(tmp_path / "car.toml")
    assert car.model.static.residual < 1e-9
    both = {engine: car.run(high_piece, engine=engine) for engine in ("mujoco", "reduced")}
    energies = both["mujoco"].recording.statistics.energies
    assert energies is not None and energies.residual < 1e-3
    size = np.std(both["mujoco"]["engine_acc_z"])
    assert np.std(both["reduced"]["engine_acc_z"] - both["mujoco"]["engine_acc_z"]) < 5e-3 * size


def template_car(folder: Path, axes: str) -> Car:
    """The car with a rear bushing of the arm along the arm."""
    text = (SHIPPED / "macpherson.toml").read_text(encoding="utf-8")
    text = text.replace('at = "arm_rear", least', f'at = "arm_rear"{axes}, least')
    folder.mkdir()
    (folder / "mine.toml").write_text(text, encoding="utf-8")
    table = read_table(FOCUS_FILE)
    table["front"] |= {"template": "mine"}
    return Car(vehicle_of(table, folder), folder=FOCUS_FILE.parent)


def test_both_sides_are_mirrored_and_stand(tmp_path):
    plain, turned = (
        template_car(tmp_path / name, text) for name, text in (("a", ""), ("b", ', axes = ["arm_front", "arm_rear"]'))
    )
    compliance = []
    for car in (plain, turned):
        statics = AxleStatics(
            car.model.model, car.model.static.preload, wheels=car.vehicle.composition.wheels, standing=True
        )
        still = statics.solve([0.0, 0.0])
        assert max(abs(pose.lateral_m) for pose in still) < 1e-9
        load = np.zeros((2, 6))
        load[:, 0] = 500.0
        both = statics.solve([0.0, 0.0], load)
        assert both[0].toe_deg == pytest.approx(both[1].toe_deg, abs=1e-7)
        compliance.append(both[0].longitudinal_m)
    assert compliance[1] == pytest.approx(compliance[0], rel=0.5) and compliance[1] != pytest.approx(
        compliance[0], rel=1e-3
    )


@pytest.mark.parametrize(("axes", "message"), [
    ('["engine_cog", "engine_kog"]', "connection.link.axes: unknown point 'engine_kog'; did you mean"),
    ('["engine_cog"]', "connection.link.axes: found ['engine_cog'], must be two points of a connection"),
    ("3", "connection.link.axes: must be a list, not 3"),
])  # fmt: skip
def test_bad_axes_are_refused(tmp_path, axes, message):
    law = f'\n[connection.link]\nmoving = "engine"\ncarrier = "body"\nat = {AT}\naxes = {axes}\n'
    (tmp_path / "car.toml").write_text(FOCUS_FILE.read_text(encoding="utf-8") + law, encoding="utf-8")
    with pytest.raises(ConfigurationError) as caught:
        load_vehicle(tmp_path / "car.toml")
    assert message in str(caught.value)
