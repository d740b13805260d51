"""XML from strangers: read without entities, without other files, within limits."""

from __future__ import annotations

from pathlib import Path
from typing import NoReturn
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from alula.base.messages import refuse

MAX_BYTES = 50_000_000
MAX_ELEMENTS = 1_000_000
MAX_DEPTH = 100


def read_xml(path: Path) -> Element:
    """The root element of an XML file; names without their namespace, comments left out.

    The line of the document type is allowed and nothing behind it is loaded. Raises BadInput for
    what is no XML, for entities of any kind beside the five of XML, and beyond the limits of 50 MB,
    a million elements and a depth of 100.
    """
    try:
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
    except OSError as error:
        raise refuse(
            "file_not_readable",
            where=str(path),
            expected="an XML file",
            found=error.strerror or str(error),
            do="Check the path.",
        ) from None
    return parse_xml(data, str(path))


def parse_xml(data: bytes, where: str) -> Element:
    """The root element of XML in memory; see `read_xml`. where: named in messages."""
    builder = TreeBuilder()
    parser = expat.ParserCreate(namespace_separator="}")
    depth = count = 0

    def stop(expected: str, found: str) -> NoReturn:
        raise refuse(
            "unsafe_xml",
            where=f"{where}, line {parser.CurrentLineNumber}",
            expected=expected,
            found=found,
            do="Write the text itself into the file; Alula loads nothing that a file points to.",
        )

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal depth, count
        depth += 1
        count += 1
        if depth > MAX_DEPTH or count > MAX_ELEMENTS:
            stop(f"at most {MAX_ELEMENTS} elements, {MAX_DEPTH} deep", "more")
        builder.start(_local(name), {_local(k): v for k, v in attributes.items()})

    def end(name: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(_local(name))

    def other(text: str) -> None:
        if text.startswith("&"):  # an entity of the document type that was not loaded
            stop("no entities", text)

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.CharacterDataHandler = builder.data
    parser.DefaultHandler = other
    parser.EntityDeclHandler = lambda name, *_: stop("no declared entities", f"entity '{name}'")
    parser.ExternalEntityRefHandler = lambda *_: stop("no external entities", "a reference to one")
    parser.SetParamEntityParsing(expat.XML_PARAM_ENTITY_PARSING_NEVER)
    if len(data) > MAX_BYTES:
        stop(f"at most {MAX_BYTES} bytes", "more")
    try:
        parser.Parse(data, True)
    except (expat.ExpatError, ValueError, LookupError) as error:  # LookupError: unknown encoding
        raise refuse(
            "not_xml",
            where=where,
            expected="well-formed XML",
            found=str(error),
            do="Mend the line named; an XML editor shows more.",
        ) from None
    return builder.close()


def _local(name: str) -> str:
    return name.rpartition("}")[2]
