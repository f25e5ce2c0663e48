"""What a study file holds."""

import re
from typing import Annotated, Any

from bumpstop.arguments import did_you_mean
from bumpstop.errors import InputError
from bumpstop.io.case.fields.counts import Count, CountFromZero
from bumpstop.io.case.fields.plain import Plain
from bumpstop.io.case.fields.quantities import PositiveNumber, PositiveTime, Times
from bumpstop.io.case.fields.words import Name, Node, OneDof, Text, choice
from bumpstop.io.case.tables.table import Field, Table
from bumpstop.study.outputs import OUTPUT_QUANTITIES, OUTPUT_STATISTICS
from bumpstop.study.parameters import Distribution, Parameter, Range, Values
from bumpstop.study.sampling import SAMPLINGS

__all__ = ["StudyFile"]

_KINDS = ("values", "from", "distribution")
"""Keys of which a parameter has one."""


def _read_parameter(value: object) -> Parameter:
    """Return how a parameter varies."""
    if isinstance(value, list):
        return Values(value)
    if not isinstance(value, dict):
        hint = "such as { from = 1, to = 2, count = 5 }"
        raise InputError("must be a list of values or a table", value=value, hint=hint)
    kinds = [kind for kind in _KINDS if kind in value]
    if len(kinds) != 1:
        dotted = "a dotted name goes in quotes" if _holds_tables(value) else None
        what = "needs either values, from and to, or distribution"
        raise InputError(what, value=value, hint=dotted)
    if kinds == ["distribution"]:
        return _distribution(value)
    known = ("values",) if kinds == ["values"] else ("from", "to", "count", "spacing")
    for key in value:
        if key not in known:
            raise InputError("unknown key", key=key, hint=did_you_mean(key, known))
    if kinds == ["values"]:
        return Values(value["values"])
    if "to" not in value:
        raise InputError("is missing", key="to", hint="a range ends somewhere")
    return Range(value["from"], value["to"], value.get("count"), value.get("spacing", "linear"))


def _distribution(value: dict[str, Any]) -> Distribution:
    given = dict(value)
    name = given.pop("distribution")
    if not all(re.fullmatch(r"[A-Za-z]\w*", key) for key in given):
        raise InputError("has a parameter that no distribution has", value=value)
    return Distribution(name, **given)


def _holds_tables(value: dict[str, Any]) -> bool:
    return any(isinstance(each, dict) for each in value.values())


def _read_key(value: object) -> str:
    if not isinstance(value, str) or not value.strip():
        raise InputError("must be a key of the case", value=value)
    return value


_NUMBER = {"type": ["number", "string"]}
_PARAMETER_SCHEMA = {
    "anyOf": [
        {"type": "array", "items": {"type": ["number", "string", "boolean"]}, "minItems": 1},
        {
            "type": "object",
            "properties": {"values": {"type": "array", "minItems": 1}},
            "required": ["values"],
            "additionalProperties": False,
        },
        {
            "type": "object",
            "properties": {
                "from": _NUMBER,
                "to": _NUMBER,
                "count": {"type": "integer", "minimum": 1},
                "spacing": {"enum": ["linear", "log"]},
            },
            "required": ["from", "to"],
            "additionalProperties": False,
        },
        {
            "type": "object",
            "properties": {"distribution": {"type": "string"}},
            "required": ["distribution"],
            "additionalProperties": _NUMBER,
        },
    ]
}

_Key = Annotated[str, Plain(_read_key, {"type": "string"})]
_Parameter = Annotated[Any, Plain(_read_parameter, _PARAMETER_SCHEMA)]


