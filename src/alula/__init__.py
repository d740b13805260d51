"""Alula turns flight logs into flight models you can trust. The map is in README.md beside this."""

__version__ = "0.1.0"
