"""Frequency responses from sweeps and multisines, with coherence and error bars.

H = Sxx^-1 Sxy from segments of the record (Welch 1967; Bendat and Piersol, Random Data, 4th ed.
2010, ch. 6 and 7). Random errors by their Eq. (9.90) and (9.91): relative error of the gain and
error of the phase in radians are both

    sqrt(1 - g^2) / (|g| sqrt(2 n)),

g^2 the coherence, n the number of independent segments, less one for each input, which takes out
what few segments make the coherence too large by. Several inputs at once are separated as long as
they are not multiples of each other; then g^2 is the partial coherence.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.base.arrays import Array, frozen
from alula.base.messages import BadInput, refuse

SEGMENTS = 5  # the record's length over a segment's, where none is given
COLLINEAR = 1e10  # condition of the inputs' spectra, each sized alike


@dataclass(frozen=True)
class FrequencyResponse:
    """The response of `output` to `input`, by frequency (m,) Hz.

    response: (m,) complex, output's unit over input's. coherence: (m,), 0 to 1. gain_error: (m,)
    standard error of the gain over the gain. phase_error: (m,) standard error of the phase, rad.
    segments: how many independent ones were averaged.
    """

    input: str
    output: str
    frequency: Array
    response: np.ndarray
    coherence: Array
    gain_error: Array
    phase_error: Array
    segments: float

    @property
    def gain_db(self) -> Array:
        """(m,) 20 log10 of the gain."""
        out: Array = 20.0 * np.log10(np.abs(self.response))
        return out

    @property
    def phase(self) -> Array:
        """(m,) phase in rad, without jumps."""
        out: Array = np.unwrap(np.angle(self.response))
        return out

    def usable(self, coherence: float = 0.6) -> NDArray[np.bool_]:
        """(m,) whether the coherence is high enough to trust (Tischler 2012: 0.6)."""
        out: NDArray[np.bool_] = self.coherence >= coherence
        return out


def frequency_responses(
    t: Array,
    inputs: Mapping[str, Array],
    output: str,
    measured: Array,
    *,
    segment_s: float | None = None,
    band_hz: tuple[float, float] | None = None,
) -> tuple[FrequencyResponse, ...]:
    """One response per input, from Hann-windowed segments that overlap by half.

    t: (n,) s, even. inputs: (n,) by name. measured: (n,), called `output`. segment_s: length of a
    segment, a fifth of the record by default; its inverse is the resolution. Raises BadInput for
    uneven time, gaps, too few segments, or inputs that are multiples of each other.
    """
    signals, dt = _signals(t, inputs, output, measured)
    n = len(t)
    size = round((segment_s or (n * dt / SEGMENTS)) / dt)
    size += size % 2
    starts = range(0, n - size + 1, max(size // 2, 1))
    if size < 8 or len(starts) <= len(inputs):
        raise refuse(
            "too_few_segments",
            where=f"frequency response of {output}",
            expected=f"segments of 8 samples or more, and more of them than {len(inputs)} inputs",
            found=f"{len(starts)} of {size} samples in a record of {n}",
            do="Take a longer record or a shorter segment_s.",
        )
    window = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(size) / size)  # Hann
    pieces = np.stack([signals[s : s + size] - signals[s : s + size].mean(axis=0) for s in starts])
    spectra = np.fft.rfft(pieces * window[:, None], axis=1)
    f: Array = np.asarray(np.fft.rfftfreq(size, dt), dtype=np.float64)
    keep = f > 0.0
    if band_hz is not None:
        keep &= (f >= band_hz[0]) & (f <= band_hz[1])
    return _responses(
        tuple(inputs), output, f[keep], spectra[:, keep], _independent(window, starts)
    )


def multisine_responses(
    t: Array,
    inputs: Mapping[str, Array],
    output: str,
    measured: Array,
    *,
    period_s: float,
    harmonics: Mapping[str, Sequence[int]],
) -> tuple[FrequencyResponse, ...]:
    """One response per input at its own harmonics, from whole periods of orthogonal multisines.

    period_s: of the multisine; two periods or more must lie in the record, the first of which may
    be left out by the caller while the aircraft settles. harmonics: whole numbers of cycles a
    period, by input; no two inputs share one. Nothing leaks, so no window is needed. Raises
    BadInput as `frequency_responses`, and where a period is no whole number of samples.
    """
    signals, dt = _signals(t, inputs, output, measured)
    size = round(period_s / dt)
    used = [k for own in harmonics.values() for k in own]
    count = len(t) // size if size else 0
    if (
        abs(size * dt - period_s) > 1e-6 * period_s
        or count < 2
        or len(set(used)) < len(used)
        or not all(0 < k < size / 2 for k in used)
        or set(harmonics) - set(inputs)
    ):
        raise refuse(
            "bad_multisine",
            where=f"frequency response of {output}",
            expected="two whole periods or more of a whole number of samples, and harmonics below "
            "half the sample rate that no two inputs share",
            found=f"{count} periods of {period_s / dt:.6g} samples",
            do="State the period and harmonics of the input as flown.",
        )
    spectra = np.fft.rfft(signals[: count * size].reshape(count, size, -1), axis=1)
    out: list[FrequencyResponse] = []
    for name, own in harmonics.items():
        column = list(inputs).index(name)
        rows = spectra[:, list(own)][:, :, [column, len(inputs)]]
        f = np.array(own) / period_s
        out += _responses((name,), output, f, rows, float(count))
    return tuple(out)


def _responses(
    names: Sequence[str], output: str, f: Array, spectra: np.ndarray, count: float
) -> tuple[FrequencyResponse, ...]:
    """From spectra (segments, m, inputs + 1), the output's last."""
    q = len(names)
    cross = np.einsum("smi,smj->mij", spectra.conj(), spectra) / len(spectra)
    Sxx, Sxy, Syy = cross[:, :q, :q], cross[:, :q, q], cross[:, q, q].real
    size = np.sqrt(np.maximum(np.einsum("mii->mi", Sxx).real, 1e-300))
    scaled = Sxx / (size[:, :, None] * size[:, None, :])
    if (size <= 1e-150).any() or (q > 1 and (np.linalg.cond(scaled) > COLLINEAR).any()):
        raise refuse(
            "no_excitation",
            where=f"frequency response of {output} to {', '.join(names)}",
            expected="inputs that move at every frequency, each on its own",
            found="one that stands still, or inputs that are multiples of each other",
            do="Narrow band_hz, take more segments, or leave an input out.",
        )
    inverse = np.linalg.inv(scaled) / (size[:, :, None] * size[:, None, :])
    H = np.einsum("mij,mj->mi", inverse, Sxy)
    explained = np.einsum("mi,mi->m", H.conj(), Sxy).real
    noise = np.maximum(Syy - explained, 0.0)
    out = []
    for i, name in enumerate(names):
        alone = np.abs(H[:, i]) ** 2 / np.maximum(inverse[:, i, i].real, 1e-300)
        coherence = alone / np.maximum(alone + noise, 1e-300)
        free = max(count - q, 1e-9)
        error = np.sqrt((1.0 - coherence) / np.maximum(coherence, 1e-300) / (2.0 * free))
        out.append(
            FrequencyResponse(
                input=name,
                output=output,
                frequency=frozen(f),
                response=H[:, i].copy(),
                coherence=frozen(coherence),
                gain_error=frozen(error),
                phase_error=frozen(error),
                segments=count,
            )
        )
    return tuple(out)


