"""The result of an identification as plain text, in the layout that statsmodels readers know."""

from __future__ import annotations

from textwrap import wrap

from alula.identify.result import Identification, Parameter
from alula.identify.typical import flown_sum

_WIDTH = 104


def summary(result: Identification) -> str:
    """Fits, then parameters with both standard errors, interval and verdict, then ties."""
    lines = ["Identification by " + result.method, "=" * _WIDTH]
    lines.append(
        f"{'coefficient':<12}{'R2':>8}{'RRMSE':>9}{'D-W':>7}{'samples':>9}"
        f"{'R2 held out':>13}{'held out':>10}  model"
    )
    for name, fit in result.fits.items():
        held = f"{fit.r2_held_out:>13.4f}" if fit.n_held_out else f"{'-':>13}"
        label = f" ({result.labels[name]})" if name in result.labels else ""
        lines.append(
            f"{name:<12}{fit.r2:>8.4f}{fit.rrmse:>9.2%}{fit.durbin_watson:>7.2f}{fit.n:>9d}"
            f"{held}{fit.n_held_out:>10d}  {fit.formula}{label}"
        )
    lines += ["-" * _WIDTH, _header(result), "-" * _WIDTH]
    wide, units = _name_width(result), _unit_width(result)
    lines += [_row(p, wide, units) for p in result.parameters]
    given = [f"{n} = {v:.5g}" for n, v in result.fixed.items()]
    given += [f"{n} = {k:.5g} {other}" for n, (other, k) in result.tied.items()]
    if given:
        lines += wrap("not estimated: " + ", ".join(given), _WIDTH, subsequent_indent="    ")
    lines += ["=" * _WIDTH, result.status]
    for name, fit in result.fits.items():
        if fit.diagnostics:
            words = f"{name}: {fit.diagnostics.words}"
            lines += wrap(words, _WIDTH, subsequent_indent="    ")
    unseen = [name for name, fit in result.fits.items() if not fit.n_held_out]
    if unseen:
        lines.append(
            f"not validated: {', '.join(unseen)}: no maneuver is held out, so R2 tells the fit only"
        )
    lines.append(
        f"se: {result.uncertainty}; se white: as if residuals were white;\nthe interval takes "
        "Student's t with the degrees of freedom of coloured residuals."
    )
    sums = {p.name: flown for p in result.parameters if (flown := flown_sum(p.name))}
    if sums:
        words = ", ".join(f"{name} is {flown}" for name, flown in sums.items())
        lines += wrap(f"flight tells of the rates' derivatives: {words}.", _WIDTH)
    if any(p.bias is not None for p in result.parameters):
        lines.append("biased estimates: the interval includes the estimated bias, se does not.")
    return "\n".join(lines)


def _name_width(result: Identification) -> int:
    return max([18, *(len(p.name) + 1 for p in result.parameters)])


def _unit_width(result: Identification) -> int:
    return max([9, *(len(p.unit) + 2 for p in result.parameters)])


def _header(result: Identification) -> str:
    truth = any(p.truth is not None for p in result.parameters)
    biased = any(p.bias is not None for p in result.parameters)
    return (
        f"{'parameter':<{_name_width(result)}}{'value':>12}{'se':>11}{'se white':>11}"
        f"{'[0.025':>12}{'0.975]':>12}"
        f"{'unit':>{_unit_width(result)}}{'VIF':>8}"
        + (f"{'truth':>11}" if truth else "")
        + (f"{'bias':>10}" if biased else "")
        + "  verdict"
    )


def _row(p: Parameter, wide: int, units: int) -> str:
    truth = "" if p.truth is None else f"{p.truth:>11.5g}"
    if p.bias is not None:
        truth += f"{p.bias:>10.2g}"
    unit = "" if p.unit == "1" else p.unit
    if p.verdict == "not_identifiable":
        gap = f"{'-':>12}{'-':>11}{'-':>11}{'-':>12}{'-':>12}"
        tied = " ".join(
            f"{'+' if tie.weight >= 0 else '-'} {abs(tie.weight):.3g} {tie.name}"
            for tie in p.tied_to
        )
        words = "not identifiable" + (f": only {p.name} {tied}" if tied else ": not excited")
        return f"{p.name:<{wide}}{gap}{unit:>{units}}{p.vif:>8.3g}{truth}  {words}"
    return (
        f"{p.name:<{wide}}{p.value:>12.5g}{p.se:>11.3g}{p.se_white:>11.3g}{p.ci95[0]:>12.4g}"
        f"{p.ci95[1]:>12.4g}{unit:>{units}}{p.vif:>8.3g}{truth}  {p.verdict}"
    )
