"""What the readers of DAVE-ML share: numbers, text and refusals."""

from __future__ import annotations

import math
import re
from xml.etree.ElementTree import Element

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import BadInput, refuse


def plain_units(units: str) -> str:
    """'ft_s' as 'ft/s'."""
    return re.sub(r"(?<=\w)_(?=\w)", "/", units)


def numbers(text: str, where: str) -> Array:
    """The finite numbers of a list separated by commas or white space."""
    try:
        values = np.array([float(x) for x in text.replace(",", " ").split()])
    except ValueError as error:
        raise wrong(where, "numbers", str(error)) from None
    if not np.isfinite(values).all():
        raise wrong(where, "finite numbers", "one that is not")
    return values


def optional_number(element: Element, key: str, where: str) -> float | None:
    """The number of an attribute, or None."""
    text = element.get(key)
    return None if text is None else number(text, f"{where}, {key}")


def number(text: str, where: str) -> float:
    """A finite number."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise wrong(where, "a finite number", repr(text))
    return value


def text_of(element: Element | None) -> str:
    """The words of an element, or nothing."""
    return "" if element is None else " ".join((element.text or "").split())


def wrong(where: str, expected: str, found: str) -> BadInput:
    """What is refused at `where`."""
    return refuse(
        "daveml",
        where=where,
        expected=expected,
        found=found,
        do="Correct the file; AIAA S-119 and the DAVE-ML reference say what goes where.",
    )
