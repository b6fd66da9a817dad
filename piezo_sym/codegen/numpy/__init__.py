"""NumPy: a module that says all about a model, and computes its functions of many states."""
