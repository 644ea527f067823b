"""The matrices of a car from plain arrays: for systems small enough to be known in closed form."""

import numpy as np

from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.system import LinearSystem


def plain_matrices(
    *,
    mass,
    damping,
    stiffness,
    dampers,
    viscous,
    plate_stiffness,
    plate_damping,
    tyre_stiffness,
    tyre_damping,
    outputs,
    body_rows,
    body_masses,
    body_centres=None,
    constraints=(),
    branches=(),
    branch_stiffness=(),
    branch_time=(),
):
    """`damping` is that without the dampers; `plate_*` are (2, n) as forces per motion of the plates."""
    n = len(mass)
    whole = np.array(damping, dtype=float)
    whole[dampers, dampers] += viscous
    system = LinearSystem(
        coordinates=(), inputs=("fr", "fl"), mass=mass, damping=whole, stiffness=stiffness,
        input_damping=np.transpose(plate_damping), input_stiffness=np.transpose(plate_stiffness),
        branch_rows=np.array(branches, dtype=float).reshape(-1, n), branch_inputs=np.zeros((len(branches), 2)),
        branch_stiffness=np.array(branch_stiffness, dtype=float), branch_time=np.array(branch_time, dtype=float),
        slide_rows=np.eye(n)[dampers], slide_inputs=np.zeros((len(dampers), 2)),
        constraints=np.array(constraints, dtype=float).reshape(-1, n), load=np.zeros(n),
        outputs={name: np.concatenate([row, np.zeros(2)]) for name, row in outputs.items()},
    )  # fmt: skip
    return CarMatrices(
        system=system, dampers=dampers, damper_names=("damper_fr", "damper_fl")[: len(dampers)], viscous=viscous,
        tyre_stiffness=tyre_stiffness, tyre_damping=tyre_damping,
        tyre_rows=np.asarray(plate_stiffness) / np.reshape(tyre_stiffness, (-1, 1)), body_rows=body_rows,
        body_masses=body_masses, body_centres=body_centres or {name: np.zeros(3) for name in body_masses},
        carried_by={}, modal=slice(0, 0),
    )  # fmt: skip
