"""Faults put into the prover and the derivation on purpose, and what notices each of them."""
