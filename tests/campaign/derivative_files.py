"""Small files as AVL and Digital Datcom write them, with numbers of their own."""

from __future__ import annotations

from collections.abc import Mapping
from math import cos, degrees, radians, sin
from pathlib import Path

from alula.predict.lattice_result import LatticeResult

HEAD = """ ---------------------------------------------------------------
 Vortex Lattice Output -- Total Forces

 Configuration: Light airplane

     # Surfaces =   5
     # Strips   =  38
     # Vortices = {count}

  Sref = {S:10.5g}       Cref = {c:10.5g}       Bref = {b:10.5g}
  Xref = {x:10.5g}       Yref =  0.0000       Zref = {z:10.5g}

 Standard axis orientation,  X fwd, Z down

 Run case:  -unnamed-

  Alpha = {alpha:9.5f}     pb/2V =  -0.00000     p'b/2V =  -0.00000
  Beta  =   0.00000     qc/2V =   0.00000
  Mach  =     0.000     rb/2V =  -0.00000     r'b/2V =  -0.00000

  CXtot = {CX:12.8f}     Cltot =  -0.00000     Cl'tot =  -0.00000
  CYtot =  -0.00000     Cmtot = {Cm:12.8f}
  CZtot = {CZ:12.8f}     Cntot =   0.00000     Cn'tot =   0.00000

  CLtot = {CL:12.8f}
  CDtot = {CD:12.8f}
  CDvis =   0.00000     CDind = {CD:12.8f}
  CLff  = {CL:12.8f}     CDff  = {CD:12.8f}    | Trefftz
  CYff  =   0.00000         e =    0.9800    | Plane

   aileron         =   0.00000
   elevator        =   0.00000
   rudder          =   0.00000

 ---------------------------------------------------------------
"""
# Controls in AVL's order; the rudder is there in the other sense, as with many models.
CONTROLS = {"aileron": ("da", 1.0), "elevator": ("de", 1.0), "rudder": ("dr", -1.0)}


def avl_file(result: LatticeResult, kind: str) -> str:
    """What ST or SB would hold had AVL found these numbers. 8 decimals, where AVL has 6."""
    body = dict(zip(("CX", "CY", "CZ", "Cl", "Cm", "Cn"), result.body_coefficients, strict=True))
    wind = result.coefficients("stability")
    r = result.reference
    x, _, z = result.point
    text = HEAD.format(
        count=result.panels.count, S=r.S, b=r.b, c=r.c, x=-x, z=-z, alpha=degrees(result.alpha),
        CX=body["CX"], CZ=body["CZ"], Cm=body["Cm"], CL=wind["CL"], CD=wind["CD"],
    )  # fmt: skip
    return text + (_stability(result) if kind == "ST" else _geometry(result, body))


def _rows(names: Mapping[str, str], columns: Mapping[str, str], values: Mapping[str, float]) -> str:
    lines = []
    for coefficient, words in names.items():
        cells = (
            f"    {coefficient}{mark} = {values.get(f'{coefficient}_{label}', 0.0):12.8f}"
            for label, mark in columns.items()
        )
        lines.append(f" {words}|" + "".join(cells))
    return "\n".join(lines) + "\n\n"


def _controls(names: Mapping[str, str], values: Mapping[str, float]) -> str:
    head = "".join(f"    {name:<12} d{k:02d} " for k, name in enumerate(CONTROLS, 1))
    per_deg = {
        f"{c}_{k}": sign * radians(values.get(f"{c}_{ours}", 0.0))
        for c in names
        for k, (ours, sign) in enumerate(CONTROLS.values(), 1)
    }
    marks = {str(k): f"d{k:02d}" for k in range(1, len(CONTROLS) + 1)}
    rule = "                  ----------------    ----------------    ----------------\n"
    return f"{'':14}{head}\n{rule}" + _rows(names, marks, per_deg)


_WIND = {"CL": "z' force CL ", "CY": "y  force CY ", "Cl": "x' mom.  Cl'", "Cm": "y  mom.  Cm ",
         "Cn": "z' mom.  Cn'"}  # fmt: skip
_BODY = {"CX": "x force CX  ", "CY": "y force CY  ", "CZ": "z force CZ  ", "Cl": "x mom.  Cl  ",
         "Cm": "y mom.  Cm  ", "Cn": "z mom.  Cn  "}  # fmt: skip


def _stability(result: LatticeResult) -> str:
    values = result.derivatives("stability")
    return (
        "\n Stability-axis derivatives...\n\n"
        + f"{'alpha':>34}{'beta':>20}\n"
        + _rows(_WIND, {"alpha": "a", "beta": "b"}, values)
        + _rows(_WIND, {"p": "p", "q": "q", "r": "r"}, values)
        + _controls(_WIND, values)
        + " Neutral point  Xnp =   0.187800\n\n"
        + " Clb Cnr / Clr Cnb  =   0.400000    (  > 1 if spirally stable )\n"
    )


def _geometry(result: LatticeResult, body: Mapping[str, float]) -> str:
    """C_u and C_w of C_alpha: forces go with the square of speed, u C_u + w C_w = 2 C."""
    values = result.derivatives("body")
    c, s = cos(result.alpha), sin(result.alpha)
    for k, total in body.items():
        slope = values.get(f"{k}_alpha", 0.0)
        values[f"{k}_u"] = 2.0 * total * c - slope * s
        values[f"{k}_w"] = 2.0 * total * s + slope * c
        values[f"{k}_v"] = values.get(f"{k}_beta", 0.0)
    return (
        "\n Geometry-axis derivatives...\n\n"
        + _rows(_BODY, {"u": "u", "v": "v", "w": "w"}, values)
        + _rows(_BODY, {"p": "p", "q": "q", "r": "r"}, values)
        + _controls(_BODY, values)
    )


DATCOM = (Path(__file__).parent / "datcom.out").read_text()
