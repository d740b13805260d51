"""Ctrl-C in the middle of a command."""

from __future__ import annotations

from pathlib import Path

import pytest

from alula.campaign import airdata
from alula.cli.app import main


def test_ctrl_c_is_answered_in_words(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    def pressed(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(airdata, "run_air_data", pressed)
    page = tmp_path / "page.html"
    with pytest.raises(SystemExit) as end:
        main(["airdata", "project.toml", "--report", str(page), "--json", "-"])
    assert end.value.code == 130
    said = capsys.readouterr()
    assert said.err == "interrupted; no file was left half written\n"
    assert said.out == ""
    assert not page.exists()
