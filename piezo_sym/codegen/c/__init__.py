"""C99: the functions of a module, and the step that `run/engine` drives."""
