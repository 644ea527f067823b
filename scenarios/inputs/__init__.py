"""The shipped plate signals and the script that makes them."""
