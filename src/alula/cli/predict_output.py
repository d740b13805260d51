"""What `alula predict` writes: the envelope's result, and text."""

from __future__ import annotations

from typing import Any

from alula.predict.combine import as_flown
from alula.predict.derivatives import Derivatives, Estimate, PredictionAxes
from alula.predict.lattice_result import LatticeResult
from alula.predict.prediction import Prediction

_Z = 1.96  # of a normal distribution's 95 % interval


def result_of(found: Prediction, axes: PredictionAxes, per_degree: bool) -> dict[str, Any]:
    """The envelope's `result`: SI, rad (or per degree where the name says so)."""
    a = found.aircraft
    shown = found.along(axes, per_degree=per_degree)
    return {
        "method": found.method,
        "axes": "body" if axes == "model" else axes,
        "per": "deg" if per_degree else "rad",
        "conventions": list(found.conventions(axes, per_degree=per_degree)),
        "reference": {"S": a.S, "b": a.b, "c": a.c},
        "reference_point": a.reference_point.tolist(),
        "condition": {
            "V": found.flow.V,
            "h": found.h,
            "mach": found.flow.mach,
            "alpha": found.alpha,
            "density": found.flow.density,
        },
        "cg": None if a.mass is None else a.mass.cg.tolist(),
        "neutral_point": None
        if found.neutral_point is None
        else {
            "position": found.neutral_point.tolist(),
            "se_x": found.neutral_se,
            "static_margin": found.margin,
        },
        "derivatives": [_entry(n, e) for n, e in shown.values.items()],
        "as_flown": [] if per_degree else [_entry(n, e) for n, e in as_flown(shown).items()],
        "methods": [
            {
                "method": part.method,
                "axes": "body" if part.axes == "model" else part.axes,
                "conditions": dict(part.conditions),
                "derivatives": [_entry(n, e) for n, e in part.values.items()],
            }
            for part in found.parts
        ],
        "conditions": dict(shown.conditions),
        "notes": list(shown.notes),
        "lattice": _lattice(found),
        "mesh_study": _study(found),
    }


def _entry(name: str, e: Estimate) -> dict[str, Any]:
    half = _Z * e.se
    return {
        "name": name,
        "value": e.value,
        "se": e.se,
        "ci95": [e.value - half, e.value + half],
        "source": e.source,
    }


def _lattice(found: Prediction) -> dict[str, Any] | None:
    r = found.lattice
    if r is None:
        return None
    return {
        "panels": {name: list(mesh) for name, mesh in r.panels.mesh.items()},
        "count": r.panels.count,
        "alpha": r.alpha,
        "wake": r.wake,
        "loads": _loads(found.loads),
    }


def _loads(r: LatticeResult | None) -> dict[str, Any] | None:
    """Of the surfaces alone, in flight's angle of attack."""
    if r is None:
        return None
    return {
        "alpha": r.alpha,
        "coefficients": r.coefficients("stability"),
        "induced_drag": r.induced_drag,
        "oswald": r.oswald,
        "oswald_of": r.oswald_of,
        "span": [
            {
                "surface": s.surface,
                "y": s.position[:, 1].tolist(),
                "z": s.position[:, 2].tolist(),
                "chord": s.chord.tolist(),
                "c_l": s.c_l.tolist(),
                "circulation": s.circulation.tolist(),
            }
            for s in r.span_loads
        ],
    }


def _study(found: Prediction) -> dict[str, Any] | None:
    s = found.study
    if s is None:
        return None
    return {
        "counts": s.counts.tolist(),
        "axes": "body",
        "derivatives": [
            {"name": n, "values": v.tolist(), "limit": s.limit[n], "error": s.error[n]}
            for n, v in s.values.items()
        ],
    }


def text_of(found: Prediction, axes: PredictionAxes, per_degree: bool) -> str:
    """Conventions, the derivatives by method, what flight can tell of them, notes."""
    lines = list(found.conventions(axes, per_degree=per_degree))
    shown = found.along(axes, per_degree=per_degree)
    lines += ["", *_table(found, shown)]
    flown = {} if per_degree else as_flown(shown)
    sums = {n: e for n, e in flown.items() if n not in shown.values}
    if sums:
        lines.append("as flight shows them:")
        lines += [f"{n:<22}{_number(e.value, 10)}{e.se:>10.2g}" for n, e in sums.items()]
    if found.neutral_point is not None:
        margin = found.margin
        words = "" if margin is None else f": {100 * margin:.1f} % of c behind the CG"
        lines += [
            "",
            f"Neutral point, fixed controls: x {found.neutral_point[0]:.4g} m +- "
            f"{found.neutral_se:.2g} m{words}",
        ]
    lines += _said(found, shown)
    return "\n".join(lines)


def _table(found: Prediction, shown: Derivatives) -> list[str]:
    parts = found.parts if len(found.parts) > 1 else ()
    wide = 18 if any(n.endswith("deg") or n.endswith("deg2") for n in shown.values) else 14
    head = f"{'derivative':<{wide}}{'value':>10}{'se':>10}{'of value':>10}"
    head += "  source" if not parts else "".join(f"  {p.method:>20}" for p in parts)
    lines = [head, "-" * len(head)]
    beside = [_beside(found, k, shown) for k in range(len(parts))]
    for name, e in shown.values.items():
        share = f"{abs(e.se / e.value):.0%}" if e.value else "-"
        line = f"{name:<{wide}}{_number(e.value, 10)}{e.se:>10.2g}{share:>10}"
        if parts:
            line += "".join(f"  {_cell(b.values.get(name)):>20}" for b in beside)
        else:
            source = e.source if len(e.source) <= 60 else e.source[:59] + "…"
            line += f"  {source}"
        lines.append(line)
    if parts:
        lines.append("Where each number comes from in words: --json, --report.")
    return lines


def _beside(found: Prediction, k: int, shown: Derivatives) -> Derivatives:
    """One part in the axes and units of what is shown."""
    from dataclasses import replace

    alone = replace(found, derivatives=found.parts[k])
    per_degree = any(n.endswith(("_per_deg", "_per_deg2")) for n in shown.values)
    return alone.along(shown.axes, per_degree=per_degree)


def _cell(e: Estimate | None) -> str:
    return "-" if e is None else f"{_number(e.value, 9)} +- {e.se:.2g}"


def _number(value: float, wide: int) -> str:
    return f"{value:>{wide}.4f}" if abs(value) >= 0.001 or value == 0.0 else f"{value:>{wide}.2e}"


def _said(found: Prediction, shown: Derivatives) -> list[str]:
    lines = []
    s = found.study
    if s is not None and found.lattice is not None:
        worst = sorted(s.error, key=lambda n: -s.error[n] / max(abs(s.values[n][0]), 0.02))[:3]
        words = ", ".join(f"{n} {s.error[n]:.2g}" for n in worst)
        counts = ", ".join(f"{c:.0f}" for c in s.counts)
        lines.append(f"Mesh study with {counts} panels; largest errors of the mesh: {words}")
    elif found.lattice is not None:
        lines.append(
            f"Lattice of {found.lattice.panels.count} panels, its mesh not studied: --mesh-study"
        )
    lines += [f"note: {n}" for n in shown.notes]
    return lines
