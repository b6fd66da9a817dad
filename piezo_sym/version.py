"""The version of the package, which generated modules name as their generator."""

VERSION = "0.1.0"
