"""Quarter and half car on a random road: fluctuation of the tyre loads, comfort and suspension travel."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from scenarios.lumped.axle import Axle
from scenarios.lumped.damper_choice import ExponentialRoad, FrequencyBands, RoadHoldingHalfCar, RoadHoldingQuarterCar
from scenarios.lumped.half_car_rider_model import ENDS, GRAVITY, ROADS, axle_links
from scenarios.lumped.network import ROAD, Network, masses_of
from vehicle.arrays import Complex, Vector
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.response import frequency_response
from vehicle.engines.linear.system import LinearSystem

LINES_PER_BAND = 10
"""Number of midpoints for the mean over a band; twice as many change R by less than 0.1 %."""

LINES_PER_HERTZ = 20
"""Midpoints per hertz for the integral of the physical measure; twice as many change it by less than 0.1 %."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Tyre:
    """Tyre of an axle, with its share of the sprung mass."""

    wheel: str  # Coordinate of the unsprung mass
    axle: Axle  # Axle with tyre stiffness kt and tyre damping ct
    sprung_share: float  # Share of the sprung mass on the tyre [kg]

    @property
    def static_load(self) -> float:
        """Return the static load (share of the sprung mass + unsprung mass) g [N]."""
        return (self.sprung_share + self.axle.unsprung_mass) * GRAVITY


@dataclass(frozen=True, kw_only=True, slots=True)
class RoadHoldingModel:
    """Linear model with its tyres in the order of its roads."""

    model: LinearSystem
    tyres: tuple[Tyre, ...]

    def response(self, frequency: npt.ArrayLike, *coordinates: str) -> Complex:
        """Return the motion per road height, with the same road under every wheel at the same time.

        Args:
            frequency: lines [Hz], shape (m,).
            coordinates: coordinates; all of them by default.

        Returns:
            Response [m/m] or [rad/m], shape (coordinates, m).
        """
        return frequency_response(first_order(self.model), frequency, coordinates or self.model.coordinates)


def quarter_car_model(car: RoadHoldingQuarterCar, damping: float | None = None) -> RoadHoldingModel:
    """Return a quarter car with the coordinates wheel and body, with its damper or another one [N s/m]."""
    network = Network(
        coordinates=("wheel", "body"),
        masses=masses_of({"wheel": car.wheel.unsprung_mass, "body": car.sprung_mass}),
        links=axle_links(car.wheel, {"body": 1.0, "wheel": -1.0}, "wheel", ROAD, damping),
    )
    tyre = Tyre(wheel="wheel", axle=car.wheel, sprung_share=car.sprung_mass)
    return RoadHoldingModel(model=network.system(), tyres=(tyre,))


def half_car_model(
    car: RoadHoldingHalfCar, front_damping: float | None = None, rear_damping: float | None = None
) -> RoadHoldingModel:
    """Return a half car with its dampers or others [N s/m].

    Coordinates are front_wheel, rear_wheel, heave [m] and pitch [rad] (front down positive).
    """
    axles = dict(zip(ENDS, (car.front, car.rear), strict=True))
    masses = {f"{end}_wheel": axle.unsprung_mass for end, axle in axles.items()}
    masses |= {"heave": car.sprung_mass, "pitch": car.pitch_inertia}
    axle_data = zip(axles.items(), (-car.front_arm, car.rear_arm), (front_damping, rear_damping), strict=True)
    network = Network(
        coordinates=tuple(masses),
        masses=masses_of(masses),
        links=tuple(
            link
            for (end, axle), arm, damping in axle_data
            for link in axle_links(
                axle, {"heave": 1.0, "pitch": arm, f"{end}_wheel": -1.0}, f"{end}_wheel", f"{end}_road", damping
            )
        ),
        inputs=ROADS,
    )
    wheelbase = car.front_arm + car.rear_arm
    arms = (car.rear_arm, car.front_arm)
    tyres = (
        Tyre(wheel=f"{end}_wheel", axle=axle, sprung_share=car.sprung_mass * arm / wheelbase)
        for (end, axle), arm in zip(axles.items(), arms, strict=True)
    )
    return RoadHoldingModel(model=network.system(), tyres=tuple(tyres))


def exponential_density(road: ExponentialRoad, frequency: npt.ArrayLike) -> Vector:
    """Return G(f) = a exp(-b f) [m2/Hz] at lines [Hz] of any shape.

    Source: Tamboli and Joshi (1999), as cited in "Dynamic Modeling of Vehicles and Damper" (2014).
    """
    return np.asarray(road.roughness * np.exp(-road.decay * np.asarray(frequency, dtype=float)))


def band_amplitudes(road: ExponentialRoad, edges: npt.ArrayLike) -> Vector:
    """Return the root mean square displacement in bands between rising edges [Hz], (m + 1,), in closed form [m], (m,).

    Source: "Dynamic Modeling of Vehicles and Damper" (2014), equation 8.
    """
    return np.sqrt(-np.diff(exponential_density(road, edges)) / road.decay)


