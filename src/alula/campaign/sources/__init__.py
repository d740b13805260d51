"""Derivatives from other programs and tables, brought to one convention and compared."""
