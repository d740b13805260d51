"""Fixtures of the command line's tests."""

from cli.command import demo_files, small, sound

__all__ = ["demo_files", "small", "sound"]
