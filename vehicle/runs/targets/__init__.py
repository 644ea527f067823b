"""Targets of ride comfort: figures with limits, their values on finished runs, and the verdict."""
