"""Propellers from the files of others: QPROP's, UIUC's and APC's geometry, UIUC's tests."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np

from alula.aircraft.blades import BladePolar, Blades
from alula.aircraft.load_blades import load_blades
from alula.base.arrays import Array, frozen
from alula.base.messages import BadInput, refuse

INCH = 0.0254  # m
_QPROP = (
    ("CL0", "CL_a"),
    ("CLmin", "CLmax"),
    ("CD0", "CD2u", "CD2l", "CLCD0"),
    ("REref", "REexp"),
    ("Rfac", "Cfac", "Bfac"),
    ("Radd", "Cadd", "Badd"),
)


def read_qprop(path: Path) -> Blades:
    """A propeller in QPROP's format (Drela 2007): name, blades, polar, scale factors, stations.

    Lengths become m by the file's own factors, the tip's radius included.
    """
    lines = [
        (k, re.split(r"[!#]", line)[0].strip())
        for k, line in enumerate(_text(path).splitlines(), 1)
    ]
    lines = [(k, line) for k, line in lines if line]
    if len(lines) < 10:
        raise _not(path, "QPROP's ten and more lines", f"{len(lines)} lines with content")
    name = lines[0][1]
    first = _numbers(path, *lines[1])
    if not first or first[0] != int(first[0]):
        raise _not(path, "'Nblades  [R]'", lines[1][1], lines[1][0])
    given: dict[str, float] = {}
    for (k, line), keys in zip(lines[2:], _QPROP, strict=False):
        values = _numbers(path, k, line)
        if len(values) != len(keys):
            raise _not(path, f"{len(keys)} numbers: {' '.join(keys)}", line, k)
        given.update(zip(keys, values, strict=True))
    rows = [(k, _numbers(path, k, line)) for k, line in lines[2 + len(_QPROP) :]]
    for k, row in rows:
        if len(row) != 3:
            raise _not(path, "3 numbers: r chord beta", f"{len(row)}", k)
    r, chord, beta = np.array([row for _, row in rows]).T
    r = given["Rfac"] * r + given["Radd"]
    tip = given["Rfac"] * first[1] + given["Radd"] if len(first) > 1 else float(r[-1])
    polar = {
        "c_l_0": given["CL0"],
        "c_l_alpha": given["CL_a"],
        "c_l_min": given["CLmin"],
        "c_l_max": given["CLmax"],
        "c_d_0": given["CD0"],
        "c_d_2_upper": given["CD2u"],
        "c_d_2_lower": given["CD2l"],
        "c_l_cd0": given["CLCD0"],
        "reynolds": given["REref"],
        "reynolds_power": given["REexp"],
        "source": f"{path.name}",
    }
    return load_blades(
        {
            "name": name,
            "count": int(first[0]),
            "diameter": 2.0 * tip,
            "r": r.tolist(),
            "chord": (given["Cfac"] * chord + given["Cadd"]).tolist(),
            "beta_deg": (given["Bfac"] * beta + given["Badd"]).tolist(),
            "polar": polar,
            "source": f"QPROP file {path.name}",
        },
        str(path),
    )


def read_uiuc_geometry(path: Path, diameter: float | None = None, count: int = 2) -> Blades:
    """Blade geometry of the UIUC Propeller Database: rows of r/R, c/R, beta in deg.

    diameter: m; the file does not state it, its name may ('apcsf_10x7_geom.txt': 10 in).
    """
    table = _columns(path, ("r/R", "c/R", "beta"))
    if diameter is None:
        size = re.search(r"_(\d+(?:\.\d+)?)x\d", path.name)
        if size is None:
            raise refuse(
                "no_diameter",
                where=str(path),
                expected="the diameter, in the file's name ('..._10x7_geom.txt') or by --diameter",
                found=f"'{path.name}'",
                do="Give the diameter in m.",
            )
        diameter = INCH * float(size.group(1))
    radius = 0.5 * diameter
    return load_blades(
        {
            "name": path.stem.removesuffix("_geom"),
            "count": count,
            "diameter": diameter,
            "r": (radius * table[:, 0]).tolist(),
            "chord": (radius * table[:, 1]).tolist(),
            "beta_deg": table[:, 2].tolist(),
            "source": f"UIUC geometry {path.name}",
        },
        str(path),
    )


def read_apc(path: Path) -> Blades:
    """Blade geometry of APC's performance files (.PE0): inches and deg."""
    text = _text(path)
    head = re.search(r"STATION\s+CHORD.*?TWIST", text)
    rows: list[list[float]] = []
    for line in text[head.end() :].splitlines() if head else ():
        try:
            values = [float(word) for word in line.split()]
        except ValueError:
            if rows:
                break
            continue
        if len(values) >= 8:
            rows.append(values)
        elif rows:
            break
    if len(rows) < 2:
        raise _not(path, "APC's table of STATION, CHORD ... TWIST", "no rows of it")
    table = np.array(rows)
    count = re.search(r"BLADES:?\s*=?\s*(\d+)", text)
    radius = re.search(r"RADIUS:?\s*=?\s*([\d.]+)", text)
    tip = float(radius.group(1)) if radius else float(table[-1, 0])
    return load_blades(
        {
            "name": text.splitlines()[0].split()[0] if text.strip() else path.stem,
            "count": int(count.group(1)) if count else 2,
            "diameter": 2.0 * INCH * tip,
            "r": (INCH * table[:, 0]).tolist(),
            "chord": (INCH * table[:, 1]).tolist(),
            "beta_deg": table[:, 7].tolist(),
            "source": f"APC file {path.name}",
        },
        str(path),
    )


