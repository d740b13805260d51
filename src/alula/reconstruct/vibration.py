"""Vibration in the inertial channels: what lies near the Nyquist frequency, and a low-pass for
those who ask for it.

Nothing is filtered unless the project says so (`vibration_filter_hz`). What was above the Nyquist
frequency when it was sampled has been folded down and no filter takes it out again; the check
looks for its trace, a spectrum that does not fall toward the Nyquist frequency or has a line there.
The filter is a Butterworth of fourth order run forward and back, so without phase (Gustafsson
1996); controls pass the same one, or the derivatives would come out too small.
"""

from __future__ import annotations

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, note, refuse, warn
from alula.flight import Maneuver

TOP = 0.8  # of the Nyquist frequency, where the spectrum should have fallen
FALLEN = 0.1  # share of the motion's rms that may be left above TOP
LINE = 30.0  # a bin over so many times the median of the band above TOP is a line
NOISE = {"m/s2": 0.5, "rad/s": 0.02}  # rms above TOP below this is only noise


def aliasing(t: Array, inputs: Array, names: tuple[str, ...], maneuver: Maneuver) -> list[Message]:
    """A warning for each inertial channel with much, or a line, close under the Nyquist frequency.

    t (n,) s, nearly even; inputs (n, channels), SI.
    """
    n, dt = len(t), float(np.median(np.diff(t)))
    if n < 64:
        return []
    window = np.hanning(n)[:, None]
    drift = np.linspace(0.0, 1.0, n)[:, None]
    level = inputs - inputs[:1] - drift * (inputs[-1:] - inputs[:1])
    power = np.abs(np.fft.rfft(level * window, axis=0)) ** 2
    power *= 2.0 / (n * float(np.sum(window**2)))  # sums to the mean square
    frequency = np.fft.rfftfreq(n, dt)
    top = frequency > TOP * 0.5 / dt
    out = []
    for i, name in enumerate(names):
        high = float(np.sqrt(power[top, i].sum()))
        whole = float(np.sqrt(power[1:, i].sum()))
        floor = NOISE["m/s2" if name.startswith("a") else "rad/s"]
        peak = int(np.argmax(np.where(top, power[:, i], 0.0)))
        line = power[peak, i] > LINE * float(np.median(power[top, i])) and (
            np.sqrt(power[max(peak - 2, 0) : peak + 3, i].sum()) > 0.2 * floor
        )
        if (high > FALLEN * whole and high > floor) or line:
            out.append(
                warn(
                    "aliasing",
                    where=f"maneuver {maneuver.id}, channel {name}",
                    expected=f"little above {TOP * 0.5 / dt:.3g} Hz",
                    found=f"{high:.2g} rms of {whole:.2g}"
                    + (f", a line at {frequency[peak]:.3g} Hz" if line else ""),
                    do="Vibration was probably folded down by sampling; record faster or with an "
                    "anti-alias filter. vibration_filter_hz cannot take out what has folded.",
                )
            )
    return out


def lowpass(t: Array, x: Array, cutoff_hz: float) -> Array:
    """x (n,) or (n, k) without what is above the cutoff, no phase. Raises BadInput for a cutoff
    that the sample rate does not allow.
    """
    from scipy import signal

    rate = 1.0 / float(np.median(np.diff(t)))
    if not cutoff_hz < 0.45 * rate:
        raise refuse(
            "vibration_filter_too_high",
            where="reconstruct.vibration_filter_hz",
            expected=f"less than {0.45 * rate:.3g} Hz at {rate:.3g} samples a second",
            found=f"{cutoff_hz:g} Hz",
            do="Choose a lower cutoff, well above the fastest motion, or leave it out.",
        )
    sections = signal.butter(4, cutoff_hz, fs=rate, output="sos")
    out: Array = np.ascontiguousarray(signal.sosfiltfilt(sections, x, axis=0))
    return out


def filtered(cutoff_hz: float, maneuver: Maneuver) -> Message:
    """The line in the report that says what was filtered."""
    return note(
        "vibration_filtered",
        where=f"maneuver {maneuver.id}",
        expected="inertial channels as recorded",
        found=f"a low-pass at {cutoff_hz:g} Hz was asked for",
        do="Specific force, rates and controls pass it, without phase.",
    )
