"""A picture of an identification: measured against model, one row per coefficient."""

from __future__ import annotations

from typing import TYPE_CHECKING

from alula.identify.result import Identification

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def plot(result: Identification) -> Figure:
    """Measured and modeled coefficients over time; one column per maneuver, residual below zero.

    The figure is not tied to a window; save it with `savefig` or show it in a notebook.
    """
    from matplotlib.figure import Figure

    maneuvers = list(dict.fromkeys(s.maneuver for s in result.series))
    coefficients = list(result.fits)
    figure = Figure(
        figsize=(4.0 + 3.0 * len(maneuvers), 1.0 + 2.0 * len(coefficients)), layout="constrained"
    )
    axes = figure.subplots(len(coefficients), len(maneuvers), squeeze=False)
    shown = {(s.coefficient, s.maneuver): s for s in result.series}
    for i, coefficient in enumerate(coefficients):
        for j, maneuver in enumerate(maneuvers):
            ax = axes[i][j]
            series = shown.get((coefficient, maneuver))
            if series is None:
                ax.set_axis_off()
                continue
            ax.plot(series.t, series.measured, color="0.55", label="measured")
            ax.plot(series.t, series.model, color="C0", linestyle="--", label="model")
            ax.plot(series.t, series.measured - series.model, color="C3", lw=0.8, label="residual")
            ax.set_title(maneuver + (" (held out)" if series.held_out else ""), fontsize="small")
            ax.set_xlabel("f, Hz" if series.over == "Hz" else "t, s")
            ax.set_ylabel(f"{coefficient} {result.labels.get(coefficient, '')}".strip())
            ax.grid(visible=True, alpha=0.3)
    drawn = [ax for row in axes for ax in row if ax.has_data()]
    if drawn:
        drawn[0].legend(fontsize="small")
    return figure
