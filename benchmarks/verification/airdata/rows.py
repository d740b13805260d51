"""Air data, attitude and wind from what is on board: each row's check in its own file."""

from __future__ import annotations

from verification.airdata import (
    angle_sources,
    armhawk_accelerometer,
    armhawk_flight,
    armhawk_magnetometer,
    armhawk_probe,
    asse_noise_free,
    asse_noisy,
    asse_speed,
    inflight_calibration,
    navigation_flight,
    navigation_speed,
    probe_speed,
)
from verification.airdata import monitor as airdata_monitor
from verification.registry import rows


def speed(quick: bool) -> tuple[str, bool]:
    """Steps of the filters, inverse of the probe and angles without vanes."""
    parts = (
        navigation_speed.navigation_speed(quick),
        probe_speed.check(quick),
        asse_speed.asse_speed(quick),
    )
    return "; ".join(words for words, _ in parts), all(good for _, good in parts)


ROWS = {
    "ARM-Hawk magnetometer": (
        "hard-iron offset within 0.2 µT of the author's on each axis; field-magnitude rms on "
        "the recording no larger than with the author's published matrix and offset",
        armhawk_magnetometer.armhawk_magnetometer,
    ),
    "ARM-Hawk accelerometer, 18 positions": (
        "magnitude error before: 2.08 % largest; after: at most 0.30 % largest and 0.16 % rms "
        "(the author's matrix on the same data: 0.50 and 0.29)",
        armhawk_accelerometer.armhawk_accelerometer,
    ),
    "ARM-Hawk probe CFD": (
        "three-term c_p fit (Eq. 3.5) rms at most 0.007; the alpha error that the printed 2.4 "
        "cos2 - 1.4 causes is computed and shown; inverse after forward: alpha, beta to 1e-6 "
        "rad within 35 deg, at most 8 iterations",
        armhawk_probe.check,
    ),
    "ARM-Hawk flight": (
        "V, alpha, beta from `v_rel_V` match `state` (rms over t 35 to 432 s: 0.04 m/s, 0.1 "
        "deg); wind from position and air data with error bars, consistent between halves of "
        "the flight",
        armhawk_flight.check,
    ),
    "Lerro's stall and sideslip sweep, noise-free in the simulator (0.1 ms steps, two-seat "
    "light airplane)": (
        "zero-order scheme, while its existence number exceeds the threshold: error under 0.6 "
        "deg; error measure where its denominator exceeds 5 % of its largest: two equations at "
        "most half of four, figures printed beside his 2 % and 6 %; exact form under 0.05 deg; "
        "the threshold admits at least half of the samples between first and last control input",
        asse_noise_free.asse_noise_free,
    ),
    "the same with an IMU of Xsens MTi-G class and 0.3 m/s airspeed noise, 100 seeds": (
        "beyond-ASSE: alpha rms under 1.5 deg in the stall, beta under 2.5 deg in the sweep; "
        "the excited angle is reported on at least 60 % of the maneuver's samples and the rms "
        "is taken over exactly those; the angle a maneuver does not excite lies inside its "
        "interval or reads `not observable`; NEES inside its bounds; the printed scheme beside "
        "it",
        asse_noisy.asse_noisy,
    ),
    "simulated 10 min flight, 10 m/s wind and turbulence": (
        "joint filter attitude rms under 0.5 deg, wind under 0.5 m/s, NEES inside bounds; the "
        "pair's own figures beside it",
        navigation_flight.navigation_flight,
    ),
    "monitor, 200 runs": (
        "stuck, biased (3 deg), noisy, dead source named within 2 s in 95 %; under one false "
        "alarm in 10 h",
        airdata_monitor.check,
    ),
    "ASSE beside joint filter and identified lift model, simulated flights of the two-seater": (
        "no source errs more than it states (NEES, 99.9 %); in calm air alpha of ASSE under 1.5 "
        "deg rms on at least 60 %, of the joint filter under 1.0, of the lift model under 0.2; "
        "all beside one another with the vote",
        angle_sources.check,
    ),
    "in-flight calibration": (
        "true scale and upwash inside their intervals; a straight flight is refused",
        inflight_calibration.check,
    ),
    "speed in the core": (
        "attitude and position step under 0.5 µs each, joint filter under 5 µs, probe inverse "
        "under 0.5 µs, ASSE (20 samples) under 5 µs; zero allocations",
        speed,
    ),
}
rows("airdata", ROWS)
