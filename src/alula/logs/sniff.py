"""What a file is, by its content; the extension is only compared with it."""

from __future__ import annotations

from pathlib import Path

from alula.base.messages import BadInput, Message, refuse, warn
from alula.base.project import LogSpec

# First bytes -> (kind, what it is). Kinds without a reader end in a message.
MAGIC: tuple[tuple[bytes, str, str], ...] = (
    (b"MATLAB 7.3", "mat73", "MATLAB 7.3 file"),
    (b"MATLAB 5.0", "mat5", "MATLAB 5 file"),
    (b"\x89HDF\r\n\x1a\n", "mat73", "HDF5 file"),
    (b"PK\x03\x04", "npz", "ZIP archive (NPZ)"),
    (b"PAR1", "parquet", "Parquet file"),
    (b"\x93NUMPY", "", "single NumPy array (.npy); save it with names: numpy.savez"),
    (b"ULog\x01\x12\x35", "", "PX4 ULog"),
    (b"\xa3\x95\x80\x80", "", "ArduPilot DataFlash log"),
    (b"\x1f\x8b", "", "gzip archive; unpack it first"),
    (b"BZh", "", "bzip2 archive; unpack it first"),
    (b"7z\xbc\xaf", "", "7z archive; unpack it first"),
    (b"\xd0\xcf\x11\xe0", "", "old Excel or Word file; save it as CSV"),
    (b"\x89PNG", "", "PNG picture"),
    (b"%PDF", "", "PDF document"),
    (b"\x7fELF", "", "program"),
    (b"\xfd\x2f\xb5\x28", "", "Zstandard archive; unpack it first"),
)
READS = {"mat5": "mat", "mat73": "mat", "npz": "npz", "parquet": "parquet", "text": "text"}
EXTENSIONS = {
    ".mat": "mat",
    ".h5": "mat",
    ".hdf5": "mat",
    ".npz": "npz",
    ".parquet": "parquet",
    ".pq": "parquet",
    ".csv": "text",
    ".tsv": "text",
    ".txt": "text",
    ".asc": "text",
    ".dat": "text",
}
SUPPORTED = "CSV, ASCII columns, NPZ, MATLAB 5 and 7.3, HDF5 or Parquet"


def head(path: Path, count: int = 4096) -> bytes:
    """The first bytes of a file; raises BadInput if it is not there, not readable or empty."""
    try:
        with path.open("rb") as file:
            data = file.read(count)
    except (OSError, ValueError) as error:
        raise refuse(
            "file_not_readable",
            where=str(path),
            expected="a log file",
            found=getattr(error, "strerror", None) or str(error),
            do="Check the path and the folder's permissions.",
        ) from None
    if not data:
        raise refuse(
            "empty_file",
            where=str(path),
            expected="a log with samples",
            found="a file of 0 bytes",
            do="Copy the log again from where it was recorded.",
        )
    return data


def kind(path: Path) -> tuple[str, str]:
    """(kind, description) by content: 'mat5', 'mat73', 'npz', 'parquet', 'text'; '' unknown."""
    data = head(path)
    for magic, name, what in MAGIC:
        if data.startswith(magic):
            return name, what
    if _is_text(data):
        return "text", "text"
    return "", "binary data of a kind that Alula does not know"


def _is_text(data: bytes) -> bool:
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return True
    zeros = data.count(0)
    if zeros:  # UTF-16 without a byte order mark has its zeros on one side
        odd = data[1::2].count(0)
        return zeros > 0.3 * len(data) and (odd == zeros or odd == 0)
    control = sum(data.count(c) for c in range(32) if c not in (9, 10, 12, 13, 26, 27))
    return control <= 0.01 * len(data)


def choose(log: LogSpec) -> tuple[str, list[Message]]:
    """The reader's name for a log and what there is to say about its type."""
    found, what = kind(log.path)
    family = READS.get(found, "")
    asked = {"csv": "text", "ascii": "text", "hdf5": "mat"}.get(log.format, log.format)
    if not family or (asked != "auto" and asked != family):
        raise wrong_type(log.path, log.format, what)
    messages = []
    extension = log.path.suffix.lower()
    if EXTENSIONS.get(extension, family) != family:
        messages.append(
            warn(
                "wrong_type",
                where=str(log.path),
                expected=f"what the extension {extension} says",
                found=what,
                do="The content was read as what it is; rename the file if that is right.",
            )
        )
    if family == "text":
        return (log.format if log.format != "auto" else "text"), messages
    return family, messages


def wrong_type(path: Path, asked: str, what: str) -> BadInput:
    """The refusal of a file whose content is not what is asked for."""
    return refuse(
        "wrong_type",
        where=str(path),
        expected=SUPPORTED if asked == "auto" else f"format '{asked}'",
        found=what,
        do="Name the file that holds the log, set format = 'auto', or export the log anew.",
    )
