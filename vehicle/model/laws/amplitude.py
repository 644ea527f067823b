"""Amplitude-dependent rubber: friction parallel to an elastic part, so that the dynamic stiffness falls with amplitude.

On first loading from rest the friction force over the displacement x is the backbone of Berg's model,

    F = Fmax x / (x2 + x),     dF/dx = Fmax / x2 at rest,     F(x2) = Fmax / 2.

After a reversal it follows twice the backbone (Masing), by Jenkins elements in parallel. Their backbone is the polygon
of n + 1 tangents of the curve, from the tangent at rest to the asymptote Fmax: the sum of their stiffnesses is
Fmax / x2, the sum of their limits Fmax. Tangents at slopes q^2 Fmax / x2, that is at x = x2 (1/q - 1), meet at
m = (q + q')/2, d = (q - q')/2 in

    x = x2 (1/m - 1),     F = Fmax (1 - m + d^2/m),

so that d^2/m is the largest error over Fmax, above the curve. With q = sin^2(pi i / 2n) the relative error of F is at
most (pi / 2n)^2 for every x, so that of the dynamic stiffness of the friction part is too.

For an amplitude A the force amplitude is F(A), and the work of a cycle is that of Masing's rule,

    E = 8 (integral of F from 0 to A - A F(A) / 2) = 8 Fmax (A - x2 ln(1 + A/x2) - A^2 / (2 (x2 + A))).

Berg's own rule after a reversal has the same first loading, but inner loops do not close; the amplitude of its outer
loop, Fmax (sqrt(x2^2 + A^2 + 6 x2 A) - x2 - A) / (2 x2), is lower, by at most 17 % of F(A) at A = x2.

Sources: Berg, Vehicle System Dynamics 30 (1998) 197; Masing 1926; `vehicle.model.laws.jenkins`.
"""

import numpy as np

from vehicle.model.laws.jenkins import Jenkins

ELEMENTS = 8
"""Number of Jenkins elements of an axis."""


def friction_elements(force: float, stroke: float) -> Jenkins:
    """Return the Jenkins elements of the friction part of a rubber element.

    Args:
        force: Fmax [N].
        stroke: x2 [m], above zero.
    """
    # q from 1 (tangent at rest) to 0 (asymptote); neighbours meet at m, d.
    slopes = np.sin(0.5 * np.pi * np.arange(ELEMENTS, -1, -1) / ELEMENTS) ** 2
    middle, half = 0.5 * (slopes[:-1] + slopes[1:]), 0.5 * (slopes[:-1] - slopes[1:])
    return Jenkins.through(stroke * (1.0 / middle - 1.0), force * (1.0 - middle + half**2 / middle))


def behind_spring(elements: Jenkins, stiffness: float, local: float) -> Jenkins:
    """Return the friction part of a rubber element in series with a spring, as elements over the whole displacement.

    Elastic part and friction together have the backbone T(x) = K x + F(x). The spring K0 adds its displacement,
    x' = x + T/K0, which leaves Masing's rule in force. The elastic part of the series is K K0 / (K + K0).

    Args:
        elements: friction part F.
        stiffness: elastic part K [N/m].
        local: spring K0 [N/m].
    """
    corners = elements.limit / elements.stiffness
    total = stiffness * corners + elements.backbone(corners)
    # Corners of the backbone over the whole displacement; less the elastic line, the rest is again a friction part.
    moved = corners + total / local
    return Jenkins.through(moved, total - stiffness * local / (stiffness + local) * moved)
