"""What zarr leaves behind when Python exits."""

import subprocess
import sys

BUSY_AT_THE_END = """
import sys, time
from bumpstop.study.zarr_thread import zarr_module
zarr_module().open_group(sys.argv[1], mode="w")
from zarr.core import sync
sync.loop[0].call_soon_threadsafe(time.sleep, 0.5)
"""


def test_a_busy_thread_ends_in_peace(tmp_path: object) -> None:
    """zarr itself waits for 0.2 s, and then ends in a traceback."""
    command = [sys.executable, "-c", BUSY_AT_THE_END, f"{tmp_path}/group.zarr"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
