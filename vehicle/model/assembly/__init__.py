"""Parameters and superelement into a MuJoCo model; the only room that names MJCF elements."""
