"""Engines that compute a car: MuJoCo simulation, linear system, reduced engine, lumped models."""
