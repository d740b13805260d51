"""The Earth's magnetic field: the World Magnetic Model, by the library of those who publish it.

An extra, `pip install alula[field]` (wmm-calculator, NOAA NCEI); without it a field is given.
"""

from __future__ import annotations

from datetime import date

from alula.base.messages import refuse

NANO = 1e-9


def world_magnetic_model(
    latitude: float, longitude: float, height: float, day: date
) -> tuple[float, float, float]:
    """Field (3,) NED, T, at geodetic latitude and longitude (rad) and height (m, mean sea level).

    Raises BadInput where the library is missing, or its coefficients do not hold on that day.
    """
    from math import degrees

    try:
        from wmm import wmm_calc
    except ModuleNotFoundError:
        raise refuse(
            "missing_library",
            where="World Magnetic Model",
            expected="the package wmm-calculator",
            found="none",
            do="pip install wmm-calculator, or give the field itself.",
        ) from None
    model = wmm_calc()
    try:
        model.setup_time(day.year, day.month, day.day)
        model.setup_env(degrees(latitude), degrees(longitude), 1e-3 * height, unit="km", msl=True)
        north, east, down = (
            float(b.item()) for b in (model.get_Bx(), model.get_By(), model.get_Bz())
        )
    except ValueError as error:
        raise refuse(
            "outside_field_model",
            where="World Magnetic Model",
            expected="a place on Earth, below 850 km, in the five years of its coefficients",
            found=str(error),
            do="Update wmm-calculator, or give the field itself.",
        ) from None
    return NANO * north, NANO * east, NANO * down
