"""Modes that a file gives, which nobody need identify."""

from __future__ import annotations

from bumpstop.errors import InputError

__all__ = ["refuse_identification"]


def refuse_identification(band: tuple[float, float] | None, count: int | None) -> None:
    """Raise where somebody says how to identify modes that are given."""
    for key, value in (("band", band), ("count", count)):
        if value is not None:
            hint = "the file holds modes; it is for measured functions"
            raise InputError("has nothing to identify", key=key, value=value, hint=hint)
