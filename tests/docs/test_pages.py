"""The pages: links lead somewhere, names in them exist, every method has its page."""

from __future__ import annotations

import importlib
import re
import tomllib
from pathlib import Path
from urllib.parse import unquote

import pytest

from alula.base.project import ReconstructSpec
from alula.campaign.methods import IDENTIFIERS
from alula.logs.reader import READERS
from alula.reconstruct import METHODS

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted(
    page
    for page in [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("src/**/*.md")]
    if ".venv" not in page.parts
)
# The page of each registered method; a new entry in a registry needs one here.
METHOD_PAGES = {
    "ekf": "extended_filter.md",
    "iekf": "iterated_filter.md",
    "ukf": "unscented_filter.md",
    "srukf": "square_root_filter.md",
    "ml": "maximum_likelihood.md",
    "ee": "equation_error.md",
    "oe": "output_error.md",
    "fe": "filter_error.md",
    "fd": "frequency_domain.md",
    "rls": "recursive.md",
    "stall": "stall_identification.md",
}


def without_code(text: str) -> str:
    """The text outside of fenced blocks and inline code."""
    return re.sub(r"`[^`\n]*`", "", re.sub(r"^```.*?^```", "", text, flags=re.S | re.M))


def anchors(page: Path) -> set[str]:
    """What a link can name after '#': headings, as code hosts turn them into names."""
    found = re.findall(r"^#+ (.+)$", without_code(page.read_text()), flags=re.M)
    return {re.sub(r"[^\w\- ]", "", h.lower()).replace(" ", "-") for h in found}


@pytest.mark.parametrize("page", PAGES, ids=lambda p: str(p.relative_to(ROOT)))
def test_links_lead_somewhere(page: Path) -> None:
    wrong = []
    for target in re.findall(r"\]\(([^)\s]+)\)", without_code(page.read_text())):
        if target.startswith("https://"):
            continue
        path, _, anchor = target.partition("#")
        there = (page.parent / unquote(path)).resolve() if path else page
        if not there.exists() or (anchor and anchor not in anchors(there)):
            wrong.append(target)
    assert wrong == []


def test_python_names_on_the_pages_are_there() -> None:
    """Dotted names are imported; functions that are named bare are in the package of their page."""
    missing = []
    for page in [*ROOT.glob("docs/**/*.md")]:
        text = page.read_text()
        for name in re.findall(r"`(alula(?:\.\w+)+)(?![\w/])", text):
            if not _there(name):
                missing.append(f"{page.name}: {name}")
        for name in re.findall(r"`(identify_\w+|\w+_responses|recursive_\w+)[`(]", text):
            if not _there(f"alula.identify.{name}"):
                missing.append(f"{page.name}: {name}")
    assert missing == []


def _there(name: str) -> bool:
    parts = name.split(".")
    for i in range(len(parts), 0, -1):
        try:
            found = importlib.import_module(".".join(parts[:i]))
        except ImportError:
            continue
        for part in parts[i:]:
            found = getattr(found, part, None)
        return found is not None
    return False


def test_every_page_is_listed() -> None:
    listed = "".join((ROOT / "docs" / p).read_text() for p in ("index.md", "methods/index.md"))
    for page in ROOT.glob("docs/**/*.md"):
        if page.name != "index.md":
            assert page.name in listed, f"{page.name} is in neither index"


def test_every_method_has_a_page() -> None:
    registered = {*METHODS, *IDENTIFIERS}
    assert registered == set(METHOD_PAGES)
    for name in METHOD_PAGES.values():
        page = (ROOT / "docs" / "methods" / name).read_text()
        assert re.search(r"[Ww]hat it does", page), f"{name} does not say what it does"
        assert re.search(r"[Ww]hen to use", page), f"{name} does not say when to use it"


def test_map_names_every_folder_and_its_files_exist() -> None:
    text = (ROOT / "src/alula/README.md").read_text()
    folders = {p.parent.name for p in (ROOT / "src/alula").glob("*/__init__.py")}
    for folder in folders:
        assert f"]({folder})" in text


def test_readers_are_named_in_the_page_on_logs() -> None:
    text = (ROOT / "docs/logs.md").read_text().lower()
    words = {"csv": "csv", "ascii": "ascii", "npz": "npz", "mat": "matlab", "parquet": "parquet"}
    assert set(words) | {"text"} == set(READERS)
    for word in words.values():
        assert word in text


def test_project_page_shows_a_valid_project(tmp_path: Path, monkeypatch) -> None:
    from alula.base.project import load_project

    monkeypatch.setenv("LOGS", str(tmp_path))
    (block,) = re.findall(r"```toml\n(.*?)```", (ROOT / "docs/project_file.md").read_text(), re.S)
    (tmp_path / "p.toml").write_text(block)
    project = load_project(tmp_path / "p.toml")
    assert set(tomllib.loads(block)["reconstruct"]) == set(ReconstructSpec.model_fields)
    assert project.maneuvers[0].id == "elevator"
