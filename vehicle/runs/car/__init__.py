"""The car in Python: load a car, simulate a run on a signal, and read its results.

car = Car.load()
run = car.run("low.csv")              # or road("C", 80), or a Signal
run["seat rail z"]                    # time history
run.frf("seat rail z").response       # FRF to the shaker displacement
run.comfort().unweighted.overall      # unweighted RMS of the seat rail, 2 to 50 Hz (Bommer 2006)
run.comfort().weighted.overall        # weighted RMS (ISO 2631-1)
"""

from vehicle.runs.car.car import Car
from vehicle.runs.car.road import Road
from vehicle.runs.car.run import FRF_BAND, SATURATED_VELOCITY, Run

__all__ = ["FRF_BAND", "SATURATED_VELOCITY", "Car", "Road", "Run"]
