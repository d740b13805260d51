"""Maxima of a likelihood, and the parameters and errors read off them."""
