"""The small project that the command line's tests damage."""

from cli.command import demo_files, small, sound

__all__ = ["demo_files", "small", "sound"]
