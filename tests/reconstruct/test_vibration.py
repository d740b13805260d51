"""The aliasing check and the low-pass."""

from __future__ import annotations

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.flight import Maneuver
from alula.reconstruct.vibration import aliasing, lowpass

MANEUVER = Maneuver("m", "log", "3211", 0.0, 20.0)
T = np.arange(0.0, 20.0, 0.01)


def motion(t: np.ndarray) -> np.ndarray:
    return 3.0 * np.sin(2.0 * np.pi * 0.7 * t) * np.exp(-0.1 * t)


def test_quiet_recording_is_not_suspected() -> None:
    noise = np.random.default_rng(1).normal(0.0, 0.05, len(T))
    assert aliasing(T, (motion(T) + noise)[:, None], ("az",), MANEUVER) == []


def test_folded_engine_line_is_named() -> None:
    # 153 Hz sampled at 100 Hz stands at 47 Hz.
    shaken = motion(T) + 1.0 * np.sin(2.0 * np.pi * 153.0 * T)
    (message,) = aliasing(T, shaken[:, None], ("az",), MANEUVER)
    assert message.code == "aliasing"
    assert "47 Hz" in message.found


def test_lowpass_keeps_motion_and_takes_vibration_without_phase() -> None:
    clean = motion(T)
    out = lowpass(T, clean + 1.0 * np.sin(2.0 * np.pi * 30.0 * T), 8.0)
    inner = slice(100, -100)  # the filter's ends reach about a second
    # A fourth-order Butterworth run twice: 1/(1 + (30/8)^8) = 2.6e-5 of the vibration is left,
    # and 1 - 1/(1 + (0.7/8)^8) < 1e-8 of the motion is lost; the ends' echoes are what remains.
    assert np.max(np.abs(out - clean)[inner]) < 2e-3


def test_cutoff_above_what_the_rate_allows_is_refused() -> None:
    with pytest.raises(BadInput, match="vibration_filter_too_high"):
        lowpass(T, motion(T), 60.0)
