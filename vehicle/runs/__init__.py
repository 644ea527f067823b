"""`Car` and `Run`, the folder of a run, its comparison with a measurement, its report."""
