"""The folder of a virtual flight test: it appears whole, or not at all."""

from __future__ import annotations

import os
import shutil
import tempfile
from pathlib import Path

from alula.base.messages import BadInput, refuse
from alula.simulate.virtual_loading import MODEL

PROJECT, TRUTH = "campaign.toml", "truth.json"


def save(path: Path, data: bytes) -> None:
    """Write a file of the new folder to the disk."""
    with path.open("wb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())


def check_folder(folder: Path) -> None:
    """A folder that is there already is replaced only if it is empty or an earlier campaign."""
    found = ""
    if folder.exists() and not folder.is_dir():
        found = "a file"
    elif folder.is_dir() and any(folder.iterdir()) and not _is_campaign(folder):
        found = "a folder with other files in it"
    elif not folder.absolute().parent.is_dir():
        found = f"no folder {folder.absolute().parent}"
    elif not os.access(folder.absolute().parent, os.W_OK):
        found = f"no permission to write to {folder.absolute().parent}"
    if found:
        raise refuse(
            "output_not_writable",
            where=str(folder),
            expected="a free name, an empty folder, or an earlier campaign to replace",
            found=found,
            do="Choose another folder with --out; nothing was done yet.",
        )


def _is_campaign(folder: Path) -> bool:
    ours = {"logs", "truth", PROJECT, TRUTH, MODEL}
    names = {p.name for p in folder.iterdir()}
    return ours <= names and all(n in ours or n.endswith(".toml") for n in names)


class NewFolder:
    """A folder beside `path` that takes its place at the end, or vanishes where something fails."""

    def __init__(self, path: Path) -> None:
        self.path = path.absolute()
        self.new = Path()

    def __enter__(self) -> Path:
        try:
            self.new = Path(tempfile.mkdtemp(prefix=f".{self.path.name}.", dir=self.path.parent))
        except OSError as error:
            raise _not_writable(self.path, error) from None
        mask = os.umask(0)
        os.umask(mask)
        self.new.chmod(0o777 & ~mask)  # mkdtemp makes it private
        return self.new

    def __exit__(self, kind: type[BaseException] | None, error: object, trace: object) -> None:
        if kind is None:
            try:
                old = Path()
                if self.path.exists():
                    old = self.new.with_name(self.new.name + ".old")
                    self.path.rename(old)
                self.new.rename(self.path)
                if old != Path():
                    shutil.rmtree(old)
                return
            except OSError as problem:
                shutil.rmtree(self.new, ignore_errors=True)
                raise _not_writable(self.path, problem) from None
        shutil.rmtree(self.new, ignore_errors=True)


def _not_writable(path: Path, error: OSError) -> BadInput:
    return refuse(
        "output_not_writable",
        where=str(path),
        expected="a folder that exists and can be written to",
        found=error.strerror or str(error),
        do="Choose another folder with --out; nothing was written.",
    )
