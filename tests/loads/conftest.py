import pytest

import bumpstop as bs

from ..hinged_beam import hinged_modes


@pytest.fixture(scope="module")
def hinged() -> bs.ModalBasis:
    """The beam of SDNL32: hinged at A, free at B, bending in the plane xy."""
    return hinged_modes()
