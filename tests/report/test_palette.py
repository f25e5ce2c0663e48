"""Colours can be read, on paper and on a dark screen."""

import re
from itertools import pairwise

import numpy as np
import pytest

from bumpstop.arguments import FloatArray
from bumpstop.report.palette import DARK, LIGHT, style_rules

# G. M. Machado, M. M. Oliveira, L. A. F. Fernandes, "A physiologically-based model for
# simulation of color vision deficiency", 2009; severity 1, on linear RGB.
SIGHT = {
    "usual": np.eye(3),
    "protanopia": np.array(
        [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ]
    ),
    "deuteranopia": np.array(
        [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ]
    ),
    "tritanopia": np.array(
        [
            [1.255528, -0.076749, -0.178779],
            [-0.078411, 0.930809, 0.147602],
            [0.004733, 0.691367, 0.303900],
        ]
    ),
}
TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])


def linear(colour: str) -> FloatArray:
    channels = np.array([int(colour[i : i + 2], 16) / 255.0 for i in (1, 3, 5)])
    return np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)


def lab(rgb: FloatArray) -> FloatArray:
    """Return CIE L*a*b* of linear RGB."""
    ratio = (TO_XYZ @ rgb.clip(0.0, 1.0)) / TO_XYZ.sum(axis=1)
    f = np.where(ratio > 0.008856, np.cbrt(ratio), 7.787 * ratio + 16.0 / 116.0)
    return np.array([116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])])


def luminance(colour: str) -> float:
    """Return the relative luminance of WCAG 2.2."""
    return float(TO_XYZ[1] @ linear(colour))


def contrast(one: str, other: str) -> float:
    low, high = sorted([luminance(one), luminance(other)])
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=["light", "dark"])
def test_text_and_curves_stand_out(theme: dict[str, str]) -> None:
    assert contrast(theme["ink"], theme["paper"]) >= 12.0
    assert contrast(theme["muted"], theme["paper"]) >= 4.5
    assert contrast(theme["computed"], theme["paper"]) >= 4.5
    assert contrast(theme["contact"], theme["paper"]) >= 3.0


@pytest.mark.parametrize("sight", SIGHT)
@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=["light", "dark"])
def test_everyone_can_tell_the_energies_apart(theme: dict[str, str], sight: str) -> None:
    stack = [theme[role] for role in ("kinetic", "elastic", "stored", "damping", "stops")]
    for lower, upper in pairwise([*stack, theme["paper"]]):
        seen = [lab(SIGHT[sight] @ linear(colour)) for colour in (lower, upper)]
        assert np.linalg.norm(seen[0] - seen[1]) > 15.0, (lower, upper)


@pytest.mark.parametrize("sight", SIGHT)
@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=["light", "dark"])
def test_everyone_sees_when_a_stop_is_closed(theme: dict[str, str], sight: str) -> None:
    seen = [lab(SIGHT[sight] @ linear(theme[role])) for role in ("contact", "muted")]
    assert np.linalg.norm(seen[0] - seen[1]) > 15.0


def test_themes_have_the_same_roles_and_can_be_swapped() -> None:
    assert LIGHT.keys() == DARK.keys()
    swaps = {(LIGHT[role], DARK[role]) for role in LIGHT}
    assert len(swaps) == len({light for light, _ in swaps})


def test_every_role_is_a_variable_of_the_page() -> None:
    rules = style_rules()
    for role, colour in LIGHT.items():
        assert re.search(rf"--{role}: {colour};", rules)
