"""Derivatives from geometry: lattice, bodies, handbook formulas, strips and propellers."""
