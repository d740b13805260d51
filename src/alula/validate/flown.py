"""One maneuver's recorded controls through the model, open loop, from the measured start."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import BadInput, Message, note, refuse, warn
from alula.model import AeroModel
from alula.simulate import Airframe, SimulatedFlight, fly, initial_state
from alula.validate.case import Case
from alula.validate.prepare import FORCES, STATES, Recording, driven, recording
from alula.validate.quality import quality
from alula.validate.result import ChannelMatch, Flown

STEP = 0.01  # s, of the integration at most: a twentieth of the fastest rigid-body mode's radian
STRAY_ANGLE = np.radians(45.0)  # flow angle beyond which no model of attached flow means anything
STRAY_SPEED = 3.0  # times the entry airspeed, or a third of it
UNITS = {
    "V": "m/s", "alpha": "rad", "beta": "rad", "p": "rad/s", "q": "rad/s", "r": "rad/s",
    "phi": "rad", "theta": "rad", "psi": "rad", "h": "m", "ax": "m/s2", "ay": "m/s2", "az": "m/s2",
}  # fmt: skip
AXIS: Mapping[str, tuple[str, ...]] = {
    "longitudinal": ("V", "alpha", "q", "theta", "ax", "az", "h"),
    "lateral": ("beta", "p", "r", "phi", "psi", "ay"),
    "both": tuple(UNITS),
}
# What moves with a coefficient: channels that prove nothing when it comes from the recording.
FOLLOWS: Mapping[str, tuple[str, ...]] = {
    "CX": ("V", "ax"), "CD": ("V", "ax"), "CZ": ("alpha", "az", "h"), "CL": ("alpha", "az", "h"),
    "Cm": ("q", "theta"), "CY": ("beta", "ay"), "Cl": ("p", "phi"), "Cn": ("r", "psi"),
}  # fmt: skip


def fly_case(
    model: AeroModel,
    case: Case,
    *,
    gravity: float,
    trim: Callable[[AeroModel], Mapping[str, float]],
    draws: int,
    seed: int,
    horizon: float | None,
) -> tuple[Flown, tuple[Message, ...]]:
    """Fly one maneuver and compare.

    trim: the constants to be added to a model's coefficients in this maneuver. draws: parameter
    sets from the model's covariance, each trimmed anew.

    Raises BadInput where a control or coefficient that the model needs was not recorded.
    """
    maneuver = case.motion.maneuver
    where = f"maneuver {maneuver.id}"
    record = recording(case, horizon)
    offsets = trim(model)
    complete, controls, lacking = driven(model, record, offsets, where)
    messages = list(record.messages)
    if lacking:
        messages.append(_as_recorded(where, model, lacking))
    flown = _Flight(record, case.airframe, controls, gravity)
    columns = flown.fly(complete, len(record.t))
    n = _until(columns, record)
    departed = float(record.t[n]) if n < len(record.t) else None
    if departed is not None:
        messages.append(_departed(where, departed, record, columns))
    columns = {name: values[:n] for name, values in columns.items()}
    sets = _sets(model, complete, trim, draws, seed)
    sigma, used, lost = _spread(sets, flown, columns, n)
    if lost:
        messages.append(_lost(where, lost, draws))
    follows = {c for name in lacking for c in FOLLOWS[name]}
    channels = {
        name: ChannelMatch(
            name=name,
            unit=unit,
            measured=frozen(record.channels[name][:n]),
            model=frozen(columns[name]),
            model_se=None if sigma is None else frozen(sigma[name]),
            quality=quality(record.channels[name][:n], columns[name]),
            in_axis=name in AXIS[maneuver.aspect],
            as_recorded=name in follows,
            recorded=name not in case.missing and float(np.ptp(record.channels[name])) > 0.0,
        )
        for name, unit in UNITS.items()
    }
    result = Flown(
        maneuver=maneuver,
        seen=case.seen,
        t=frozen(record.t[:n]),
        channels=channels,
        controls={name: frozen(u[:n]) for name, u in record.controls.items()},
        asked=float(record.t[-1] - record.t[0]),
        diverged_at=departed,
        offsets=dict(offsets),
        as_recorded=lacking,
        draws=used,
        outside=_outside(model, columns, record, n),
    )
    return result, tuple(messages)


def simulated(model: AeroModel, case: Case, gravity: float) -> SimulatedFlight:
    """A case's controls through the model, to the end; raises BadInput ('diverged') where it leaves
    what the model can describe, and where `fly_case` does.
    """
    where = f"maneuver {case.motion.maneuver.id}"
    record = recording(case, None)
    complete, controls, _ = driven(model, record, {}, where)
    set_up = _Flight(record, case.airframe, controls, gravity)
    n = len(record.t)
    columns = set_up.fly(complete, n)
    if _until(columns, record) < n or len(columns["V"]) < n:
        raise refuse(
            "diverged",
            where=where,
            expected="a flight that the model can describe to its end",
            found="one that left it",
            do="Shorten the maneuver.",
        )
    return set_up.flight(complete, n)


class _Flight:
    """The simulator set up for one recording: everything but the model."""

    def __init__(
        self, record: Recording, airframe: Airframe, controls: Mapping[str, Array], gravity: float
    ) -> None:
        self.record, self.airframe, self.gravity = record, airframe, gravity
        self.inputs = {**controls, "thrust": record.thrust}
        first = {name: float(record.channels[name][0]) for name in STATES}
        self.x0 = initial_state(
            first["V"],
            first["alpha"],
            first["theta"],
            first["h"] + record.height_shift,
            beta=first["beta"],
            phi=first["phi"],
            psi=first["psi"],
            rates=(first["p"], first["q"], first["r"]),
        )
        step = float(record.t[1] - record.t[0])
        self.substeps = max(1, int(np.ceil(step / STEP - 1e-9)))

    def fly(self, model: AeroModel, n: int) -> dict[str, Array]:
        """The channels over the first n samples, or as many as stay finite."""
        try:
            return self._fly(model, n)
        except BadInput as error:
            if error.messages[0].code != "diverged":
                raise
        low, high = 1, n  # flies for `low` samples, not for `high`
        columns = {name: self.record.channels[name][:1] for name in UNITS}
        while high - low > 1:
            middle = (low + high) // 2
            try:
                columns = self._fly(model, middle)
                low = middle
            except BadInput:
                high = middle
        return columns

    def flight(self, model: AeroModel, n: int) -> SimulatedFlight:
        """The first n samples; raises BadInput where it diverges."""
        return fly(
            self.airframe,
            model,
            self.x0,
            self.record.t[:n],
            {name: u[:n] for name, u in self.inputs.items()},
            gravity=self.gravity,
            substeps=self.substeps,
        )

    def _fly(self, model: AeroModel, n: int) -> dict[str, Array]:
        record = self.record
        motion = self.flight(model, n).motion
        out = {name: np.asarray(getattr(motion, name)) for name in (*STATES, *FORCES)}
        out["h"] = out["h"] - record.height_shift
        for name in ("phi", "psi"):  # without jumps, on the turn of the recording
            angle = np.unwrap(out[name])
            turns = np.round((record.channels[name][0] - angle[0]) / (2.0 * np.pi))
            out[name] = angle + 2.0 * np.pi * turns
        return out


def _until(columns: Mapping[str, Array], record: Recording) -> int:
    """Samples until the model strays from any flight it could describe."""
    V0 = record.channels["V"][0]
    stray = (
        (np.abs(columns["alpha"]) > STRAY_ANGLE)
        | (np.abs(columns["beta"]) > STRAY_ANGLE)
        | (columns["V"] > STRAY_SPEED * V0)
        | (columns["V"] < V0 / STRAY_SPEED)
    )
    return max(2, int(np.argmax(stray))) if stray.any() else len(stray)


def _sets(
    model: AeroModel,
    complete: AeroModel,
    trim: Callable[[AeroModel], Mapping[str, float]],
    draws: int,
    seed: int,
) -> Iterator[AeroModel]:
    """The model as flown with parameters drawn from their covariance; none where it has none."""
    if model.covariance is None or draws < 2:
        return
    values, vectors = np.linalg.eigh(model.covariance)
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    k = len(values)
    for row in np.random.default_rng(seed).standard_normal((draws, k)):
        changed = np.array(model.values + root @ row)
        offsets = list(trim(replace(model, values=changed)).values())
        driving = complete.values[k : len(complete.values) - len(offsets)]
        yield replace(complete, values=np.concatenate([changed, driving, offsets]))


def _spread(
    sets: Iterator[AeroModel], flown: _Flight, columns: Mapping[str, Array], n: int
) -> tuple[dict[str, Array] | None, int, int]:
    """Standard deviation by channel over parameter sets, how many served, how many did not fly."""
    squares = {name: np.zeros(n) for name in UNITS}
    used = lost = 0
    for model in sets:
        other = flown.fly(model, n)
        if len(other["V"]) < n or _until(other, flown.record) < n:
            lost += 1
            continue
        used += 1
        for name in UNITS:
            squares[name] += (other[name] - columns[name]) ** 2
    if used < 2:
        return None, used, lost
    return {name: np.sqrt(s / used) for name, s in squares.items()}, used, lost


def _outside(
    model: AeroModel, columns: Mapping[str, Array], record: Recording, n: int
) -> dict[str, tuple[float, float, float]]:
    """Variables of the model's terms that left its range: farthest value and the range."""
    used = {name for _, term in model.terms for f in term.factors for name in f.variables}
    ref = model.reference
    flown = {
        "alpha": columns["alpha"],
        "beta": columns["beta"],
        "V": columns["V"],
        "phat": columns["p"] * ref.b / (2.0 * columns["V"]),
        "qhat": columns["q"] * ref.c / (2.0 * columns["V"]),
        "rhat": columns["r"] * ref.b / (2.0 * columns["V"]),
        **{name: u[:n] for name, u in record.controls.items()},
    }
    out = {}
    for name, (low, high) in model.validity.items():
        if name not in used or name not in flown:
            continue
        # a hundredth of the range beyond it is no extrapolation worth a word
        slack = 0.01 * (high - low)
        values = flown[name]
        beyond = np.maximum(low - slack - values, values - high - slack)
        if beyond.max() > 0.0:
            out[name] = (float(values[int(np.argmax(beyond))]), low, high)
    return out


