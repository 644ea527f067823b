"""The joint choice of what source 1 does not print: candidates, runs, likelihoods, the scenario."""
