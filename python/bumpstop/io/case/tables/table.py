"""What all tables of a case file have in common."""

from pydantic import BaseModel, ConfigDict

__all__ = ["Table"]


class Table(BaseModel):
    """A table of the case file: its keys are known, others are mistakes."""

    # Only the whole file's validator is ever used, so the tables' own are not built.
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, defer_build=True)
