"""The script that makes the shipped plate signals, which lie in `vehicle/inputs`."""