def read_uiuc_test(path: Path) -> tuple[Array, Array, Array]:
    """J, CT, CP of a wind-tunnel run of the UIUC Propeller Database; J = 0 for static runs."""
    text = _text(path)
    if text.split(maxsplit=1)[:1] == ["RPM"]:
        table = _columns(path, ("RPM", "CT", "CP"))
        return frozen(np.zeros(len(table))), frozen(table[:, 1]), frozen(table[:, 2])
    table = _columns(path, ("J", "CT", "CP"))
    return frozen(table[:, 0]), frozen(table[:, 1]), frozen(table[:, 2])


def read_blades(path: Path, diameter: float | None = None, count: int = 2) -> Blades:
    """Blades of a file that is no TOML: QPROP's (.def, .prop), APC's (.PE0) or UIUC's geometry."""
    suffix = path.suffix.lower()
    if suffix == ".pe0":
        return read_apc(path)
    if suffix in (".txt", ".dat") or _text(path).lstrip()[:3] == "r/R":
        return read_uiuc_geometry(path, diameter, count)
    return read_qprop(path)


def assumed_polar() -> BladePolar:
    """A thin section of 4 to 5 % camber at low Reynolds number, where nothing else is known.

    Of no lift at -4.5 deg, with nine tenths of thin-airfoil theory's slope; limits and drag of
    such sections at a Reynolds number of 1e5, with a laminar layer's power of it. One degree in the
    angle of no lift is some 7 % of a small propeller's static thrust.
    """
    slope = 0.9 * 2.0 * np.pi
    return BladePolar(
        c_l_0=slope * float(np.radians(4.5)),
        c_l_alpha=slope,
        c_l_min=-0.4,
        c_l_max=1.3,
        c_d_0=0.02,
        c_d_2_upper=0.012,
        c_d_2_lower=0.02,
        c_l_cd0=0.5,
        reynolds=1e5,
        reynolds_power=-0.5,
        source="assumed: a thin section of 4 to 5 % camber at low Reynolds number",
    )


def _text(path: Path) -> str:
    try:
        return path.read_bytes().decode("utf-8-sig")
    except (OSError, ValueError) as error:
        found = getattr(error, "strerror", None) or str(error)
        raise refuse(
            "file_not_readable",
            where=str(path),
            expected="a propeller file: TOML, QPROP's .def, UIUC's geometry or APC's .PE0",
            found=found,
            do="Check the path.",
        ) from None


def _numbers(path: Path, line: int, text: str) -> list[float]:
    try:
        values = [float(word) for word in re.split(r"[\s,]+", text) if word]
    except ValueError:
        raise _not(path, "numbers", f"'{text[:60]}'", line) from None
    if not np.all(np.isfinite(values)):
        raise _not(path, "finite numbers", f"'{text[:60]}'", line)
    return values


def _columns(path: Path, head: tuple[str, ...]) -> Array:
    lines = [(k, line.strip()) for k, line in enumerate(_text(path).splitlines(), 1)]
    lines = [(k, line) for k, line in lines if line]
    if not lines or tuple(lines[0][1].split()[: len(head)]) != head:
        raise _not(path, f"columns {', '.join(head)}", f"'{lines[0][1][:60]}'" if lines else "none")
    rows: list[Any] = []
    for k, line in lines[1:]:
        values = _numbers(path, k, line)
        if len(values) < len(head):
            raise _not(path, f"{len(head)} numbers", f"{len(values)}", k)
        rows.append(values[: len(head)])
    if not rows:
        raise _not(path, f"rows of {', '.join(head)}", "none")
    return np.array(rows)


def _not(path: Path, expected: str, found: str, line: int | None = None) -> BadInput:
    return refuse(
        "bad_propeller_file",
        where=f"{path}" + ("" if line is None else f", line {line}"),
        expected=expected,
        found=found,
        do="Mend that line, or describe the propeller in a TOML file: docs/propeller_file.md.",
    )
