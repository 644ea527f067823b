"""Many runs of the car: tables of variations over any executor, and what comfort answers to."""
