"""What pydantic found wrong with a file, in Alula's words: key, expected, found, what to do."""

from __future__ import annotations

import difflib
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, get_args

from pydantic import BaseModel, ValidationError

from alula.base.messages import BadInput, Message, refuse

_EXPECTED = {
    "float_type": "a number",
    "int_type": "a whole number",
    "string_type": "text in quotes",
    "bool_type": "true or false",
    "list_type": "a list in brackets",
    "dict_type": "a table",
    "model_type": "a table",
    "finite_number": "a finite number",
}


def read_toml(path: Path, kind: str) -> tuple[bytes, dict[str, Any]]:
    """A file's bytes and its tables; raises BadInput if it cannot be read or is not TOML."""
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise refuse(
            "file_not_readable",
            where=str(path),
            expected=f"a readable {kind}",
            found=error.strerror or str(error),
            do="Check the path; it is taken relative to the file that names it.",
        ) from error
    try:
        return raw, tomllib.loads(raw.decode("utf-8-sig"))
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise refuse(
            "toml_syntax",
            where=str(path),
            expected=f"a {kind} in TOML, UTF-8",
            found=str(error),
            do="Mend the line named; text stands in quotes, lists in brackets.",
        ) from error


def bad_file(error: ValidationError, model: type[BaseModel], path: Path) -> BadInput:
    """All that is wrong with the file, one message per key."""
    return BadInput(*(_message(dict(e), model, path) for e in error.errors()))


def _message(error: Mapping[str, Any], model: type[BaseModel], path: Path) -> Message:
    kind, loc = str(error["type"]), tuple(error["loc"])
    key = ".".join(str(part + 1) if isinstance(part, int) else part for part in loc)
    context, found = error.get("ctx", {}), _shown(error["input"])
    do = "Correct the value; `alula schema` prints all keys with their units."
    if kind == "missing":
        expected, found = f"the key '{loc[-1]}'", "nothing"
    elif kind == "extra_forbidden":
        known = _keys(model, loc[:-1])
        expected, found = "one of " + ", ".join(known), f"the key '{loc[-1]}'"
        near = difflib.get_close_matches(str(loc[-1]), known, 1)
        if near:
            do = f"Did you mean '{near[0]}'? Otherwise remove the key."
    elif kind == "literal_error":
        expected = str(context["expected"])
    elif kind in ("greater_than", "greater_than_equal"):
        bound = context.get("gt", context.get("ge"))
        expected = f"a number {'above' if 'gt' in context else 'of at least'} {bound:g}"
    elif kind in ("too_short", "too_long"):
        length = context.get("min_length", context.get("max_length"))
        expected, found = f"{length} values", f"{context['actual_length']}: {found}"
    elif kind == "value_error":
        expected = str(context["error"])
        found = "this is not so" if isinstance(error["input"], Mapping) else found
    else:
        expected = _EXPECTED.get(kind, str(error["msg"]))
    return Message("file_key", "error", f"{path}, {key or 'file'}", expected, found, do)


def _keys(model: type[BaseModel], loc: tuple[int | str, ...]) -> list[str]:
    """The keys that the table at `loc` may have."""
    here: Any = model
    for part in loc:
        if isinstance(here, type) and issubclass(here, BaseModel):
            fields = {f.alias or name: f for name, f in here.model_fields.items()}
            here = _inner(fields[str(part)].annotation) if part in fields else None
    if isinstance(here, type) and issubclass(here, BaseModel):
        return [f.alias or name for name, f in here.model_fields.items()]
    return []


def _inner(annotation: Any) -> Any:
    """The model inside `Model | None`, `list[Model]` or `dict[str, Model]`."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    for argument in reversed(get_args(annotation)):
        found = _inner(argument)
        if found is not None:
            return found
    return None


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 80 else text[:77] + "..."
