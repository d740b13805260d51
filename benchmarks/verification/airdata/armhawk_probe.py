"""ARM-Hawk's five-hole probe: fit of c_p to the CFD points, and the inverse of the forward model.

Real data of Pusztai 2018, 3.3: c_p of one port of the hemispherical tip over the tunnel's angle;
the port sits at 45 deg. The alpha error of the printed Eq. (3.6) is what it makes of the pressures
of the fitted probe.
"""

from __future__ import annotations

import numpy as np

from alula.airdata.cp_fit import CpFit, fit_cp, harmonic_cp, read_points
from alula.airdata.probe import FiveHoleProbe
from alula.airdata.probe_table import probe_table
from verification.places import DATA

PORT = np.radians(45.0)
RMS, ANGLE, MOST = 0.007, 1e-6, 8


def cfd() -> CpFit:
    """The fit to the author's points."""
    folder = DATA / "armhawk" / "probe_cfd"
    points = read_points(folder / "cp_over_theta.csv", (1, 2))
    return fit_cp(np.radians(points[:, 0]) + PORT, points[:, 1])


def probes(fit: CpFit) -> dict[str, FiveHoleProbe]:
    """The fitted probe, its phase as a turned port or left as a sine, and the printed one."""
    turned, sine = fit.as_port_angle(), fit.as_printed()
    return {
        "turned port": FiveHoleProbe(turned, PORT - fit.phase),
        "sine": FiveHoleProbe(sine, PORT, turned),
        "printed": FiveHoleProbe(harmonic_cp([-0.2, 0.0, 1.2]), PORT),  # 2.4 cos2 - 1.4
    }


def check(quick: bool = False) -> tuple[str, bool]:
    """Figures in words, and whether they hold."""
    fit = cfd()
    made = probes(fit)
    axis = np.radians(np.linspace(-35.0, 35.0, 29 if quick else 141))
    a, b = (x.ravel() for x in np.meshgrid(axis, axis))
    good, words = fit.rms <= RMS, [f"c_p fit rms {fit.rms:.4f}, phase {np.degrees(fit.phase):.2f}°"]
    for name, probe in made.items():
        found = probe.flow(probe.pressures(600.0, a, b))
        worst = float(np.max(np.hypot(found.alpha - a, found.beta - b)))
        most = int(np.max(found.iterations))
        good &= bool(found.valid.all()) and worst <= ANGLE and most <= MOST
        words.append(f"inverse ({name}) {worst:.0e} rad in {most}")
    _, alpha, beta, q = made["turned port"].read_by(made["printed"], 29)
    off = np.max(np.abs(fit.cp - (2.4 * np.cos(fit.theta) ** 2 - 1.4)))
    inside = np.abs(np.linspace(-35.0, 35.0, 29)) < 10.1
    near = alpha[np.ix_(inside, inside)]
    largest = [float(np.degrees(np.nanmax(np.abs(x)))) for x in (near, alpha, beta)]
    words.append(
        f"the printed c_p, off by up to {off:.2f}, cancels in part: it errs by {largest[0]:.2f}° "
        f"in alpha within 10°, {largest[1]:.1f}° within 35° (beta {largest[2]:.1f}°, "
        f"q {100 * np.nanmax(np.abs(q)):.0f} %)"
    )
    table = probe_table(made["sine"])
    worst = np.degrees(max(table.error_alpha, table.error_beta))
    words.append(f"lookup table {table.bytes / 1000:.0f} kB errs by {worst:.3f}°")
    return "; ".join(words), bool(good)
