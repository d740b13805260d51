"""Calibration of accelerometer, gyro and magnetometer on the bench, and their noise."""

from alula.navigate.calibration.accelerometer import calibrate_accelerometer
from alula.navigate.calibration.calibrate import Calibrated, calibrate
from alula.navigate.calibration.current import CurrentField, current_field
from alula.navigate.calibration.file import (
    ImuCalibration,
    SensorCorrection,
    calibration_text,
    load_imu_calibration,
)
from alula.navigate.calibration.gyro import Turns, calibrate_gyro
from alula.navigate.calibration.magnetometer import calibrate_magnetometer
from alula.navigate.calibration.noise import AxisNoise, axis_noise
from alula.navigate.calibration.result import Parameter, SensorCalibration
from alula.navigate.calibration.turns import Turn, turns_of

__all__ = [
    "AxisNoise",
    "Calibrated",
    "CurrentField",
    "ImuCalibration",
    "Parameter",
    "SensorCalibration",
    "SensorCorrection",
    "Turn",
    "Turns",
    "axis_noise",
    "calibrate",
    "calibrate_accelerometer",
    "calibrate_gyro",
    "calibrate_magnetometer",
    "calibration_text",
    "current_field",
    "load_imu_calibration",
    "turns_of",
]
