"""Variables of a controller FMU, and the status of its calls; `vehicle/core/source/controller.c` calls it.

At the communication point t_k = k T the FMU gets its sensors, does the communication step from t_k to t_k + T, and
returns the damper coefficient c that holds over this step. T is the control period, a multiple of the time step.

    body_velocity      vb      velocity of the damper end on the body, along the damper [m/s]
    wheel_velocity     vw      likewise on the wheel
    damper_velocity    vb - vw, rate of extension
    body_acceleration  (vb(t_k) - vb(t_k - T)) / T, mean over the last communication step; 0 in the first [m/s2]
    wheel_acceleration likewise of vw

After a failed call the controller is not called again in this run, and the last coefficient holds; the engine then
raises.
"""

from __future__ import annotations

SENSORS = ("body_velocity", "wheel_velocity", "damper_velocity", "body_acceleration", "wheel_acceleration")
"""Names of the inputs of a controller FMU, in the order of their values in the core."""

COEFFICIENT = "coefficient"
"""Name of the output of a controller FMU [N s/m]."""

WARNING = 1
"""Maximum status of a successful call of FMI."""
NOT_FINITE, TERMINATED = 10, 11
"""Further status: a coefficient that is not a finite number; a controller that ends the simulation."""
