"""What the project file's reader says: TOML and schema errors in words, units, paths.

The aircraft file's reader says the same; nothing here knows the keys of either.
"""

from __future__ import annotations

import hashlib
import os
import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from alula.base.messages import BadInput, Message, refuse
from alula.base.units import to_si

# What takes each kind of file, for those who name it elsewhere.
_TAKERS = {
    "project": "is for alula check, identify, validate, navigate and airdata",
    "plan": "is for alula fly; check and identify take the project that it writes",
    "aircraft": "is for alula trim, modes, plan and predict, and for 'aircraft' of a project",
    "model": "is for --model of alula trim, modes, plan, validate, and for alula export",
    "calibration": "is for alula calibrate",
    "propeller": "is for alula propeller",
}
_Schema = TypeVar("_Schema", bound=BaseModel)


def read_toml(path: Path) -> tuple[str, dict[str, Any], str]:
    """Text, tree and SHA-256 of a TOML file; raises BadInput if it is not one."""
    try:
        data = path.read_bytes()
    except (OSError, ValueError) as error:
        raise refuse(
            "file_not_readable",
            where=str(path),
            expected="a TOML file",
            found=getattr(error, "strerror", None) or str(error),
            do="Check the path.",
        ) from None
    try:
        text = data.decode("utf-8-sig")
        tree = tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # not UTF-8, not TOML, endless numbers
        do = (
            "Mend the line named; strings need quotes, tables need [brackets]. A log? "
            "`alula new` makes a project file for one."
        )
        if data.lstrip()[:1] == b"{":
            do = (
                "This looks like JSON, as --json writes it. `alula identify --model FILE` writes "
                "a model, `alula compare` reads results."
            )
        raise refuse(
            "not_toml",
            where=str(path),
            expected="TOML in UTF-8",
            found=str(error),
            do=do,
        ) from None
    return text, tree, hashlib.sha256(data).hexdigest()


def expand(text: str, file: Path, key: str) -> str:
    """`text` with ${VARIABLES} replaced, absolute from the folder of `file`."""

    def value(match: re.Match[str]) -> str:
        name = match.group(1)
        if name not in os.environ:
            raise refuse(
                "variable_not_set",
                where=f"{file}: {key}",
                expected=f"the environment variable {name} that '{text}' names",
                found="it is not set",
                do=f"Set it: export {name}=/the/folder",
            )
        return os.environ[name]

    expanded = os.path.expanduser(re.sub(r"\$\{(\w+)\}", value, text))
    return os.path.abspath(file.parent / expanded)


def expand_paths(
    tree: dict[str, Any], file: Path, keys: Sequence[str], tables: str, inner: Sequence[str]
) -> None:
    """Expand the paths at `keys` and those at `inner` of each of [[tables]], where given."""

    def in_table(table: dict[str, Any], names: Sequence[str], where: str) -> None:
        for name in names:
            if isinstance(table.get(name), str):
                table[name] = expand(table[name], file, where + name)

    in_table(tree, keys, "")
    listed = tree.get(tables)
    for i, table in enumerate(listed if isinstance(listed, list) else [], 1):
        if isinstance(table, dict):
            in_table(table, inner, f"{tables}[{i}].")


def validated(
    schema: type[_Schema], tree: Mapping[str, Any], path: Path, text: str = ""
) -> _Schema:
    """The tree as its schema; raises BadInput with one message for each thing that is wrong."""
    try:
        return schema.model_validate(dict(tree))
    except ValidationError as error:
        raise BadInput(*explain(error, path, text)) from None


