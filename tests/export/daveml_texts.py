"""Small DAVE-ML files for the tests."""

from __future__ import annotations

HEAD = """<?xml version="1.0"?>
<!DOCTYPE DAVEfunc PUBLIC "-//AIAA//DTD for Flight Dynamic Models - Functions 2.0//EN"
  "http://www.daveml.org/DTDs/2p0/DAVEfunc.dtd">
<DAVEfunc xmlns="http://daveml.org/2010/DAVEML">
  <fileHeader name="small"><author name="a" org="b"/><creationDate date="2026-01-02"/></fileHeader>
"""
REFERENCE = """
  <variableDef name="referenceWingArea" varID="S" units="ft2" initialValue="100"/>
  <variableDef name="referenceWingSpan" varID="b" units="ft" initialValue="30"/>
  <variableDef name="referenceWingChord" varID="c" units="ft" initialValue="4"/>
"""


def math(content: str) -> str:
    """A calculation of this MathML."""
    return f'<calculation><math xmlns="http://www.w3.org/1998/Math/MathML">{content}</math></calculation>'


def given(name: str, id: str, units: str, more: str = "") -> str:
    """An input."""
    return (
        f'<variableDef name="{name}" varID="{id}" units="{units}" {more}><isInput/></variableDef>'
    )


def output(name: str, content: str, more: str = 'sign="ANU"') -> str:
    """A calculated output with varID 'out'."""
    inside = f"{math(content)}<isOutput/>"
    return f'<variableDef name="{name}" varID="out" units="nd" {more}>{inside}</variableDef>'


def table(axis: str, attributes: str = "", values: str = "1, 3, 2", output: str = "t") -> str:
    """A function of one input over 0, 10, 20 that gives `output`."""
    return f"""
  <breakpointDef bpID="B"><bpVals>0 10 20</bpVals></breakpointDef>
  <function name="f">
    <independentVarRef varID="{axis}" {attributes}/>
    <dependentVarRef varID="{output}"/>
    <functionDefn><griddedTableDef gtID="G"><breakpointRefs><bpRef bpID="B"/></breakpointRefs>
      <dataTable><!-- comment -->{values}</dataTable></griddedTableDef></functionDefn>
  </function>
"""


def file(*parts: str) -> str:
    """A whole file."""
    return HEAD + "".join(parts) + "</DAVEfunc>"