class SamplingTable(Table):
    """How values of several parameters are put together to runs."""

    method: Annotated[str, choice(*SAMPLINGS)] = Field(
        default="grid",
        description="Each value with each of the others (grid), the n-th values together "
        "(list), so, too, but up and then down, each run from the state in which the one before "
        "it ended (continuation), samples that are drawn, for Sobol's indices among them "
        "(saltelli), each parameter low and high while the others are in their middle "
        "(one_at_a_time), or a search for the values that make an output largest (worst_case)",
    )
    count: Count | None = Field(
        default=None,
        description="How many samples are drawn; a power of two for sobol and saltelli, which "
        "makes count times (2 + parameters) runs; for worst_case the most runs",
    )
    seed: CountFromZero = Field(
        default=0,
        description="Another seed draws other samples or searches on other ways, the same one the "
        "same",
    )
    share: PositiveNumber | None = Field(
        default=None,
        description="For one_at_a_time: low is the value below which this share of a parameter "
        "lies, high the one above which as much lies; 0.05 where left out",
    )
    of: Name | None = Field(
        default=None,
        description="For worst_case: the output that is made largest; the only one where left out",
    )


class StudyOutputTable(Table):
    """What is kept of each run: a number, or numbers at given instants."""

    quantity: Annotated[str, choice(*OUTPUT_QUANTITIES)] = Field(description="What to keep")
    node: Node | None = Field(default=None, description="Of which node or point, for a motion")
    dof: OneDof | None = Field(default=None, description="Along or about which axis, for a motion")
    mode: Count | None = Field(default=None, description="Of which mode, counted from 1")
    stop: Name | None = Field(default=None, description="Of which stop")
    gauge: Name | None = Field(default=None, description="Of which gauge")
    term: Name | None = Field(default=None, description="Which term of the energy ledger")
    impact: Count | None = Field(default=None, description="Of which impact, counted from 1")
    statistic: Annotated[str, choice(*OUTPUT_STATISTICS)] | None = Field(
        default=None, description="Of a quantity of time over the run, or of all impacts of a stop"
    )
    times: Times | None = Field(
        default=None, description="Instead of a statistic: the instants, in s, to keep it at"
    )
    latest: Count | None = Field(
        default=None,
        description="Instead of a statistic: of how many impacts, the last of the run, to keep it",
    )


class BasinsTable(Table):
    """Which attractor each run ends on: basins of attraction."""

    node: Node = Field(description="Whose displacement and velocity tell attractors apart")
    dof: OneDof = Field(description="Along or about which axis")
    period: PositiveTime = Field(description="Of the load, in s")
    most: Count = Field(
        default=8,
        description="Largest number of periods after which a motion may come back; twice as many "
        "at the end of each run are looked at",
    )
    tolerance: PositiveNumber = Field(
        default=1e-3,
        description="Points nearer than this, relative to the largest of all, are the same",
    )


class ExecutionTable(Table):
    """How the runs are made; nothing of it changes the results."""

    workers: Count | None = Field(
        default=None, description="How many processes; as many as there are cores where left out"
    )
    chunk: Count | None = Field(
        default=None,
        description="Runs that are made and written together: the most that a killed process "
        "loses; a 64th of all where left out, and 1024 at most",
    )
    store: Text | None = Field(
        default=None,
        description="Folder of the results, a zarr store beside the study file; named after it "
        "where left out",
    )


class StudyFile(Table):
    """A study: a case, what varies in it, and what is kept of each run."""

    title: Text = Field(default="", description="What the study is, in one line")
    case: Text = Field(description="The case file, beside this one")
    variant: Name | None = Field(
        default=None, description="Which variant of the case; needed where it has several"
    )
    parameters: dict[_Key, _Parameter] = Field(
        description='What varies: keys of the case by dotted name in quotes, "stops.guide.gap"'
    )
    sampling: SamplingTable | None = Field(
        default=None, description="How values are put together; a grid where left out"
    )
    outputs: dict[Name, StudyOutputTable] = Field(
        default={}, description="What is kept of each run, by a name of your own"
    )
    basins: BasinsTable | None = Field(
        default=None, description="Tell which attractor each run ends on"
    )
    execution: ExecutionTable | None = Field(default=None, description="How the runs are made")
