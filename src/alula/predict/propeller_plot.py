"""A propeller's coefficients over the advance ratio, models beside tests."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from alula.predict.propeller_curves import PropellerCurves
from alula.predict.propeller_test import PropellerTest

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def plot_propeller(
    title: str,
    curves: Sequence[tuple[str, PropellerCurves]],
    test: PropellerTest | None = None,
    fitted_below: float | None = None,
) -> Figure:
    """CT, CP and efficiency, one panel each; every measured value is shown, whatever was fitted.

    curves: label and curve. fitted_below: J up to which the test was fitted, marked.
    The figure is not tied to a window; save it with `savefig`.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 4.2), layout="constrained")
    panels = figure.subplots(1, 3)
    names = ("CT", "CP", "efficiency J CT/CP")
    if test is not None:
        runs = np.array(test.run)
        for k, run in enumerate(sorted(set(test.run))):
            at = runs == run
            J, CT, CP = test.J[at], test.CT[at], test.CP[at]
            drives = (J > 0.0) & (CP > 0.0) & (CT > -0.3 * CP)
            color = f"C{k % 10}"
            panels[0].plot(J, CT, ".", color=color, ms=4, label=run)
            panels[1].plot(J, CP, ".", color=color, ms=4)
            panels[2].plot(J[drives], (J * CT)[drives] / CP[drives], ".", color=color, ms=4)
    for k, (label, curve) in enumerate(curves):
        style = ("-", "--", "-.", ":")[k % 4]
        for panel, values in zip(panels, (curve.CT, curve.CP, curve.eta), strict=True):
            panel.plot(curve.J, values, style, color="black", lw=1.4, label=label)
    for panel, name in zip(panels, names, strict=True):
        panel.set_xlabel("advance ratio J = V/(n D)")
        panel.set_title(name, fontsize=10)
        panel.axhline(0.0, color="0.8", lw=0.8)
        if fitted_below is not None:
            panel.axvline(fitted_below, color="0.6", lw=0.8, ls=":")
        panel.grid(alpha=0.2)
    panels[2].set_ylim(-0.2, 1.05)
    panels[0].legend(fontsize=6)
    figure.suptitle(title, fontsize=11)
    return figure
