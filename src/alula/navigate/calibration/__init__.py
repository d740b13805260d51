"""Calibration of accelerometer, gyro and magnetometer on the bench, and their noise."""
