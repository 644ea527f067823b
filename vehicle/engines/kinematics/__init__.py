"""Axles lifted at their wheels: wheel travel, angles, loads and rates of the suspension, without time."""
