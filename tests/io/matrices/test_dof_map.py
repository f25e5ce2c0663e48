from __future__ import annotations

from pathlib import Path

import pytest

from bumpstop import InputError
from bumpstop.io.matrices.dof_map import DofMap, read_dof_map, write_dof_map


def read(tmp_path: Path, text: str) -> DofMap:
    file = tmp_path / "dofs.csv"
    file.write_text(text)
    return read_dof_map(file)


def test_what_is_written_is_read(tmp_path: Path) -> None:
    dof_map = DofMap(
        dofs=(("P", "dx"), ("Q, the other", "drz"), ("P", "dy"), ('"R"', "dx")),
        positions={"P": (0.1, -2e-7, 1 / 3), "Q, the other": (1.0, 2.0, 3.0)},
        fixed=(("P", "dy"),),
    )
    write_dof_map(tmp_path / "dofs.csv", dof_map)
    assert read_dof_map(tmp_path / "dofs.csv") == dof_map


def test_columns_in_any_order_and_dofs_by_number(tmp_path: Path) -> None:
    dof_map = read(tmp_path, "# by hand\ndof; node ;y\n2;P;1.5\n\nDRX;P;1.5\n")
    assert dof_map.dofs == (("P", "dy"), ("P", "drx"))
    assert dof_map.positions == {"P": (0.0, 1.5, 0.0)}


REFUSED = {
    "": "is empty",
    "# nothing\n": "is empty",
    "node,dof\n": "holds no dof",
    "node,x\nP,1\n": "has no column 'dof'",
    "P,dx\n": "has no column 'node'",
    "node,dof,colour\nP,dx,red\n": "unknown column",
    "node,dof\nP\n": "line 2: has 1 fields instead of 2",
    "node,dof\nP,ux\n": "line 2: unknown dof .got 'ux'.",
    "node,dof\nP,7\n": "line 2: unknown dof",
    "node,dof\n,dx\n": "line 2: a node must have a name",
    "node,dof\nP,dx\nQ,dx\nP,1\n": "line 4: this dof is there twice .got 'P.dx'.",
    "node,dof,x\nP,dx,one\n": "line 2: x must be a number",
    "node,dof,x\nP,dx,nan\n": "line 2: x must be a number",
    "node,dof,x\nP,dx,1\nP,dy,2\n": "line 3: node 'P' is at another place than before",
    "node,dof,fixed\nP,dx,yes\n": "line 2: fixed must be 1 or 0",
    "\0\0": "is a binary file",
}


@pytest.mark.parametrize(("text", "message"), REFUSED.items(), ids=list(REFUSED.values()))
def test_what_is_wrong_is_said_in_one_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=rf"dofs\.csv: .*{message}"):
        read(tmp_path, text)
