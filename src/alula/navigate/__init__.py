"""Attitude, position, wind and their sensors: calibration and filters."""
