"""XML from strangers: nothing is expanded, nothing is loaded, nothing grows without end."""

from __future__ import annotations

from pathlib import Path

import pytest

from alula.base.messages import BadInput
from alula.export.safe_xml import MAX_DEPTH, parse_xml, read_xml

LAUGHS = "".join(f'<!ENTITY l{i} "{f"&l{i - 1};" * 10 if i else "ha"}">' for i in range(9))


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (f"<!DOCTYPE a [{LAUGHS}]><a>&l8;</a>", "unsafe_xml"),
        ('<!DOCTYPE a [<!ENTITY x SYSTEM "file:///etc/passwd">]><a>&x;</a>', "unsafe_xml"),
        ('<!DOCTYPE a [<!ENTITY % p SYSTEM "http://127.0.0.1/x">%p;]><a/>', "unsafe_xml"),
        ('<!DOCTYPE a [<!ENTITY unused "x">]><a/>', "unsafe_xml"),
        ('<!DOCTYPE a SYSTEM "none.dtd"><a>&alpha;</a>', "unsafe_xml"),
        ("<a>" * (MAX_DEPTH + 1) + "</a>" * (MAX_DEPTH + 1), "unsafe_xml"),
        ("<a><b></a>", "not_xml"),
        ("<a>&alpha;</a>", "not_xml"),
        ("", "not_xml"),
        ("hello", "not_xml"),
        ('<?xml version="1.0" encoding="klingon"?><a/>', "not_xml"),
    ],
)
def test_what_is_refused(text: str, code: str) -> None:
    with pytest.raises(BadInput, match=code):
        parse_xml(text.encode(), "file.xml")


def test_document_type_comments_and_characters_are_read() -> None:
    root = parse_xml(
        b'<!DOCTYPE a PUBLIC "p" "http://127.0.0.1:9/none.dtd">'
        b'<n:a xmlns:n="u" n:k="&#x3B1;&lt;">1<!-- & -->2&amp;<n:b/></n:a>',
        "file.xml",
    )
    assert (root.tag, root.text, root.attrib) == ("a", "12&", {"k": "α<"})
    assert [e.tag for e in root] == ["b"]


def test_missing_file(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="file_not_readable"):
        read_xml(tmp_path / "none.xml")
