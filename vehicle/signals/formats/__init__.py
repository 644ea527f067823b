"""Files of measurements: recognised, read and written here only, with their channels, units and time stamps."""
