"""Engines that compute a car: MuJoCo simulation, lifted axles, linear system, reduced engine."""
