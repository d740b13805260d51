"""MathML content markup: values by hand."""

from __future__ import annotations

import math
from xml.etree.ElementTree import Element

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.export.daveml_expression import from_mathml, to_mathml
from alula.export.safe_xml import parse_xml

X = {"x": np.array([-2.0, 0.0, 3.0]), "y": np.asarray(4.0)}


def read(content: str):
    return from_mathml(parse_xml(f"<math>{content}</math>".encode(), "m"), "m")


def apply(op: str, *args: str) -> str:
    return f"<apply><{op}/>{''.join(args)}</apply>"


CI, CY = "<ci> x </ci>", "<ci>y</ci>"
SIGN = (
    f"<piecewise><piece>{apply('minus', CY)}{apply('lt', CI, '<cn>0</cn>')}</piece>"
    f"<piece><cn>7</cn>{apply('eq', CI, '<cn>0</cn>')}</piece>"
    f"<otherwise>{CY}</otherwise></piecewise>"
)


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (apply("plus", CI, CY, "<cn>1e1</cn>"), [12, 14, 17]),
        (apply("times", CI, CY, CI), [16, 0, 36]),
        (apply("minus", CI), [2, 0, -3]),
        (apply("minus", CI, CY), [-6, -4, -1]),
        (apply("divide", CI, CY), [-0.5, 0, 0.75]),
        (apply("power", CI, "<cn>3</cn>"), [-8, 0, 27]),
        (apply("abs", CI), [2, 0, 3]),
        (apply("root", apply("abs", CI)), [math.sqrt(2), 0, math.sqrt(3)]),
        (apply("root", "<degree><cn>4</cn></degree>", CY), math.sqrt(2)),
        (apply("log", CY), math.log10(4)),
        (apply("log", "<logbase><cn>2</cn></logbase>", CY), 2),
        (apply("ln", CY), math.log(4)),
        (apply("sin", CI), [math.sin(-2), 0, math.sin(3)]),
        (apply("arctan", CI), [math.atan(-2), 0, math.atan(3)]),
        (apply("max", CI, "<cn>1</cn>", "<cn>-5</cn>"), [1, 1, 3]),
        (apply("min", CI, "<cn>1</cn>"), [-2, 0, 1]),
        (apply("and", apply("gt", CI, "<cn>-1</cn>"), apply("leq", CI, "<cn>0</cn>")), [0, 1, 0]),
        (apply("not", apply("neq", CI, "<cn>0</cn>")), [0, 1, 0]),
        (apply("floor", apply("divide", CI, CY)), [-1, 0, 0]),
        ('<apply><csymbol definitionURL="http://daveml.org/f.html#atan2">atan2</csymbol>'
         f"{CI}{CY}</apply>", [math.atan2(-2, 4), 0, math.atan2(3, 4)]),
        (SIGN, [-4, 7, 4]),
        (f"<apply>{SIGN}</apply>", [-4, 7, 4]),
        ('<cn type="e-notation">1.5<sep/>3</cn>', 1500),
        ('<cn type="rational">1<sep/>8</cn>', 0.125),
        ("<pi/>", math.pi),
    ],
)  # fmt: skip
def test_values(content: str, expected) -> None:
    e = read(content)
    # the functions are the library's own; powers and roots may round
    np.testing.assert_allclose(e.evaluate(X), expected, rtol=1e-15)
    again = Element("math")
    to_mathml(e, again)
    if "root" not in content and "log" not in content and "csymbol" not in content:
        assert from_mathml(again, "m") == e


@pytest.mark.parametrize(
    ("content", "word"),
    [
        ("", "0 elements"),
        (apply("plus"), "'plus' of 0"),
        (apply("divide", CI), "'divide' of 1"),
        (apply("int", CI), "'int'"),
        ("<cn>one</cn>", "'one'"),
        ("<apply/>", "<apply>"),
        ("<lambda/>", "<lambda>"),
        ("<piecewise/>", "empty"),
        (f"<piecewise><piece>{CI}</piece></piecewise>", "of 1 parts"),
        (f"<piecewise><otherwise>{CI}</otherwise><piece>{CI}{CI}</piece></piecewise>", "otherwise"),
    ],
)
def test_what_is_refused(content: str, word: str) -> None:
    with pytest.raises(BadInput, match="daveml_math") as caught:
        read(content)
    assert word in str(caught.value)


def test_names() -> None:
    assert read(SIGN).names() == {"x", "y"}
