"""Laws of dampers fitted to records of a test machine."""
