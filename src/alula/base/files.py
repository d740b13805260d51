"""Files are written whole or not at all, and hashed as they are read."""

from __future__ import annotations

import errno
import hashlib
import os
import tempfile
from pathlib import Path

from alula.base.messages import refuse


def write_whole(path: Path, content: str | bytes) -> None:
    """Write `content` to `path` by a temporary file beside it, fsync and rename.

    Raises BadInput if the folder does not exist or cannot be written to, or if the name is that of
    a device or pipe, which a rename would replace; what was there is then untouched.
    """
    # A path in the text may hold bytes that are no UTF-8; they become '?'.
    data = content.encode("utf-8", "replace") if isinstance(content, str) else content
    temporary = ""
    try:
        if path.exists() and not path.is_file():
            raise OSError(errno.EINVAL, "a folder, device or pipe")
        handle, temporary = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
        with os.fdopen(handle, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(temporary, 0o666 & ~mask)  # mkstemp makes it private
        os.replace(temporary, path)
    except OSError as error:
        if temporary:
            Path(temporary).unlink(missing_ok=True)
        raise refuse(
            "output_not_writable",
            where=str(path),
            expected="a folder that exists and can be written to",
            found=error.strerror or str(error),
            do="Choose another path or mend the folder's permissions; nothing was written.",
        ) from error


def sha256(path: Path) -> str:
    """Hexadecimal SHA-256 of a file's bytes."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
