"""Compiled core in C: the march of the reduced car and the rows of MuJoCo; Python packs records, and calls."""
