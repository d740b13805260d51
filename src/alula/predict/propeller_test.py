"""Tests that identify a propeller: a table over J, or thrust and electric power at rest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import refuse


@dataclass(frozen=True)
class PropellerTest:
    """Measured J, CT, CP, (k,) each. run: names of the runs, whose errors belong together.

    se_CT, se_CP: standard errors of a value, None where they are to be taken from the scatter.
    common_CP: relative standard error that all CP share, as that of a motor's efficiency.
    """

    J: Array
    CT: Array
    CP: Array
    run: tuple[str, ...]
    se_CT: float | None = None
    se_CP: float | None = None
    common_CP: float = 0.0

    def below(self, J_most: float) -> PropellerTest:
        """The values at J below `J_most`."""
        keep = np.less(self.J, J_most)
        run = tuple(name for name, k in zip(self.run, keep, strict=True) if k)
        return PropellerTest(
            frozen(self.J[keep]), frozen(self.CT[keep]), frozen(self.CP[keep]), run, self.se_CT,
            self.se_CP, self.common_CP,
        )  # fmt: skip


def propeller_test(
    J: Sequence[float] | Array,
    CT: Sequence[float] | Array,
    CP: Sequence[float] | Array,
    run: Sequence[str] | None = None,
    *,
    se_CT: float | None = None,
    se_CP: float | None = None,
    common_CP: float = 0.0,
    where: str = "test",
) -> PropellerTest:
    """A table of a wind-tunnel test. Raises BadInput for columns unlike, not finite, J below 0."""
    columns = [np.asarray(x, dtype=np.float64) for x in (J, CT, CP)]
    names = tuple("test" for _ in columns[0]) if run is None else tuple(run)
    found = ""
    if any(c.shape != (len(names),) for c in columns) or not len(names):
        found = "columns of " + ", ".join(str(len(np.atleast_1d(c))) for c in columns) + " values"
    elif not all(np.all(np.isfinite(c)) for c in columns):
        found = "values that are not finite"
    elif np.any(columns[0] < 0.0):
        found = f"J = {columns[0].min():.4g}, reverse flow"
    if found:
        raise refuse(
            "bad_propeller_test",
            where=where,
            expected="columns J (at least 0), CT, CP of one length, finite",
            found=found,
            do="Mend the table.",
        )
    return PropellerTest(
        frozen(columns[0]), frozen(columns[1]), frozen(columns[2]), names, se_CT, se_CP, common_CP
    )


def static_test(
    thrust: Sequence[float] | Array,
    omega: Sequence[float] | Array,
    voltage: Sequence[float] | Array,
    current: Sequence[float] | Array,
    motor_efficiency: float,
    diameter: float,
    density: float = 1.225,
    motor_efficiency_se: float = 0.0,
    where: str = "static test",
) -> PropellerTest:
    """A static thrust test: torque = U I eta_motor/omega (Pusztai 2018, B.2).

    thrust: N, omega: rad/s, voltage at the motor: V, current: A, (k,) each. The coefficients'
    standard errors come from their scatter over the throttle settings.
    """
    given = [np.atleast_1d(np.asarray(x, float)) for x in (thrust, omega, voltage, current)]
    T, w, U, A = given
    sizes = {len(x) for x in given}
    if len(sizes) > 1 or not all(np.all(np.isfinite(x)) for x in given) or np.any(w <= 0.0):
        raise refuse(
            "bad_static_test",
            where=where,
            expected="thrust, speed above zero, voltage and current of one length, finite",
            found=f"columns of {', '.join(map(str, sorted(sizes)))} values"
            if len(sizes) > 1
            else "values that are none",
            do="Mend the table.",
        )
    if not 0.0 < motor_efficiency <= 1.0:
        raise refuse(
            "bad_motor_efficiency",
            where=where,
            expected="an efficiency above 0 and up to 1",
            found=f"{motor_efficiency:g}",
            do="Give the motor's efficiency, e.g. 0.85.",
        )
    n = w / (2.0 * np.pi)
    CT = T / (density * n**2 * diameter**4)
    CP = U * A * motor_efficiency / (density * n**3 * diameter**5)
    return propeller_test(
        np.zeros(len(T)), CT, CP, common_CP=motor_efficiency_se / motor_efficiency, where=where
    )