def printed_load_fluctuation(
    car: RoadHoldingModel, road: ExponentialRoad, bands: FrequencyBands, *, signed: bool = False
) -> Vector:
    """Return the load fluctuation rate R of each tyre as printed: a plain sum of band amplitudes.

    R = kt sum_n |x_r,n - x_u,n| / (m g),  x_u,n = x_r,n mean_n |H_u|

    The magnitude bars are missing in the print. Without them, bands with |H_u| > 1 are negative and R has no minimum.

    Args:
        car: model with tyres.
        road: displacement density.
        bands: frequency bands.
        signed: leave the magnitude bars out.

    Returns:
        R [-] of each tyre.

    Source: "Dynamic Modeling of Vehicles and Damper" (2014), equation 10.
    """
    count = round(bands.highest / bands.width)
    lines = bands.width * (np.arange(count * LINES_PER_BAND) + 0.5) / LINES_PER_BAND
    amplitude = band_amplitudes(road, bands.width * np.arange(count + 1))
    response = np.abs(car.response(lines, *(tyre.wheel for tyre in car.tyres)))
    rates = []
    for tyre, wheel_response in zip(car.tyres, response, strict=True):
        magnitude = wheel_response.reshape(count, LINES_PER_BAND).mean(axis=1)
        difference = amplitude * (1.0 - magnitude)
        total = difference.sum() if signed else np.abs(difference).sum()
        rates.append(tyre.axle.tyre_stiffness * total / tyre.static_load)
    return np.array(rates)


def tyre_load_ratio(car: RoadHoldingModel, road: ExponentialRoad, bands: FrequencyBands) -> Vector:
    """Return the physical measure: RMS of the dynamic tyre force over the static load, up to the end of the bands.

    Returns:
        Ratio [-] of each tyre. Above about 1/3 the tyre leaves the road (three standard deviations).
    """
    width = 1.0 / LINES_PER_HERTZ
    lines = np.asarray(width * (np.arange(round(bands.highest * LINES_PER_HERTZ)) + 0.5), dtype=np.float64)
    return tyre_load_ratio_of_density(car, lines, exponential_density(road, lines), width)


def tyre_load_ratio_of_density(car: RoadHoldingModel, lines: Vector, density: Vector, width: Vector | float) -> Vector:
    """Return RMS tyre force over static load on a road given by its density at midpoints.

    Args:
        car: model with tyres.
        lines: midpoints [Hz], shape (m,).
        density: G at the midpoints [m2/Hz], shape (m,).
        width: width of each interval [Hz], shape (m,) or one for all.

    Returns:
        Ratio [-] of each tyre.
    """
    response = car.response(lines, *(tyre.wheel for tyre in car.tyres))
    ratios = []
    for tyre, wheel_response in zip(car.tyres, response, strict=True):
        deflection = 1.0 - wheel_response
        rate = np.abs(tyre.axle.tyre_stiffness + 2j * np.pi * lines * tyre.axle.tyre_damping)
        ratios.append(np.sqrt(np.sum((rate * np.abs(deflection)) ** 2 * density * width)) / tyre.static_load)
    return np.array(ratios)


@dataclass(frozen=True, kw_only=True, slots=True)
class RideMeasures:
    """Ride measures of a damper on a road: root mean squares."""

    tyre_load: float  # Dynamic tyre force over static load [-]
    acceleration: float  # Weighted vertical acceleration of the body [m/s2]
    travel: float  # Suspension travel [m]


def ride_measures(
    car: RoadHoldingQuarterCar,
    damping: float,
    lines: Vector,
    density: Vector,
    width: Vector,
    weight: npt.ArrayLike = 1.0,
) -> RideMeasures:
    """Return the ride measures from spectra: y_rms^2 = int |H_y|^2 G df by the midpoint rule.

    Args:
        car: quarter car.
        damping: damper coefficient [N s/m].
        lines: midpoints [Hz], shape (m,).
        density: displacement density of the road at the midpoints [m2/Hz], shape (m,).
        width: width of each interval [Hz], shape (m,).
        weight: frequency weighting of the acceleration, for example Wk of ISO 2631-1 [-], shape (m,); 1 for none.

    Returns:
        The three measures.
    """
    model = quarter_car_model(car, damping)
    wheel, body = model.response(lines, "wheel", "body")
    acceleration = np.asarray(weight) * (2.0 * np.pi * lines) ** 2 * np.abs(body)
    return RideMeasures(
        tyre_load=float(tyre_load_ratio_of_density(model, lines, density, width)[0]),
        acceleration=float(np.sqrt(np.sum(acceleration**2 * density * width))),
        travel=float(np.sqrt(np.sum(np.abs(body - wheel) ** 2 * density * width))),
    )
