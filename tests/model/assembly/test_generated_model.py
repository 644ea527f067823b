"""The generated model in a plain viewer, without any callback: it stands still."""

from __future__ import annotations

import mujoco
import numpy as np

from vehicle.model.assembly.spec import assemble


def test_it_stands_still_without_callbacks(car):
    # Connect rows and friction of MuJoCo itself hold it; every body may settle by millimetres, no more.
    assert mujoco.get_mjcb_control() is None
    model = assemble(car.vehicle, car.trimmed_body).spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    start = data.xipos.copy()
    heads = range(1, model.nbody)
    drift, speed = [], []
    for _ in range(1000):  # one second
        mujoco.mj_step(model, data)
        drift.append(np.max(np.abs(data.xipos[1:] - start[1:])))
        speed.append(np.max(np.abs(data.cvel[1:, 3:])))
    assert len(heads) > 35 and np.isfinite(data.qpos).all()
    assert max(drift) < 5e-3
    # Velocities die out: the last quarter is far below the largest.
    assert max(speed[-250:]) < 0.1 * max(speed)
    assert all(data.warning[kind].number == 0 for kind in range(int(mujoco.mjtWarning.mjNWARNING)))


def test_the_text_of_the_model_compiles_to_the_same_car(car):
    spec = assemble(car.vehicle, car.trimmed_body).spec
    model = spec.compile()
    again = mujoco.MjModel.from_xml_string(spec.to_xml())
    assert (again.nv, again.nbody, again.neq, again.nu) == (model.nv, model.nbody, model.neq, model.nu)
    # The text has six significant digits or more.
    np.testing.assert_allclose(again.body_mass, model.body_mass, rtol=1e-5)
    np.testing.assert_allclose(again.site_pos, model.site_pos, rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(again.numeric_data, model.numeric_data, rtol=1e-5, atol=1e-9)


def test_the_generator_is_deterministic(car):
    texts = {assemble(car.vehicle, car.trimmed_body).spec.to_xml() for _ in range(2)}
    assert len(texts) == 1
