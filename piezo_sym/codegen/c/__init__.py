"""C99: a module's functions, and the step that `run/engine` drives."""
