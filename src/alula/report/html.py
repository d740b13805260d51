"""Markup that cannot be broken by what a log contains.

Text becomes markup only through `tag` and `escape`; a plain string is always escaped, so a channel
named `<script>` is shown and never run.
"""

from __future__ import annotations

import html
import json
import re
from collections.abc import Iterable, Sequence
from typing import Any

# Controls, lone surrogates and marks that reorder text: they would be lost, break the encoding or
# make a name look like another one, so each is shown as the replacement character.
_UNSEEN = re.compile(
    "[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff]"
)
_SPECIAL = re.compile("[&<>\"'" + _UNSEEN.pattern[1:-1] + "]")  # what `escape` must change
MOST_ROWS = 400  # of a table; the page must stay small whatever the project
_VOID = {"br", "meta", "col", "hr", "rect", "line", "circle", "path"}


class Html(str):
    """Text that is markup already."""

    __slots__ = ()


def escape(value: object) -> Html:
    """`value` as markup: Html unchanged, anything else as text with its special signs escaped."""
    if isinstance(value, Html):
        return value
    text = str(value)
    if _SPECIAL.search(text) is None:  # nearly always, and far quicker on a page of many plots
        return Html(text)
    return Html(html.escape(_UNSEEN.sub("\ufffd", text), quote=True))


def join(parts: Iterable[object]) -> Html:
    """The parts one after the other, each escaped unless it is markup."""
    return Html("".join([escape(p) for p in parts if p is not None]))


def tag(name: str, /, *children: object, **attributes: object) -> Html:
    """One element. `class_` and `aria_label` become `class` and `aria-label`; None leaves out."""
    text = [f"<{name}"]
    for key, value in attributes.items():
        if value is None or value is False:
            continue
        attribute = key.rstrip("_").replace("_", "-")
        text.append(f" {attribute}" if value is True else f' {attribute}="{escape(value)}"')
    if name in _VOID:
        return Html("".join(text) + ("/>" if name not in {"br", "meta", "col", "hr"} else ">"))
    text.append(">")
    text += [escape(child) for child in children if child is not None]
    text.append(f"</{name}>")
    return Html("".join(text))


def file_name(path: str, shown: str | None = None) -> Html:
    """A path by its last part (or as `shown`), whole where a pointer rests on it."""
    name = shown or re.split(r"[/\\]", path.rstrip("/\\"))[-1] or path
    return tag("code", name, title=path if name != path else None)


def table(
    caption: object,
    head: Sequence[object],
    rows: Iterable[Sequence[object]],
    *,
    numeric: Iterable[int] = (),
    class_: str | None = None,
) -> Html:
    """A table with a caption; a row's first cell is its heading, `numeric` columns align right.

    Of more than MOST_ROWS rows the first are shown, and how many are not.
    """
    right = frozenset(numeric)
    rows = list(rows)
    further = len(rows) - MOST_ROWS

    def cell(kind: str, column: int, content: object, scope: str | None = None) -> Html:
        return tag(kind, content, scope=scope, class_="n" if column in right else None)

    body = join(
        tag(
            "tr",
            *(
                cell("th" if k == 0 else "td", k, c, "row" if k == 0 else None)
                for k, c in enumerate(row)
            ),
        )
        for row in rows[:MOST_ROWS]
    )
    if further > 0:
        words = f"{further} further rows are left out, so that the page stays under 3 MB."
        body = join([body, tag("tr", tag("th", words, scope="row", colspan=len(head)))])
    top = tag("tr", *(cell("th", k, c, "col") for k, c in enumerate(head)))
    # the box scrolls where the page is narrower than the table; it is focusable for the keyboard
    return tag(
        "div",
        tag("table", tag("caption", caption), tag("thead", top), tag("tbody", body), class_=class_),
        class_="wide",
        tabindex=0,
        role="region",
        aria_label=f"Table: {html.unescape(re.sub('<[^>]*>', '', escape(caption)))}",
    )


def json_block(identifier: str, value: Any) -> Html:
    """A data block for the page's script that no text inside can end early.

    Raises ValueError for non-finite numbers: they are not JSON.
    """
    text = json.dumps(value, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    for sign in "<>&":
        text = text.replace(sign, f"\\u{ord(sign):04x}")
    return Html(f'<script type="application/json" id="{escape(identifier)}">{text}</script>')


def css_string(text: str) -> str:
    """`text` as a CSS string in which every sign that could end it is written by its number."""
    shown = _UNSEEN.sub("\ufffd", text).replace("\n", " ").replace("\t", " ")
    return '"' + re.sub(r"[^A-Za-z0-9 .,:]", lambda m: f"\\{ord(m.group()):x} ", shown) + '"'
