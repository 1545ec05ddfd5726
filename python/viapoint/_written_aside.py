"""Files that are written piece by piece, and whole or not at all."""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from . import _core

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer


class _Pieces(io.BufferedIOBase):
    """What libraries write archives into. Nothing is kept here: each piece goes to the system."""

    def __init__(self, file: _core.AtomicFile) -> None:
        self._file = file
        self._size = 0

    def writable(self) -> bool:
        """Tell that it is there to be written."""
        return True

    def write(self, piece: ReadableBuffer, /) -> int:
        """Write on; return the number of bytes."""
        data = bytes(piece)
        self._file.write(data)
        self._size += len(data)
        return len(data)

    def tell(self) -> int:
        """Count the bytes so far."""
        return self._size


@contextmanager
def written_aside(path: str) -> Iterator[io.BufferedIOBase]:
    """Give a stream whose content takes the place of a file's when the block ends well.

    Parameters
    ----------
    path : str
        The file. Unless the block ends well it stays as it was, and nothing else is left.

    Yields
    ------
    BufferedIOBase
        To be written from its beginning to its end; it cannot seek.

    Raises
    ------
    FileError
        With the path and the system's reason.
    """
    file = _core.AtomicFile(path)
    try:
        yield _Pieces(file)
        file.commit()
    finally:
        file.discard()