def _as_recorded(where: str, model: AeroModel, lacking: tuple[str, ...]) -> Message:
    channels = dict.fromkeys(c for name in lacking for c in FOLLOWS[name])
    return note(
        "coefficient_as_recorded",
        where=where,
        expected=f"a formula for every coefficient in the model '{model.name}'",
        found=f"none for {', '.join(lacking)}",
        do=f"Their recorded histories were flown; {', '.join(channels)} prove nothing then.",
    )


def _departed(where: str, at: float, record: Recording, columns: Mapping[str, Array]) -> Message:
    k = min(len(columns["V"]) - 1, int(np.searchsorted(record.t, at)))
    alpha, beta = np.degrees(columns["alpha"][k]), np.degrees(columns["beta"][k])
    return warn(
        "model_flight_diverged",
        where=where,
        expected=f"a flight of the model until {record.t[-1]:.5g} s",
        found=f"at {at:.5g} s it left what the model can describe (then alpha {alpha:.3g} deg, "
        f"beta {beta:.3g} deg, V {columns['V'][k]:.4g} m/s)",
        do="Compared until then. Look at the signs of the derivatives and their error bars, or "
        "ask for a shorter --horizon.",
    )


def _lost(where: str, lost: int, draws: int) -> Message:
    return warn(
        "draws_diverged",
        where=where,
        expected=f"{draws} flights with parameters drawn from their covariance",
        found=f"{lost} that left what the model can describe",
        do="The band leaves them out and is too narrow: the parameters' errors allow models that "
        "do not fly like this.",
    )
