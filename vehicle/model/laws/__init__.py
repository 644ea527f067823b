"""Force laws on arrays: force of a damper, a friction pair or an elastomer over velocity or extension."""
