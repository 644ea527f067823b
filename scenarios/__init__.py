"""Short studies, one script each: `python -m scenarios.NAME`."""

from vehicle.threads import prefer_one_thread

prefer_one_thread()
