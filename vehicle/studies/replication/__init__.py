"""Time waveform replication: the drive of the plates that makes the car answer as a measured one did."""
