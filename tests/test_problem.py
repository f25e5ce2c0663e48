from typing import Any

import numpy as np
import pytest

from bumpstop import (
    Gauge,
    Gravity,
    InputError,
    ModalBasis,
    ModalState,
    NodalForce,
    Problem,
    RigidRotation,
    Stop,
)
from bumpstop.canonical import canonical_form


def basis() -> ModalBasis:
    return ModalBasis.from_modes(
        frequency=[3.0, 7.5], damping=0.01, shapes={("P", "dx"): [1.0, 0.4]}
    )


def stop(name: str = "guide", node: str = "P") -> Stop:
    return Stop(name, node=node, normal=(-1, 0, 0), gap=1e-3, stiffness=1e6)


def test_lists_become_tuples() -> None:
    problem = Problem(basis(), laws=[stop()], outputs=[["P", "dx"]], duration=1.0)  # type: ignore[list-item]  # as read from a file
    assert isinstance(problem.laws, tuple)
    assert problem.outputs == (("P", "dx"),)


@pytest.mark.parametrize(
    ("changes", "key", "what"),
    [
        ({"duration": 0.0}, "duration", "must be positive"),
        ({"duration": float("inf")}, "duration", "must be finite"),
        ({"duration": "1 s"}, "duration", "must be a number"),
        ({"sample": 0.0}, "sample", "must be positive"),
        ({"sample": 1.1}, "sample", "must not exceed the duration"),
        ({"sample": 1e-10}, "sample", "more than 1,000,000,000 samples.*take at least 1e-09 s"),
        ({"laws": stop()}, "laws", "must be a list"),
        ({"laws": ["guide"]}, "laws", "must hold Laws only"),
        ({"laws": [stop(), stop()]}, "laws", "'guide'"),
        ({"laws": [stop(node="Q")]}, "stops.guide.node", "'Q'"),
        ({"loads": [stop()]}, "loads", "must hold Loads only"),
        ({"loads": [NodalForce("push", node="Q", force=(1, 0, 0))]}, "loads.push.node", "'Q'"),
        (
            {"loads": [Gravity("weight", acceleration=(0, 0, -9.81))]},
            "loads.weight.acceleration",
            "needs the masses",
        ),
        ({"gauges": [Gauge("g", beam="AB", at=0.1, fibre=(0, 0))]}, "gauges.g", "structure"),
        ({"gauges": ["g"]}, "gauges", "must hold Gauges only"),
        ({"initial": ModalState(velocity=[1.0])}, "initial.velocity", "each of the 2 modes"),
        ({"initial": RigidRotation(about="P", rate=(0, 0, 1))}, "initial.rate", "structure"),
        ({"initial": [0.0, 1.0]}, "initial", "must be an initial state"),
        ({"outputs": [("P", "dx", "dy")]}, "outputs", "pairs of a node and a dof"),
        ({"outputs": [("P", "dz")]}, "outputs[0].dof", "'dz'"),
    ],
)
def test_refuses(changes: dict[str, Any], key: str, what: str) -> None:
    given: dict[str, Any] = {"laws": [stop()], "duration": 1.0}
    with pytest.raises(InputError, match=what) as caught:
        Problem(basis(), **(given | changes))
    assert caught.value.key == key
    assert "\n" not in str(caught.value)


def test_the_basis_must_be_one() -> None:
    with pytest.raises(InputError, match="basis: must be a ModalBasis"):
        Problem([3.0, 7.5], duration=1.0)  # type: ignore[arg-type]  # what is tested


@pytest.mark.parametrize("sample", [1e-5, 1e-4, 3e-4, 0.1 / 3, 0.1, None])
@pytest.mark.parametrize("duration", [0.1, 0.3, 0.02 / 3])
def test_sample_grid(duration: Any, sample: Any) -> None:
    if sample is not None and sample > duration:
        pytest.skip("refused")
    times = Problem(basis(), duration=duration, sample=sample).times
    interval = duration / 1000 if sample is None else sample
    steps = np.diff(times)
    assert times[0] == 0.0
    assert times[-1] == duration
    assert times[1] == min(interval, duration)
    np.testing.assert_allclose(steps[:-1], interval, rtol=1e-9)
    assert 0.0 < steps[-1] <= interval * (1.0 + 1e-9)


def test_default_grid_has_a_thousand_intervals() -> None:
    assert len(Problem(basis(), duration=0.7).times) == 1001


def test_canonical_form_adds_up_loads() -> None:
    push = [NodalForce(name, node="P", force=(2.0, 0, 0)) for name in ("one", "two")]
    form = canonical_form(Problem(basis(), loads=push, duration=1.0))
    assert form.forcing.at(0.3).tolist() == [4.0, 1.6]
    assert form.displacement.tolist() == form.velocity.tolist() == [0.0, 0.0]


def test_canonical_form_takes_the_state_as_it_is() -> None:
    state = ModalState(displacement=[0.1, 0.2], velocity=[0.3, 0.4])
    form = canonical_form(Problem(basis(), initial=state, duration=1.0))
    assert form.displacement.tolist() == [0.1, 0.2]
    assert form.velocity.tolist() == [0.3, 0.4]
