"""The magnetic field of a project: stated, or by the model at the place of the log."""

from __future__ import annotations

from datetime import date

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.base.project import NavigateSpec
from alula.campaign.field import field_of
from alula.flight import Channel, Flight

T = np.arange(3.0)


def flight(**values: float) -> Flight:
    """Channels that begin with a hole."""
    return Flight(
        "log", {n: Channel(n, T, np.array([np.nan, v, v]), "rad", "") for n, v in values.items()}
    )


def spec(**entries: object) -> NavigateSpec:
    return NavigateSpec.model_validate(entries)


def test_stated_field_is_in_tesla() -> None:
    assert field_of(spec(field=[20.0, 1.0, 43.0]), flight())[0] == pytest.approx(
        (20e-6, 1e-6, 43e-6)
    )
    assert field_of(spec(), flight()) == (None, [])


def test_model_at_the_first_position() -> None:
    pytest.importorskip("wmm", reason="wmm-calculator, an extra, is not installed")
    asked = spec(field="world_magnetic_model", day=date(2025, 1, 1))
    found, said = field_of(asked, flight(lat=np.radians(80.0), lon=0.0))
    assert found is not None
    # NOAA's test value of WMM2025 there; height above mean sea level, not the ellipsoid: some nT
    np.testing.assert_allclose(1e9 * np.array(found), [6521.6, 145.9, 54791.5], atol=20.0)
    assert [m.code for m in said] == ["field_by_model"]
    assert "80.000, 0.000 deg on 2025-01-01" in said[0].found


def test_without_day_or_place_it_is_refused() -> None:
    place = flight(lat=0.8, lon=0.3)
    for entries, log in (({}, place), ({"day": date(2025, 1, 1)}, flight(lat=0.8))):
        with pytest.raises(BadInput, match="missing_place_or_day"):
            field_of(spec(field="world_magnetic_model", **entries), log)


@pytest.mark.parametrize("field", [[1.0, 2.0], "igrf", 3.0])
def test_fields_that_are_none(field: object) -> None:
    with pytest.raises(ValueError, match="field"):
        spec(field=field)
