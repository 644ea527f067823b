"""Force laws on arrays: what a damper, a friction pair or an elastomer answers to a velocity or an extension."""
