"""Objects sent through pipes: each is preceded by its length."""

from __future__ import annotations

import pickle
from typing import Any, BinaryIO

__all__ = ["receive", "send"]

_LENGTH = 8


def send(stream: BinaryIO, thing: object) -> None:
    """Write an object."""
    content = pickle.dumps(thing, protocol=pickle.HIGHEST_PROTOCOL)
    stream.write(len(content).to_bytes(_LENGTH, "little"))
    stream.write(content)
    stream.flush()


def receive(stream: BinaryIO) -> Any:
    """Return the next object.

    Raises
    ------
    EOFError
        If whoever writes has ended, in the middle of an object or before.
    """
    length = int.from_bytes(_exactly(stream, _LENGTH), "little")
    return pickle.loads(_exactly(stream, length))


def _exactly(stream: BinaryIO, length: int) -> bytes:
    content = stream.read(length)
    if len(content) < length:
        raise EOFError
    return content
