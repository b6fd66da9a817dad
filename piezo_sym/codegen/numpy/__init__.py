"""NumPy: a module that describes a model, and computes its functions for many states at once."""
