"""``[matrices]``."""

from bumpstop.io.case.fields.quantities import Force, PositiveLength, PositiveNumber
from bumpstop.io.case.fields.words import Text
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["MatricesTable"]


class MatricesTable(Table):
    """Matrices of another program, instead of nodes and beams.

    Paths are relative to the case file. A file with several matrices needs the name of one:
    ``"model.op4#KAA"``.
    """

    stiffness: Text = Field(description="File: .mtx, .npz, .npy, .op4, .pch, .bdf, .dat, .nas")
    mass: Text = Field(description="File, as for the stiffness")
    damping: Text | None = Field(default=None, description="File; no damping where left out")
    gyroscopic: Text | None = Field(
        default=None, description="File of a skew-symmetric matrix of velocities"
    )
    circulatory: Text | None = Field(
        default=None, description="File of a skew-symmetric matrix of displacements"
    )
    dofs: Text | None = Field(
        default=None,
        description="Dof map, a .csv file: node, dof, x, y, z, fixed; needed where the matrices "
        "do not name their rows",
    )
    length: PositiveLength = Field(
        default=1.0, description='Unit of length in the files, such as "1 mm"'
    )
    force: Force = Field(
        default=1.0,
        description="Unit of force in the files; time is in s, and mass in what follows: t for "
        "mm and N",
    )
    accuracy: PositiveNumber | None = Field(
        default=None,
        description="How exact the entries are, relative to the diagonal: asymmetry and "
        "resistance to rigid motions up to this are rounding; 1e-13 where left out, say 1e-9 "
        "for files with ten digits",
    )
