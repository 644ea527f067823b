"""Records: chosen channels of a file on one clock, their comfort, their spectra, their delays."""
