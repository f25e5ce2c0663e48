"""The thread in which zarr reads and writes, and its end.

When Python exits, zarr gives it 0.2 s to end, and else fails with a traceback: too few on a busy
machine, and after all work is done and told.
"""

from __future__ import annotations

import atexit
from functools import cache
from types import ModuleType

__all__ = ["zarr_module"]


@cache
def zarr_module() -> ModuleType:
    """Return zarr, whose thread ends in its own time."""
    import zarr

    atexit.register(_end_thread)  # before zarr's own hook: the last to come is the first to go
    return zarr


def _end_thread() -> None:
    from zarr.core import sync

    loop, thread = sync.loop[0], sync.iothread[0]
    if loop is not None and thread is not None and thread.is_alive():
        loop.call_soon_threadsafe(loop.stop)
        thread.join()
