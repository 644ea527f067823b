"""The linear car: matrices read from the assembled MuJoCo model, its modes and its frequency responses."""
