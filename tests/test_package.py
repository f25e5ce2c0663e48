from __future__ import annotations

import subprocess
import sys
from types import FunctionType, ModuleType

import pytest

import bumpstop as bs


@pytest.mark.parametrize("name", bs.__all__)
def test_every_public_name_is_there(name: str) -> None:
    assert getattr(bs, name).__name__ == name
    assert name in dir(bs)


def test_names_are_listed_once() -> None:
    names = dir(bs)
    assert len(names) == len(set(names))


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="has no attribute 'Sprung'"):
        bs.Sprung  # noqa: B018  # reading it is the test


def test_simulate_stays_the_function_though_a_module_has_its_name() -> None:
    import bumpstop.simulate  # noqa: F401  # binding the module is what must not happen

    assert isinstance(bs.simulate, FunctionType)
    assert isinstance(sys.modules["bumpstop.simulate"], ModuleType)


def test_import_alone_loads_nothing_heavy() -> None:
    code = "import bumpstop, sys; print({'numpy', 'pydantic', 'h5py'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"
