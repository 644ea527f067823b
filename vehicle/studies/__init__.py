"""Studies of many runs: sweeps, tuning, optimisation, replication of drive signals."""
