"""The car as data: parameters, templates, force laws, flexible body, visible shapes, MJCF."""
