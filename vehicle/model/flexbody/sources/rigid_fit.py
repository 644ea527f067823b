"""Mass, centre of gravity and inertia of a hung body from its accelerances: least squares of rigid motion.

Newton and Euler for the motion a (6,) of a reference point under a force along r_i (6,), and the accelerance along r_o:

    (M - K / w^2) a = r_i,   H = r_o' (M - K / w^2)^-1 r_i + s w^2 + t w^4,   r = (d, p x d)

for a direction d at a point p. M has ten parameters (m, m c, J), K is the symmetric stiffness of the support (21), and
s and t are the elastic motion of each accelerance, the first terms of sum phi_o phi_i w^2/(w_r^2 - w^2). Without K and
s this is the mass line of the inertia restrainer method. H is real, so the real part is fitted, M and K together, and
s and t are eliminated.

Sources: Okuzumi, JSAE Review 12 (1991) 80; Toivola and Nuutila, IMAC 1993 (rigid body properties from FRFs); Almeida,
Urgueira and Maia, J. Sound Vib. 299 (2007) 884, a comparison of such methods.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Complex, Vector
from vehicle.digits import number
from vehicle.errors import DataError
from vehicle.model.flexbody.inertia_tensor import components, inertia_tensor, triangle_shortfall
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.flexbody.sources.accelerances import Accelerances
from vehicle.model.flexbody.sources.rigid_motion import MASS, SolvedProblem, solved
from vehicle.model.flexbody.sources.rigid_range import MARGIN, RigidRange, rigid_range

NAMES = ("mass", "x", "y", "z", "ixx", "iyy", "izz", "ixy", "izx", "iyz")
"""Ten mass properties: mass, centre of gravity, moments and products of inertia about it."""

_DETERMINED = 1e-3
"""Minimum singular value of the sensitivities over the largest [-] with which a parameter counts as determined."""

_LARGEST_ERROR = 0.2
"""Maximum standard error of mass and moments of inertia, over their value [-]."""

_LARGEST_MISFIT = 0.1
"""Maximum RMS of what a rigid body does not explain, over the RMS of all accelerances [-]: an accelerometer is mounted
within 5 deg and calibrated within 5 %; a sensor with the wrong sign gives 0.3 and more."""

_REPEATS = 8
"""Maximum number of ranges: the modes of the support are known after a fit, which may raise the lower end."""

_LARGEST_ELASTIC = 0.75
"""Maximum RMS of elastic over rigid motion at the upper limit [-]; at half of the first
elastic mode it is 0.2 to 0.6."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RigidFit:
    """Mass properties of a body from its accelerances.

    Attributes:
        properties: mass, centre of gravity and inertia in the axes of the vehicle.
        errors: standard errors in the order of `NAMES`: [kg], [m], [kg m2]; (10,).
        chosen: range of frequencies.
        lines: number of lines in the range.
        support: natural frequencies of the body on its support [Hz], rising, (6,).
        misfit: RMS of what a rigid body does not explain, over the RMS of the accelerances [-].
        elastic: RMS of elastic over rigid motion at the upper end of the range [-].
        scatter: RMS of the random scatter over the RMS of the accelerances [-].
    """

    properties: MassProperties
    errors: Vector
    chosen: RigidRange
    lines: int
    support: Vector
    misfit: float
    elastic: float
    scatter: float

    def values(self) -> Vector:
        """Return the mass properties in the order of `NAMES`, (10,)."""
        body = self.properties
        return np.array([body.mass, *body.cog, *components(body.inertia).values()])


def fit_rigid_body(data: Accelerances, band: tuple[float, float] | None = None) -> RigidFit:
    """Fit the mass properties of a body to its accelerances.

    Errors: the largest of the scatter of each accelerance about a smooth curve, raised by what a rigid body leaves over
    of these curves (lack of fit), and of the scatter between outputs and between inputs, whose gains, directions and
    positions are off. Errors common to all accelerances (sensitivity of the force sensor) are not contained.

    Args:
        band: range of frequencies [Hz]; None chooses it, see `rigid_range`.

    Raises:
        DataError: points and directions do not determine all properties, no range without resonance, accelerances that
            no rigid body has, or elastic motion that is too large.
    """
    centre = data.place.reshape(-1, 3).mean(axis=0)
    arms = data.place - centre
    size = float(np.sqrt((arms**2).sum(axis=2).mean()))
    # Rows of output and input, (2, n, 6); rotations in units of the mean arm.
    rows = np.concatenate([data.along, np.cross(arms, data.along) / size], axis=2)
    _require_determined(rows)
    chosen = rigid_range(data.frequency, data.response, band)
    for _ in range(_REPEATS):
        inside = (data.frequency >= chosen.low) & (data.frequency <= chosen.high)
        fitted = solved(data.frequency[inside], data.response.real[:, inside], rows)
        # A fit across a mode of the support, too narrow to be seen in the mode indicator, does not converge.
        lowest = MARGIN * float(fitted.support[-1]) if fitted.converged else 1.5 * chosen.low
        if chosen.low >= lowest:
            break
        if band is not None:
            reason = f", which reach {fitted.support[-1]:.3g} Hz" if fitted.converged else ": the fit does not converge"
            raise DataError(
                f"--band {band[0]:g}:{band[1]:g}: begins too close to the modes of the support{reason}; begin at "
                f"{np.ceil(10.0 * lowest) / 10.0:g} Hz or more"
            )
        chosen = rigid_range(data.frequency, data.response, (lowest, chosen.high), chosen)
    else:
        raise DataError("the fit of a rigid body does not converge in any range; check signs, directions and positions")
    return _result(data, fitted, chosen, centre, size)


