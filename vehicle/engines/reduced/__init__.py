"""The reduced engine: the car as a sum over its poles, with the friction of its dampers solved implicitly."""
