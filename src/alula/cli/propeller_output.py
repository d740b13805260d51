"""What `alula propeller` prints and writes: the envelope's result, the table."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from alula.cli.propeller import Work


def result_of(work: Work) -> dict[str, Any]:
    """The envelope's `result`: SI, rad."""
    b = work.blades
    return {
        "name": b.name, "diameter": b.diameter, "blades": b.count, "rpm": work.rpm,
        "source": b.source,
        "models": [
            {
                "name": name, "method": c.method, "windmill_J": last, "J": c.J.tolist(),
                "CT": c.CT.tolist(), "CP": c.CP.tolist(), "eta": c.eta.tolist(),
                "notes": list(c.notes),
            }
            for name, (c, last) in work.curves.items()
        ],
        "fits": [
            {
                "name": name, "n": len(fit.test.J), "rms_CT": fit.rms_CT,
                "rms_CP": fit.rms_CP, "status": fit.status,
                "parameters": [
                    {
                        "name": e.name, "value": e.value, "unit": e.unit,
                        "se": e.se if isfinite(e.se) else None, "verdict": e.verdict,
                        "tied_to": [{"name": n, "weight": w} for n, w in e.tied_to],
                        "note": e.note,
                    }
                    for e in fit.estimates
                ],
            }
            for name, fit in work.fits.items()
        ],
    }  # fmt: skip


def text_of(work: Work) -> str:
    """What the command prints."""
    b = work.blades
    lines = [f"{b.name}: {b.count} blades, diameter {b.diameter:.4g} m ({b.source})"]
    for name, fit in work.fits.items():
        lines.append(
            f"\nFitted to the {name}, {len(fit.test.J)} values: rms {100 * fit.rms_CT:.3g} % "
            f"of the largest CT, {100 * fit.rms_CP:.3g} % of the largest CP"
        )
        for e in fit.estimates:
            se = f"± {e.se:.3g}" if isfinite(e.se) and e.verdict != "given" else ""
            tied = ", tied to " + ", ".join(n for n, _ in e.tied_to) if e.tied_to else ""
            verdict = e.verdict.replace("_", " ")
            words = f"{verdict}{tied}" + (f": {e.note}" if e.note else "")
            lines.append(f"  {e.name:<10}{e.value:>9.4g} {se:<9} {e.unit:<8} {words}")
        if fit.parameters is None:
            lines.append(f"  No curves: {fit.status}.")
    for name, (c, last) in work.curves.items():
        lines.append(f"\n{name}: {c.method}; windmill beyond J = {last:.4g}")
        lines += [f"  {text}" for text in c.notes]
        lines.append(f"{'J':>8}{'CT':>10}{'CP':>10}{'eta':>8}")
        lines += [
            f"{j:>8.4g}{t:>10.5f}{p:>10.5f}" + (f"{e:>8.3f}" if t >= 0.0 else f"{'-':>8}")
            for j, t, p, e in zip(c.J, c.CT, c.CP, c.eta, strict=True)
        ]
    return "\n".join(lines)
