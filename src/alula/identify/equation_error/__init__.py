"""Equation error: each coefficient regressed on motion and controls, and what is asked after."""
