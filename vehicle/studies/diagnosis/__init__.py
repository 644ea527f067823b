"""Diagnosis of a driven car from a record: which damper is worn, and how sure that is."""
