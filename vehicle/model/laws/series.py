"""Series of a spring and a bushing or an elastomer, which is exactly an elastomer."""

from __future__ import annotations

import numpy as np

from vehicle.model.laws.kelvin import Kelvin
from vehicle.model.laws.law import Numbers
from vehicle.model.laws.maxwell import Maxwell
from vehicle.model.parameters.quantity import check, quantity


def in_series(local_stiffness: Numbers, element: Kelvin | Maxwell) -> Maxwell:
    """Return the elastomer that is equivalent to a local spring in series with an element.

    1/K'(s) = 1/K0 + 1/K(s), with the same extension in total and the same force. For K(s) = K + B s:
    K1' = K0 K/(K0 + K), K2' = K0^2/(K0 + K), D2' = B (K0/(K0 + K))^2. For K(s) = K1 + K2 D2 s/(D2 s + K2):
    K1' = K0 K1/(K0 + K1), K1' + K2' = K0 (K1 + K2)/(K0 + K1 + K2),
    D2' = K2' D2 (K0 + K1 + K2) / ((K0 + K1) K2) = D2 (K0/(K0 + K1))^2.

    Args:
        local_stiffness: spring K0 [N/m] of the attachment point.
        element: bushing (K, B) or elastomer (K1, K2, D2) in series with the spring.

    Raises:
        ConfigurationError: a local stiffness that is not a finite number above zero.
    """
    check(
        "local_stiffness",
        local_stiffness,
        quantity("N/m", "stiffness of the body at the attachment", above=0.0).metadata,
    )
    local = np.asarray(local_stiffness, dtype=float)
    static = np.asarray(element.stiffness)
    share = local / (local + static)
    if isinstance(element, Kelvin):
        # Without damping the branch is absent and the result is a plain spring.
        return Maxwell(
            stiffness=share * static, branch_stiffness=share * local, branch_damping=share**2 * element.damping
        )
    # K2' = K0 (K1 + K2)/(K0 + K1 + K2) - K0 K1/(K0 + K1), in a form without cancellation.
    branch = share * local * element.branch_stiffness / (local + static + element.branch_stiffness)
    return Maxwell(stiffness=share * static, branch_stiffness=branch, branch_damping=share**2 * element.branch_damping)
