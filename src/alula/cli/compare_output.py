"""What `alula compare` prints: the parameters in blocks of as many sources as the width takes."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from shutil import get_terminal_size
from textwrap import wrap
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from alula.campaign.compare import Comparison
    from alula.identify.compare import Difference, Row

PIPED = 160  # letters a line where nothing says how wide the paper is
_FIRST = 22  # value and se
_RATIO, _SPAN, _SIGMAS = 8, 17, 9


def text_of(found: Comparison, width: int | None = None) -> str:
    """The columns with a number each, the parameters, and how each predicts.

    width: letters a line; default the terminal's.
    """
    width = width or _terminal()
    lines: list[str] = []
    for i, s in enumerate(found.sources, start=1):
        words = f"{i}  {s.column.name}: {s.column.method}"
        words += f"; se: {s.column.se_is}" if s.column.se_is else ""
        lines += wrap(words, width, subsequent_indent="   ")
    shown = [r for r in found.rows if not _own(r)]
    name = max([12, *(len(r.name) + 1 for r in shown)])
    full = _FIRST + _RATIO + _SPAN + _SIGMAS
    spans = name + _FIRST + full <= width
    each = full if spans else full - _SPAN
    for block in _blocks(len(found.sources), max(1, (width - name - _FIRST) // each)):
        head = _header(name, block, spans)
        lines += ["", head, "-" * len(head)]
        first = block[0] == 1
        lines += [_line(row, name, block, spans) for row in shown if _in(row, block, first)]
    said = []
    if len(shown) < len(found.rows):
        said.append(
            f"{len(found.rows) - len(shown)} initial states, biases and noises that column 1 or "
            "all others lack: see --json."
        )
    said.append(
        ("ratio, its 95 % interval and the difference" if spans else "ratio and difference")
        + " are to column 1; the difference is in combined se."
    )
    if not spans:
        said.append(
            f"The ratio's 95 % interval is left out: {width} letters a line. A wider window or "
            "--json has it."
        )
    if any(_starred(d) for r in shown for d in r.differences):
        said.append("* the rate's derivative alone, beside sums with the lag's.")
    for words in said:
        lines += wrap(words, width)
    if found.judged:
        lines += _judged(found, width)
    return "\n".join(lines)


def _terminal() -> int:
    return get_terminal_size((PIPED, 24)).columns if sys.stdout.isatty() else PIPED


def _blocks(sources: int, at_once: int) -> list[list[int]]:
    """The numbers of the columns beside the first, at most so many at once, evenly spread."""
    rest = list(range(1, sources))
    count = -(-len(rest) // at_once)
    size = -(-len(rest) // count)
    return [rest[i : i + size] for i in range(0, len(rest), size)]


def _header(name: int, block: Sequence[int], spans: bool) -> str:
    out = f"{'parameter':<{name}}{'value (1)':>12}{'se':>10}"
    for i in block:
        out += f"{f'value ({i + 1})':>12}{'se':>10}{'ratio':>{_RATIO}}"
        out += (f"{'95 %':>{_SPAN}}" if spans else "") + f"{'diff/se':>{_SIGMAS}}"
    return out


def _line(row: Row, name: int, block: Sequence[int], spans: bool) -> str:
    out = f"{row.name:<{name}}" + _value(row.differences[0])
    for i in block:
        d = row.differences[i]
        out += _value(d)
        if d is None:
            out += f"{'-':>{_RATIO}}" + (f"{'-':>{_SPAN}}" if spans else "") + f"{'-':>{_SIGMAS}}"
            continue
        # + 0.0: no minus before a zero
        out += f"{d.ratio + 0.0:>{_RATIO}.3f}" if math.isfinite(d.ratio) else f"{'-':>{_RATIO}}"
        if spans:
            low, high = d.ratio_ci95
            words = f"{low:.2f} to {high:.2f}" if math.isfinite(low) else "-"
            out += f"{words:>{_SPAN}}"
        out += f"{d.sigmas:>+{_SIGMAS}.2f}" if math.isfinite(d.sigmas) else f"{'-':>{_SIGMAS}}"
    return out


def _value(d: Difference | None) -> str:
    if d is None:
        return f"{'-':>12}{'-':>10}"
    e = d.entry
    if e.verdict == "not_identifiable":
        return f"{'not ident.':>12}{'-':>10}"
    value = f"{e.value:.5g}" + ("*" if _starred(d) else "")
    return f"{value:>12}" + (f"{e.se:>10.2g}" if math.isfinite(e.se) else f"{'-':>10}")


def _judged(found: Comparison, width: int) -> list[str]:
    ids = ", ".join(m.id for m in found.maneuvers)
    held = all(m.held_out for m in found.maneuvers)
    lines = ["", *wrap(f"On {'held-out ' if held else ''}maneuvers {ids}:", width)]
    at_once = max(1, (width - 23) // 20)
    every = range(len(found.sources))
    for block in (every[i : i + at_once] for i in every[::at_once]):
        head = f"{'coefficient':<14}{'samples':>9}"
        head += "".join(f"{f'R2 ({i + 1})':>11}{'RRMSE':>9}" for i in block)
        lines += [head, "-" * len(head)]
        for c, row in found.judged.items():
            cells = "".join(
                f"{'-':>11}{'-':>9}" if (j := row[i]) is None else f"{j.r2:>11.4f}{j.rrmse:>9.2%}"
                for i in block
            )
            lines.append(f"{c:<14}{found.samples[c]:>9d}{cells}")
    for i, s in enumerate(found.sources):
        saw = [id for id, words in found.seen.items() if words[i] != "no"]
        if saw:
            sure = all(found.seen[id][i] == "yes" for id in saw)
            lines += wrap(
                f"{s.column.name} {'learned' if sure else 'may have learned'} from "
                f"{', '.join(saw)}: no validation there",
                width,
            )
    return lines


def _starred(d: Difference | None) -> bool:
    return d is not None and d.entry.verdict == "alone"


def _own(row: Row) -> bool:
    """Whether it is a nuisance, an initial state, bias or noise, that is set beside nothing."""
    if not ("(0)[" in row.name or row.name.startswith(("b_", "F_", "sigma_"))):
        return False
    first, *others = row.differences
    return first is None or all(d is None for d in others)


def _in(row: Row, block: Sequence[int], first: bool) -> bool:
    """Whether one of the block's columns has the row; what column 1 alone has is in the first."""
    if any(row.differences[i] is not None for i in block):
        return True
    return first and all(d is None for d in row.differences[1:])
