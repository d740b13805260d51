"""A browser that watches what the page asks for and complains about."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

ARGUMENTS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
]


@dataclass
class Opened:
    """A page in the browser, with what it asked for and what went wrong on it."""

    page: Any
    requests: list[str] = field(default_factory=list)
    complaints: list[str] = field(default_factory=list)

    def plots(self) -> int:
        count: int = self.page.locator("[data-plot]").count()
        return count

    def drawn(self, plot: int) -> tuple[float, float]:
        """The time window that plot `plot` was last drawn with, s."""
        text = self.page.locator(f'[data-plot="{plot}"]').get_attribute("data-drawn")
        low, high = map(float, text.split())
        return low, high

    def settle(self) -> None:
        """Wait until every plot is drawn as the page now wants it."""
        self.page.wait_for_function(
            "() => [...document.querySelectorAll('[data-plot]')].every(e => e.dataset.drawn)"
        )
        # two frames: one that draws what is in view, one for the rest
        self.page.evaluate(
            "() => new Promise(r => requestAnimationFrame(() => requestAnimationFrame("
            "() => setTimeout(r, 100))))"
        )


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """The distribution's Chromium; skips where it is missing, unless everything is required."""
    path = shutil.which("chromium") or shutil.which("chromium-browser")
    reason = ""
    if path is None:
        reason = "Chromium is not installed (package: chromium)"
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        reason = "playwright is not installed (package: playwright)"
    if reason:
        if os.environ.get("ALULA_REQUIRE_DATA"):
            pytest.fail(reason)
        pytest.skip(reason)
    with sync_playwright() as play:
        chromium = play.chromium.launch(executable_path=path, args=ARGUMENTS)
        yield chromium
        chromium.close()


@pytest.fixture
def visit(browser: Any, tmp_path: Path) -> Iterator[Callable[..., Opened]]:
    """Opens a page's text from a file, as a reader would; `width` and `scheme` of the screen."""
    contexts = []

    def open_page(text: str, width: int = 1280, scheme: str = "light") -> Opened:
        file = tmp_path / "report.html"
        file.write_text(text, encoding="utf-8")
        context = browser.new_context(viewport={"width": width, "height": 900}, color_scheme=scheme)
        contexts.append(context)
        opened = Opened(context.new_page())
        opened.page.on("request", lambda r: opened.requests.append(r.url))
        opened.page.on("pageerror", lambda e: opened.complaints.append(str(e)))
        opened.page.on(
            "console",
            lambda m: opened.complaints.append(m.text) if m.type in ("error", "warning") else None,
        )
        opened.page.on("dialog", lambda d: (opened.complaints.append("dialog"), d.dismiss()))
        opened.page.goto(file.as_uri())
        opened.settle()
        return opened

    yield open_page
    for context in contexts:
        context.close()