def _require_determined(rows: Vector) -> None:
    """Check that the accelerances of a round body at these points depend on all ten parameters.

    Args:
        rows: rows of output and input, (2, n, 6).
    """
    by_name = np.einsum("na,pab,nb->np", rows[0], MASS, rows[1])
    size, vectors = np.linalg.svd(by_name, full_matrices=True)[1:]
    size = np.concatenate([size, np.zeros(len(NAMES) - len(size))])
    weak = np.abs(vectors[size < _DETERMINED * size[0]]).max(axis=0, initial=0.0) > 0.1
    if weak.any():
        raise DataError(
            f"these FRFs do not determine {_listed(weak)}; add forces in other directions or at other points, and "
            "measure three directions at four or more points that do not lie on a line"
        )


def _listed(chosen: npt.NDArray[np.bool_]) -> str:
    """Return the names of the chosen properties, (10,)."""
    labels = [f"CoG {name}" if name in "xyz" else name for name in NAMES]
    return ", ".join(label for label, each in zip(labels, chosen, strict=True) if each)


def _result(data: Accelerances, fitted: SolvedProblem, chosen: RigidRange, centre: Vector, size: float) -> RigidFit:
    """Return the mass properties about the CoG; raise DataError where they are none of a rigid body."""
    worst = int(np.argmax(fitted.misfits))
    if fitted.misfit > _LARGEST_MISFIT:
        raise DataError(
            f"no rigid body has these accelerances from {chosen.low:.4g} to {chosen.high:.4g} Hz: RMS misfit "
            f"{fitted.misfit:.0%} of their RMS, must be at most {_LARGEST_MISFIT:.0%}; the worst is "
            f"{data.names[worst]}. Check sign, direction, position and unit of its points"
        )
    if fitted.elastic > _LARGEST_ELASTIC:
        raise DataError(
            f"at {chosen.high:.4g} Hz the elastic motion is {fitted.elastic:.0%} of the rigid motion, must be at most "
            f"{_LARGEST_ELASTIC:.0%}; end the range lower with --band"
        )
    units = size ** np.array([0.0, 1, 1, 1, 2, 2, 2, 2, 2, 2])
    values, slopes = _about_cog(fitted.parameters[:10] * units)
    turned = slopes * units
    variances = np.einsum("pa,kab,pb->kp", turned, fitted.covariance[:, :10, :10], turned)
    errors = np.sqrt(variances.max(axis=0))
    tensor = inertia_tensor(**dict(zip(NAMES[4:], values[4:].tolist(), strict=True)))
    moments = np.isin(NAMES, ("mass", "ixx", "iyy", "izz"))
    weak = moments & ~(errors < _LARGEST_ERROR * values)
    if weak.any():
        shown = ", ".join(f"{NAMES[k]} {values[k]:.3g} ± {number(errors[k], 2)}" for k in np.flatnonzero(weak))
        raise DataError(
            f"these FRFs determine {_listed(weak)} too poorly ({shown}; the standard error must be at most "
            f"{_LARGEST_ERROR:.0%}); add forces in other directions and at points further apart, or average more"
        )
    if triangle_shortfall(tensor) > 2.0 * float(errors[4:7].max()) or np.linalg.eigvalsh(tensor)[0] <= 0.0:
        raise DataError(
            f"the principal moments of inertia are {np.round(np.linalg.eigvalsh(tensor), 4).tolist()} kg m2, but the "
            "largest must be at most the sum of the others; check directions and positions"
        )
    return RigidFit(
        properties=MassProperties(mass=float(values[0]), cog=centre + values[1:4], inertia=tensor),
        errors=errors,
        chosen=chosen,
        lines=fitted.lines,
        support=fitted.support,
        misfit=fitted.misfit,
        elastic=fitted.elastic,
        scatter=fitted.scatter,
    )


def _about_cog(parameters: Vector) -> tuple[Vector, Vector]:
    """Return (m, c, I about the CoG) of (m, m c, J about the reference), and the derivatives; (10,), (10, 10).

    I = J - m (|c|^2 1 - c c'), products as integrals. The functions are rational, so that an imaginary step of 1e-30
    gives their derivatives without rounding (Squire and Trapp, SIAM Review 40 (1998) 110).
    """

    def properties(of: Complex) -> Complex:
        x, y, z = (cog := of[1:4] / of[0])
        steiner = of[0] * np.array([y * y + z * z, x * x + z * z, x * x + y * y, x * y, z * x, y * z])
        return np.concatenate([of[:1], cog, of[4:] - steiner])

    step = 1e-30
    columns = [properties(parameters + 1j * step * unit).imag / step for unit in np.eye(10)]
    return properties(parameters.astype(complex)).real, np.array(columns).T
