"""Time after which a test takes a process, a page or a server to hang. No test judges speed by it."""

HANG = 900
"""Maximum time of anything that a test waits for [s]: many times that of a busy machine with slow cores."""