def explain(error: ValidationError, path: Path, text: str = "") -> list[Message]:
    """One message for each thing that pydantic found, in the words of the file."""
    messages: list[Message] = []
    for item in error.errors(include_url=False):
        key = _key(item["loc"])
        kind, context, found = item["type"], item.get("ctx", {}), _short(item["input"])
        expected, do, code = item["msg"][:1].lower() + item["msg"][1:], "Correct it.", "bad_value"
        if kind == "missing":
            code, found = "missing_key", "no such key"
            expected, do = f"the key '{item['loc'][-1]}'", "Add it."
        elif kind == "extra_forbidden":
            code, found = "unknown_key", f"'{item['loc'][-1]}'"
            expected, do = "a key that is known", "Remove it or mend its spelling."
            near = get_close_matches(str(item["loc"][-1]), _keys(error), n=1, cutoff=0.7)
            do = f"Did you mean '{near[0]}'?" if near else do
        elif kind == "literal_error":
            expected = context["expected"]
        elif kind == "value_error":
            reason, _, got = str(context["error"]).partition("|")
            expected, found = reason, got or found
        elif kind.endswith("_type"):
            expected = expected.removeprefix("input should be ")
        else:
            expected = re.sub("^input (should )?(be )?", "", expected)
        message = Message(
            code, "error", f"{path}: {key}{_line(text, item['loc'])}", expected, found, do
        )
        if item["loc"] == ("schema",) and isinstance(item["input"], str):
            # another kind of file: what else differs would only hide that
            kind_of = re.match(r"alula\.(\w+)/", item["input"])
            takes = _TAKERS.get(kind_of[1] if kind_of else "")
            do = "Name a file of that kind, or correct the key."
            return [replace(message, do=f"{do} This one {takes}." if takes else do)]
        if message not in messages:
            messages.append(message)
    return messages


def _keys(error: ValidationError) -> list[str]:
    """Keys of every schema under the one that failed, for 'did you mean'."""
    found: set[str] = set()

    def walk(schema: type[BaseModel]) -> None:
        for name, field in schema.model_fields.items():
            found.add(field.alias or name)
            for inner in _models(field.annotation):
                walk(inner)

    def _models(annotation: Any) -> list[type[BaseModel]]:
        if isinstance(annotation, type) and issubclass(annotation, BaseModel):
            return [annotation]
        return [m for a in getattr(annotation, "__args__", ()) for m in _models(a)]

    def subclasses(base: type[BaseModel]) -> list[type[BaseModel]]:
        return [c for s in base.__subclasses__() for c in (s, *subclasses(s))]

    for schema in subclasses(BaseModel):
        if schema.__name__ == error.title or schema.model_config.get("title") == error.title:
            walk(schema)
    return sorted(found)


def _key(location: tuple[int | str, ...]) -> str:
    """'logs[1].channels.alpha.unit': list positions count from one, union branches left out."""
    text = ""
    for part in location:
        if isinstance(part, int):
            text += f"[{part + 1}]"
        elif not re.search(
            r"[\[(]|^(int|str|float|bool|TimeSpec|list|dict|constrained-\w+)$", part
        ):
            text += f".{part}" if text else part
    return text or "the file"


def _line(text: str, location: tuple[int | str, ...]) -> str:
    """', line 12' where the last key of the location stands in the file exactly once."""
    names = [part for part in location if isinstance(part, str)]
    if not text or not names:
        return ""
    pattern = re.compile(rf"(?<![\w.]){re.escape(names[-1])}\s*=")
    lines = [i for i, line in enumerate(text.splitlines(), 1) if pattern.search(line)]
    return f", line {lines[0]}" if len(lines) == 1 else ""


def _short(value: object) -> str:
    text = repr(value) if isinstance(value, str | int | float | bool) else type(value).__name__
    text = {"dict": "a table", "list": "a list", "NoneType": "nothing"}.get(text, text)
    return text if len(text) <= 60 else text[:57] + "..."


def check_units(value: object, path: Path, key: str = "") -> list[Message]:
    """Messages for every unknown unit in a model and the models it holds."""
    problems: list[Message] = []
    if isinstance(value, BaseModel):
        for name in type(value).model_fields:
            inner = getattr(value, name)
            if name == "unit" and isinstance(inner, str):
                try:
                    to_si(inner, where=f"{path}: {key}.unit")
                except BadInput as error:
                    problems += error.messages
            else:
                problems += check_units(inner, path, f"{key}.{name}" if key else name)
    elif isinstance(value, dict):
        for name, inner in value.items():
            problems += check_units(inner, path, f"{key}.{name}")
    elif isinstance(value, list):
        for i, inner in enumerate(value):
            problems += check_units(inner, path, f"{key}[{i + 1}]")
    return problems
