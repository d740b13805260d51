"""The frame of a page without script: nothing from outside, style inside."""

from __future__ import annotations

import base64
import hashlib
from importlib.resources import files

from alula.report.html import Html, tag


def plain_page(title: str, body: Html, style: str = "") -> str:
    """The whole page as text. style: what it needs besides the reports' own style sheet."""
    style = files("alula.report").joinpath("page.css").read_text(encoding="utf-8") + style
    digest = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
    policy = f"default-src 'none'; style-src 'sha256-{digest}'; base-uri 'none'; form-action 'none'"
    head = tag(
        "head",
        tag("meta", charset="utf-8"),
        tag("meta", http_equiv="Content-Security-Policy", content=policy),
        tag("meta", name="viewport", content="width=device-width, initial-scale=1"),
        tag("meta", name="color-scheme", content="light dark"),
        tag("meta", name="generator", content="Alula"),
        tag("title", title),
        Html(f"<style>{style}</style>"),
    )
    return "<!DOCTYPE html>\n" + tag("html", head, body, lang="en") + "\n"
