"""The frame of a page: nothing from outside, style inside; whole where there is no script."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Mapping, Sequence
from importlib.resources import files

from alula.report.html import Html, tag


def plain_page(title: str, body: Html, style: str = "") -> str:
    """The whole page as text. style: what it needs besides the reports' own style sheet."""
    head = page_head(title, packaged("page.css") + style)
    return "<!DOCTYPE html>\n" + tag("html", head, body, lang="en") + "\n"


Chapter = tuple[str, str, Html]  # anchor, title, content


def chapters_page(
    title: str,
    kicker: str,
    name: str,
    facts: Mapping[str, str],
    chapters: Sequence[Chapter],
    style: str = "",
) -> str:
    """A page of chapters with their contents: what it is of, the facts of it, then each."""
    body = tag(
        "body",
        SKIP,
        contents(chapters),
        tag(
            "main",
            tag("p", f"Alula · {kicker}", class_="kicker"),
            tag("h1", name),
            tag(
                "dl",
                *(tag("div", tag("dt", k), tag("dd", v)) for k, v in facts.items()),
                class_="facts",
            ),
            *sections(chapters),
            END,
            id="report",
        ),
    )
    return plain_page(title, body, style)


SKIP = tag("a", "Skip to the report", href="#report", class_="skip")
END = tag("footer", tag("p", "End of report. Made by Alula; opens offline."))


def contents(chapters: Sequence[Chapter], *more: Html) -> Html:
    """Links to the chapters, then what else belongs there."""
    return tag(
        "nav",
        tag("p", "Contents", class_="kicker"),
        tag("ol", *(tag("li", tag("a", title, href=f"#{at}")) for at, title, _ in chapters)),
        *more,
        aria_label="Contents",
    )


def sections(chapters: Sequence[Chapter]) -> list[Html]:
    """The chapters themselves."""
    return [
        tag("section", tag("h2", title), content, id=at, class_="chapter")
        for at, title, content in chapters
    ]


def page_head(title: str, style: str, scripts: Sequence[str] = ()) -> Html:
    """The head, with a policy that lets in this style and these scripts and nothing else."""
    policy = f"default-src 'none'; style-src {_hash(style)}; "
    if scripts:
        policy += f"script-src {' '.join(map(_hash, scripts))}; img-src data:; "
    policy += "base-uri 'none'; form-action 'none'"
    return tag(
        "head",
        tag("meta", charset="utf-8"),
        tag("meta", http_equiv="Content-Security-Policy", content=policy),
        tag("meta", name="viewport", content="width=device-width, initial-scale=1"),
        tag("meta", name="color-scheme", content="light dark"),
        tag("meta", name="generator", content="Alula"),
        tag("title", title),
        Html(f"<style>{style}</style>"),
    )


def packaged(name: str) -> str:
    """A style sheet or script of this folder."""
    return files("alula.report").joinpath(name).read_text(encoding="utf-8")


def _hash(content: str) -> str:
    digest = hashlib.sha256(content.encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode()}'"
