"""Time waveform replication: plate signals that make the car respond with measured accelerations."""
