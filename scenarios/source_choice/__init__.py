"""The joint choice of what Bommer 2006 does not print: candidates, runs, likelihoods, the scenario."""
