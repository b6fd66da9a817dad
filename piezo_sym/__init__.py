"""piezo_sym."""
__version__ = "0.1.0"
