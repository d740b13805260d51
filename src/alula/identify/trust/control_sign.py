"""A control recorded with the wrong sign: its own moment then comes out positive.

In Alula's notation a positive deflection gives a negative moment. Data with a sign turned round
determine the derivatives of that control as well as right ones do, all with the wrong sign; only
the notation tells.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from alula.base.messages import Message, warn
from alula.identify.result import Parameter

OWN_MOMENT = {"de": "Cm_de", "da": "Cl_da", "dr": "Cn_dr"}


def signs_checked(
    parameters: Sequence[Parameter],
) -> tuple[tuple[Parameter, ...], tuple[Message, ...]]:
    """The parameters, those of a control whose own moment is significantly positive 'weak' at best;
    and a warning for each such control.
    """
    by_name = {p.name: p for p in parameters}
    turned = [
        control
        for control, name in OWN_MOMENT.items()
        if (own := by_name.get(name)) is not None and own.verdict == "ok" and own.ci95[0] > 0.0
    ]
    checked = tuple(
        replace(p, verdict="weak")
        if p.verdict == "ok" and set(turned) & set(p.name.split("[")[0].split("_")[1:])
        else p
        for p in parameters
    )
    said = tuple(
        warn(
            "control_sign",
            where=f"{OWN_MOMENT[c][:2]}, {c}",
            expected=f"{OWN_MOMENT[c]} < 0: a positive deflection gives a negative moment",
            found=f"{by_name[OWN_MOMENT[c]].value:.4g}",
            do=f"Check the sign of the channel {c} in the aircraft file; until then no derivative "
            "of that control counts as resolved.",
        )
        for c in turned
    )
    return checked, said


def contradicted(turned: Sequence[Message]) -> str:
    """What a status says of such warnings; '' where there is none."""
    return "".join(f"; sign contradicted: {m.where}" for m in turned)
