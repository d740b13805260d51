"""Output error in the frequency domain: linear model, with delays of the controls as parameters.

Klein and Morelli 2006, ch. 7. Over a record of T seconds the state equations transform, exactly, to

    (j w - A) X = B U exp(-j w tau) + x(0) - x(T) exp(-j w T),        Y = C X + D U exp(-j w tau).

At the multiples of 1/T constants vanish, so that biases and trim need no parameters, and of the
ends only the difference x(0) - x(T) is left, which is estimated. Any delay is as smooth as other
parameters here; in time it is not. The noise of an output has one variance over the band, estimated
along; error bars take the ordinates' own sizes (coloured noise).
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import note, refuse
from alula.identify.frequency.fourier import fourier_integral, harmonics
from alula.identify.likelihood.named_search import prior_blocks, search_named
from alula.identify.likelihood.optimizer import Algorithm, Point
from alula.identify.likelihood.parameters import Fitted, Prior, Whitened, assembled
from alula.identify.linear.model import LinearModel
from alula.identify.linear.noise_search import left_aside
from alula.identify.linear.output_error import learned, summed
from alula.identify.linear.record import LinearRecord, Unknowns
from alula.identify.linear.start import first_values
from alula.identify.result import Identification

Complex = np.ndarray
_SINGULAR = 1e12  # condition of j w - A: a pole lies on the frequency


def identify_frequency_output_error(
    model: LinearModel,
    records: Sequence[LinearRecord],
    *,
    band_hz: tuple[float, float],
    delayed: Collection[str] = (),
    start: Mapping[str, float] | None = None,
    fixed: Mapping[str, float] | None = None,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    priors: Mapping[str, Prior] | None = None,
    algorithm: Algorithm = "gauss_newton",
    scales: Mapping[str, float] | None = None,
    truth: Mapping[str, float] | None = None,
) -> Identification:
    """Parameters of `model` from the transforms of outputs within `band_hz`, Hz.

    delayed: inputs that act later than they are measured, by 'delay_da' s, estimated from 0 on.
    Parameters that only make constants ('L0') have no frequency: they are left out, which is said.
    start, fixed, bounds, priors: as in `identify_linear_output_error`. The series of the result are
    amplitudes over frequency (Hz). Outputs must have no gaps.
    """
    learn = learned(records)
    wrong = [u for u in delayed if u not in model.inputs]
    if wrong or not 0.0 <= band_hz[0] < band_hz[1] < np.inf:
        raise refuse(
            "bad_option",
            where="frequency-domain output error",
            expected=f"delays of {', '.join(model.inputs)}; a band from low to high in Hz",
            found=", ".join(wrong) or repr(band_hz),
            do="Correct it.",
        )
    silent = [p for p in model.parameters if p not in (fixed or {}) and _only_constant(model, p)]
    held = {**{n: v for n, v in (fixed or {}).items() if not n.startswith("delay_")},
            **dict.fromkeys(silent, 0.0)}  # fmt: skip
    unknowns = Unknowns(model, learn, (), held, initial=True)
    problem = FrequencyError(model, learn, unknowns, tuple(delayed), band_hz)
    names = problem.names
    first = np.append(first_values(model, learn, unknowns), np.zeros(len(delayed)))
    first[np.array(["(0)" in n for n in names])] = 0.0  # the difference of the ends
    first = problem.vector(start or {}, first)
    found = search_named(problem.likelihood, first, problem.vector, bounds, priors, algorithm)
    blocks = problem.blocks(found.value) if found.information.any() else []
    blocks += prior_blocks(names, found.value, priors or {})
    said = [
        note(
            "no_constants",
            where=", ".join(silent),
            expected="parameters that act at some frequency",
            found="constants, which vanish at the multiples of one over the record's length",
            do="Nothing; find trim and biases in the time domain.",
        )
    ] if silent else []  # fmt: skip
    shown = problem.fitted(found.value) if found.converged else []
    belongs = {**model.belongs, **{f"delay_{u}": u for u in delayed}}
    return assembled(
        "frequency-domain output error", [n.replace("(0)", "(0)-(T)") for n in names], belongs,
        blocks, found, shown, model.rows, scales=scales, truth=truth,
        messages=(*said, *left_aside(records)), ordinates=True,
    )  # fmt: skip


class FrequencyError:
    """The likelihood of several maneuvers' transforms. names: of the search's vector."""

    def __init__(
        self,
        model: LinearModel,
        records: Sequence[LinearRecord],
        unknowns: Unknowns,
        delayed: tuple[str, ...],
        band: tuple[float, float],
    ) -> None:
        self.model, self.records, self.unknowns = model, records, unknowns
        self.late = [model.inputs.index(u) for u in delayed]
        self.names = (*unknowns.free_names, *(f"delay_{u}" for u in delayed))
        self.frequencies, self.inputs, self.outputs = [], [], []
        for r in records:
            f = harmonics(r.dt * (len(r.t) - 1), *band)
            f = f[f < 0.5 / r.dt]
            if len(f) < 2:
                raise refuse(
                    "narrow_band",
                    where=f"maneuver {r.id}",
                    expected="two multiples of one over the record's length within the band",
                    found=f"{len(f)} from {band[0]:.3g} to {band[1]:.3g} Hz",
                    do="Widen band_hz or take a longer record.",
                )
            self.frequencies.append(f)
            self.inputs.append(fourier_integral(r.inputs, r.dt, f))
            self.outputs.append(fourier_integral(r.outputs, r.dt, f))

    def vector(self, by_name: Mapping[str, float], default: Array) -> Array:
        """Values by name, delays among them."""
        k = len(self.unknowns.free)
        late = {n: v for n, v in by_name.items() if n.startswith("delay_") and n in self.names}
        rest = {n: v for n, v in by_name.items() if n not in late}
        out = np.append(self.unknowns.vector(rest, default[:k]), default[k:])
        for name, value in late.items():
            out[self.names.index(name)] = value
        return out

    def likelihood(self, p: Array, derivatives: bool) -> Point | None:
        """Cost with every output's variance at its best for p."""
        runs = [self._residuals(i, p, derivatives) for i in range(len(self.records))]
        parts = [r for r in runs if r is not None]
        if len(parts) < len(runs):
            return None
        r, count = self._variances([v for v, _ in parts])
        cost = 0.5 * count * float(np.sum(np.log(r)))
        if not derivatives:
            return Point(cost)
        return summed(cost, parts, r)

    def blocks(self, p: Array) -> list[Whitened]:
        """One block per output and maneuver, real and imaginary parts in turn."""
        runs = [run for i in range(len(self.records)) if (run := self._residuals(i, p, True))]
        deviation = np.sqrt(self._variances([v for v, _ in runs])[0])
        return [
            Whitened(S[:, i] / size, v[:, i] / size)
            for v, S in runs
            for i, size in enumerate(deviation)
        ]

    def fitted(self, p: Array) -> list[Fitted]:
        """Amplitudes measured and modeled over frequency."""
        out = []
        for i, record in enumerate(self.records):
            y, _ = self._outputs(i, p, False)
            out += [
                Fitted(name, record.id, self.frequencies[i], np.abs(self.outputs[i][:, k]),
                       np.abs(y[:, k]), False)
                for k, name in enumerate(self.model.outputs)
            ]  # fmt: skip
        return out

    def _variances(self, residuals: Sequence[Array]) -> tuple[Array, int]:
        count = sum(len(v) for v in residuals)
        total = sum((np.sum(v**2, axis=0) for v in residuals), np.zeros(len(self.model.outputs)))
        power = sum(float(np.sum(np.abs(z) ** 2)) for z in self.outputs) / count
        return np.maximum(total / count, 1e-24 * power + 1e-300), count

    def _residuals(self, i: int, p: Array, derivatives: bool) -> tuple[Array, Array] | None:
        """Residuals (2m, k) and sensitivities (2m, k, free): real and imaginary parts in turn."""
        try:
            with np.errstate(all="ignore"):
                y, S = self._outputs(i, p, derivatives)
        except np.linalg.LinAlgError:
            return None
        if not np.isfinite(y).all() or not np.isfinite(S).all():
            return None
        return _real_rows(self.outputs[i] - y), _real_rows(S)

    def _outputs(self, i: int, p: Array, derivatives: bool) -> tuple[Complex, Complex]:
        model, k = self.model, len(self.unknowns.free)
        values, ends = self.unknowns.of(i, p[:k])
        m = model.at(values)
        w = 2.0 * np.pi * self.frequencies[i]
        U, dU = self._delayed(i, w, p[k:])
        B, D = m.B[:, :-1], m.D[:, :-1]
        s = len(ends)
        inverse = np.linalg.inv(1j * w[:, None, None] * np.eye(s) - m.A)
        X = np.einsum("nab,nb->na", inverse, U @ B.T + ends)
        Y = X @ m.C.T + U @ D.T
        if not derivatives:
            return Y, np.zeros((0, 0, 0))
        slopes, j = model.slopes, len(values)
        force = np.zeros((len(w), s, j + s), dtype=complex)
        force[:, :, :j] = np.einsum("jab,nb->naj", slopes.A, X) + np.einsum(
            "jab,nb->naj", slopes.B[:, :, :-1], U
        )
        force[:, :, j:] = np.eye(s)
        S = m.C @ (inverse @ force)
        S[:, :, :j] += np.einsum("jka,na->nkj", slopes.C, X) + np.einsum(
            "jkb,nb->nkj", slopes.D[:, :, :-1], U
        )
        own = self.unknowns.spread(i, S.real) + 1j * self.unknowns.spread(i, S.imag)
        through = m.C @ inverse @ B + D  # (n, k, m)
        late = through[:, :, self.late] * dU[:, None, self.late]
        return Y, np.concatenate([own, late], axis=2)

    def _delayed(self, i: int, w: Array, delays: Array) -> tuple[Complex, Complex]:
        """Transforms of the inputs as they act, and by their delays; (n, m) each.

        Before the record an input stands at its first value; what it still had to do at the end
        has not acted. u(t - tau) over the record is exp(-j w tau) [U + (u_0 - u_T exp(-j w T))
        (exp(j w tau) - 1) / (j w)].
        """
        U, record = self.inputs[i], self.records[i]
        tau = np.zeros(U.shape[1])
        tau[self.late] = delays
        first, last = record.inputs[0], record.inputs[-1]  # exp(-j w T) is 1 at these frequencies
        back = np.exp(-1j * np.outer(w, tau))
        edge = (first - last) / (1j * w[:, None])
        late = back * (U - edge) + edge
        return late, -1j * w[:, None] * back * (U - edge)


def _only_constant(model: LinearModel, parameter: str) -> bool:
    i = model.parameters.index(parameter)
    s = model.slopes
    return not (s.A[i].any() or s.C[i].any() or s.B[i][:, :-1].any() or s.D[i][:, :-1].any())


def _real_rows(x: Complex) -> Array:
    out = np.empty((2 * len(x), *x.shape[1:]))
    out[0::2], out[1::2] = x.real, x.imag
    return out