def _independent(window: Array, starts: range) -> float:
    """How many independent segments overlapping ones are worth (Welch 1967)."""
    count, step = len(starts), starts.step
    total = 1.0
    for j in range(1, count):
        apart = j * step
        if apart >= len(window):
            break
        share = float(window[apart:] @ window[:-apart] / (window @ window))
        total += 2.0 * (1.0 - j / count) * share**2
    return count / total


def _signals(
    t: Array, inputs: Mapping[str, Array], output: str, measured: Array
) -> tuple[Array, float]:
    """Columns of inputs, then the output; sample interval."""
    if not inputs or any(len(x) != len(t) for x in (*inputs.values(), measured)) or len(t) < 16:
        raise _bad(output, "at least one input, all as long as time, 16 samples or more",
                   f"{len(inputs)} inputs, {len(t)} samples")  # fmt: skip
    signals = np.column_stack([*inputs.values(), measured])
    steps = np.diff(t)
    dt = float(t[-1] - t[0]) / (len(t) - 1)
    if not np.isfinite(signals).all() or not (np.abs(steps - dt) < 1e-3 * dt).all():
        raise _bad(output, "finite samples, evenly spaced", "gaps or uneven time")
    return signals, dt


def _bad(output: str, expected: str, found: str) -> BadInput:
    return refuse(
        "bad_signals",
        where=f"frequency response of {output}",
        expected=expected,
        found=found,
        do="Put the channels on one even time base without gaps.",
    )
