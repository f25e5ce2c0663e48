"""Section forces, stresses and reactions against closed forms; equilibrium of every node."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import bumpstop as bs
from bumpstop.structure.dofs import DOFS

YOUNG, LENGTH, SIDE = 210e9, 2.0, 0.02
STEEL = bs.Material(young_modulus=YOUNG, poisson_ratio=0.3, density=7800.0)
BAR = bs.Rectangle(height=SIDE, width=0.5 * SIDE)
CLAMP = bs.Support(nodes="A", fixed=DOFS)
NODES = {"A": (0.0, 0.0, 0.0), "B": (LENGTH, 0.0, 0.0)}


def cantilever() -> bs.Structure:
    beam = bs.Beam("AB", nodes=("A", "B"), elements=5, material=STEEL, section=BAR)
    return bs.Structure(nodes=NODES, beams=[beam], supports=[CLAMP])


def at_rest(structure: bs.Structure, modes: int, *loads: bs.NodalForce) -> bs.Response:
    """The end of a run that damping has brought to rest."""
    basis = bs.ModalBasis.from_structure(structure, modes=modes, damping=0.8)
    run = bs.simulate(bs.Problem(basis, loads=list(loads), duration=20.0))
    return run.at([20.0])


@pytest.fixture(scope="module")
def run() -> bs.Response:
    load = bs.NodalForce("end", node="B", force=(7.0, -3.0, 5.0), moment=(0.4, 0.9, -0.6))
    return at_rest(cantilever(), 1, load)


class TestStatic:
    @pytest.mark.parametrize("at", [0.0, 0.37, 1.2, 2.0])
    def test_section_forces(self, run: bs.Response, at: float) -> None:
        found = bs.recovery(run).section_forces("AB", at)
        arm = LENGTH - at
        expected = {
            "N": 7.0,
            "Vy": -3.0,
            "Vz": 5.0,
            "T": 0.4,
            "My": 0.9 - 5.0 * arm,
            "Mz": -0.6 - 3.0 * arm,
        }
        for name, value in expected.items():
            assert found[name].values[0] == pytest.approx(value, rel=1e-8, abs=1e-8), name
        assert found["My"].attrs["units"] == "N m"

    def test_several_sections(self, run: bs.Response) -> None:
        found = bs.recovery(run).section_forces("AB", [0.0, 1.0])
        assert found["Mz"].dims == ("time", "at")
        assert_allclose(found["Mz"].values, [[-6.6, -3.6]], rtol=1e-8)

    def test_stress(self, run: bs.Response) -> None:
        y, z = -0.006, 0.004
        found = bs.recovery(run).stress("AB", 0.5, (y, z))
        my, mz = 0.9 - 5.0 * 1.5, -0.6 - 3.0 * 1.5
        expected = 7.0 / BAR.area - y * mz / BAR.inertia_z + z * my / BAR.inertia_y
        assert found.values[0] == pytest.approx(expected, rel=1e-8)
        strain = bs.recovery(run).strain("AB", 0.5, (y, z))
        assert strain.values[0] == pytest.approx(expected / YOUNG, rel=1e-8)

    def test_reactions(self, run: bs.Response) -> None:
        found = bs.recovery(run).reactions("A")
        expected = (-7.0, 3.0, -5.0, -0.4, -0.9 + 5.0 * LENGTH, 0.6 + 3.0 * LENGTH)
        assert_allclose([found[dof].values[0] for dof in DOFS], expected, rtol=1e-8)
        assert found["drx"].attrs["units"] == "N m"

    def test_displacement_under_the_force(self, run: bs.Response) -> None:
        stretch = bs.recovery(run).displacement("B", "dx")
        assert stretch.values[0] == pytest.approx(7.0 * LENGTH / (YOUNG * BAR.area), rel=1e-9)

    def test_one_mode_alone_is_far_off(self, run: bs.Response) -> None:
        bare = bs.recovery(run, static_correction=False).section_forces("AB", 0.0)
        assert abs(bare["Vy"].values[0] + 3.0) > 0.1


def test_a_tapered_beam() -> None:
    beam = bs.Beam(
        "AB",
        nodes=("A", "B"),
        elements=3,
        material=STEEL,
        section=BAR,
        end_section=bs.Rectangle(height=0.5 * SIDE, width=0.4 * SIDE),
    )
    structure = bs.Structure(nodes=NODES, beams=[beam], supports=[CLAMP])
    run = at_rest(structure, 2, bs.NodalForce("end", node="B", force=(0.0, 0.0, 4.0)))
    found = bs.recovery(run).section_forces("AB", [0.3, 1.9])
    assert_allclose(found["My"].values[0], [-4.0 * 1.7, -4.0 * 0.1], rtol=1e-7)
    assert_allclose(found["Vz"].values[0], 4.0, rtol=1e-7)


def test_axes_are_local() -> None:
    """The same cantilever along the global Z."""
    beam = bs.Beam("AB", nodes=("A", "B"), elements=2, material=STEEL, section=BAR)
    nodes = {"A": (0, 0, 0), "B": (0, 0, LENGTH)}
    structure = bs.Structure(nodes=nodes, beams=[beam], supports=[CLAMP])
    run = at_rest(structure, 2, bs.NodalForce("end", node="B", force=(0.0, 6.0, -9.0)))
    found = bs.recovery(run).section_forces("AB", 0.0)
    assert found["N"].values[0] == pytest.approx(-9.0, rel=1e-8)
    assert found["Vy"].values[0] == pytest.approx(6.0, rel=1e-8)
    assert found["Mz"].values[0] == pytest.approx(6.0 * LENGTH, rel=1e-8)


def test_a_mass_on_a_light_cantilever_springs_up() -> None:
    """Under a sudden force the moment at the root is F L (1 - cos w t)."""
    light = bs.Material(young_modulus=YOUNG, poisson_ratio=0.3, density=1e-9)
    weight = bs.PointMass("tip", node="B", mass=3.0)
    beam = bs.Beam(
        "AB", nodes=("A", "B"), elements=2, material=light, section=BAR, theory="euler_bernoulli"
    )
    structure = bs.Structure(nodes=NODES, beams=[beam], masses=[weight], supports=[CLAMP])
    basis = bs.ModalBasis.from_structure(structure, modes=3)
    push = bs.NodalForce("push", node="B", force=(0.0, 8.0, 0.0))
    run = bs.simulate(bs.Problem(basis, loads=[push], duration=2.0))
    omega = math.sqrt(3.0 * YOUNG * BAR.inertia_z / LENGTH**3 / 3.0)
    swing = 1.0 - np.cos(omega * run.times)
    found = bs.recovery(run)
    moment = found.section_forces("AB", 0.0)["Mz"]
    assert_allclose(moment, 8.0 * LENGTH * swing, rtol=0, atol=1e-6 * 16.0)
    stress = found.stress("AB", 0.0, (-0.01, 0.0))
    largest = 16.0 * 0.01 / BAR.inertia_z
    assert_allclose(stress, largest * swing, rtol=0, atol=1e-6 * largest)
    assert_allclose(found.reactions("A")["dy"], -8.0 * swing, rtol=0, atol=1e-6 * 8.0)
    assert_allclose(found.reactions("A")["drz"], -16.0 * swing, rtol=0, atol=1e-6 * 16.0)


def test_a_swinging_cantilever_has_the_moment_of_its_mode() -> None:
    """In its first mode M = E I w (b/L)2 ... at the root, b = 1.875104 (Euler-Bernoulli)."""
    beam = bs.Beam(
        "AB", nodes=("A", "B"), elements=600, material=STEEL, section=BAR, theory="euler_bernoulli"
    )
    plane = bs.Support(nodes="all", fixed=("dx", "dz", "drx", "dry"))
    structure = bs.Structure(nodes=NODES, beams=[beam], supports=[plane, CLAMP])
    basis = bs.ModalBasis.from_structure(structure, modes=1)
    tip = float(basis.row("B", "dy")[0])
    start = bs.ModalState(displacement=[1e-3 / tip])
    run = bs.simulate(bs.Problem(basis, initial=start, duration=0.1))
    # The mode cosh - cos - s (sinh - sin) is 2 at the tip, its curvature 2 (b/L)2 at the root.
    beta = 1.8751040687119611 / LENGTH
    omega = beta**2 * math.sqrt(YOUNG * BAR.inertia_z / (STEEL.density * BAR.area))
    moment = YOUNG * BAR.inertia_z * beta**2 * 1e-3 * np.cos(omega * run.times)
    found = bs.recovery(run).section_forces("AB", 0.0)["Mz"]
    # Forces by stiffness times displacements err by (b h / L)2 / 12, 8e-7 with 600 elements.
    assert_allclose(found, moment, rtol=0, atol=1e-6 * abs(moment[0]))


def rattling() -> bs.Response:
    """A frame with all that there is: springs, a damper, gravity, contact, friction, a shaker."""
    beam = bs.Beam("AB", nodes=("A", "B"), elements=6, material=STEEL, section=BAR)
    post = bs.Beam("BC", nodes=("B", "C"), elements=3, material=STEEL, section=BAR)
    structure = bs.Structure(
        nodes=NODES | {"C": (LENGTH, 0.0, 0.7)},
        beams=[beam, post],
        masses=[bs.PointMass("head", node="C", mass=0.8, inertia=(1e-3, 1e-3, 1e-3))],
        springs=[
            bs.Spring(
                "ground", node="C", stiffness=(900.0, 0, 0, 0, 0, 0), damping=(3.0,) + 5 * (0,)
            )
        ],
        supports=[CLAMP, bs.Support(nodes="C", fixed=("dz",))],
    )
    basis = bs.ModalBasis.from_structure(
        structure, modes=7, damping=0.02, static_shapes=[("AB@1.0", "dy")]
    )
    return bs.simulate(
        bs.Problem(
            basis,
            laws=[
                bs.Stop(
                    "side",
                    node="C",
                    normal=(0, 1, 0),
                    gap=2e-4,
                    stiffness=3e4,
                    damping=4.0,
                    friction=0.3,
                    sliding=(1, 0, 0),
                    tangential_stiffness=2e4,
                ),
                bs.SpringLaw(
                    "pad",
                    node="AB@1.0",
                    direction=(0, 1, 0),
                    stiffness=(800.0, 4000.0),
                    breaks=(1e-4,),
                ),
            ],
            loads=[
                bs.Gravity("weight", acceleration=(0.0, -9.81, -2.0)),
                bs.NodalForce("shaker", node="C", force=(5, 9, 0), time=bs.Harmonic(7.0, sine=1.0)),
                bs.NodalForce("pull", node="AB@0.5", force=(0, 3, 3), moment=(0.1, 0, 0)),
            ],
            duration=0.4,
            sample=1e-3,
        )
    )


@pytest.fixture(scope="module")
def frame() -> bs.Response:
    return rattling()


def test_every_node_is_in_equilibrium(frame: bs.Response) -> None:
    assert frame.impacts["impulse"].sum() > 0.1  # else the contact is not tested
    assert np.abs(frame.sample("friction_force", "side")).max() > 0.1
    found = bs.recovery(frame)
    model = found.forces.model
    lacking = found.lacking(frame.times)
    # Rounding of the elastic forces, which are the largest terms of the sums.
    sizes = model.stiffness.magnitudes() @ np.abs(found.field(frame.times))
    free = model.free
    assert (np.abs(lacking[free]) / sizes.max()).max() < 1e-12
    held = np.setdiff1d(np.arange(len(model.dofs)), free)
    assert np.abs(lacking[held]).max() > 1.0


def test_forces_add_up(frame: bs.Response) -> None:
    found = bs.recovery(frame).resultants()
    largest = max(float(np.abs(found[name]).max()) for name in found if name != "residual")
    assert float(np.abs(found["residual"]).max()) < 1e-9 * largest
    by_nodes = sum(bs.recovery(frame).reactions(node)["dz"].values for node in ("A", "C"))
    assert_allclose(found["reaction"].sel(dof="dz"), by_nodes, rtol=1e-9)
    contact = frame.sample("stop_force", "side") + frame.sample("stop_force", "pad")
    assert_allclose(np.abs(found["law"].sel(dof="dy")), np.abs(contact), rtol=1e-9, atol=1e-9)


def test_without_correction_they_do_not(frame: bs.Response) -> None:
    bare = bs.recovery(frame, static_correction=False).resultants()
    assert float(np.abs(bare["residual"]).max()) > 1e-3


def test_a_gauge_reads_the_strain_of_the_section_forces(frame: bs.Response) -> None:
    found = bs.recovery(frame)
    forces = found.section_forces("AB", 0.44)
    y, z = 0.008, -0.003
    strain = (
        forces["N"] / (YOUNG * BAR.area)
        - y * forces["Mz"] / (YOUNG * BAR.inertia_z)
        + z * forces["My"] / (YOUNG * BAR.inertia_y)
    )
    gauge = found.strain("AB", 0.44, (y, z))
    assert_allclose(gauge, strain, rtol=0, atol=1e-11 * float(np.abs(gauge).max()))


def test_motions_of_a_spinning_shaft_balance() -> None:
    shaft = bs.Beam(
        "AB",
        nodes=("A", "B"),
        elements=4,
        material=STEEL,
        section=bs.Circle(radius=0.01),
        spin=300.0,
    )
    ends = bs.Support(nodes=("A", "B"), fixed=("dx", "dy", "dz", "drx"))
    structure = bs.Structure(nodes=NODES, beams=[shaft], supports=[ends])
    basis = bs.ModalBasis.from_structure(structure, modes=4, damping=0.01)
    wall = bs.Stop("wall", node="AB@1.0", normal=(0, -1, 0), gap=1e-3, stiffness=1e4)
    push = bs.NodalForce("push", node="AB@0.7", force=(0, 20.0, 5.0))
    run = bs.simulate(bs.Problem(basis, laws=[wall], loads=[push], duration=0.3))
    found = bs.recovery(run).resultants()
    largest = float(np.abs(found["load"]).max())
    assert float(np.abs(found["residual"]).max()) < 1e-9 * largest


def between_supports(motion: bs.SupportMotion, duration: float) -> bs.Response:
    """A beam clamped at both ends, one of which moves sideways."""
    ends = bs.Support(nodes=("A", "B"), fixed=DOFS)
    beam = bs.Beam("AB", nodes=("A", "B"), elements=4, material=STEEL, section=BAR)
    structure = bs.Structure(nodes=NODES, beams=[beam], supports=[ends])
    basis = bs.ModalBasis.from_structure(structure, modes=2, damping=0.02)
    stop = bs.Stop("stop", node="AB@1.0", normal=(0, -1, 0), gap=2e-3, stiffness=1e4)
    return bs.simulate(bs.Problem(basis, laws=[stop], loads=[motion], duration=duration))


def test_supports_that_move_apart_bend_the_beam() -> None:
    """Slowly, by d: the moments at the ends are 6 E I d / L2, the shear force 12 E I d / L3."""
    slow = bs.Harmonic(0.002, sine=1.0)
    motion = bs.SupportMotion("end", nodes="B", displacement=(0, 1e-3, 0), time=slow)
    run = between_supports(motion, 125.0).at([125.0])
    phi = 12.0 * YOUNG * BAR.inertia_z
    phi /= STEEL.shear_modulus * BAR.area * BAR.shear_factors[0] * LENGTH**2
    moment = 6.0 * YOUNG * BAR.inertia_z * 1e-3 / LENGTH**2 / (1.0 + phi)
    found = bs.recovery(run)
    assert found.section_forces("AB", 0.0)["Mz"].values[0] == pytest.approx(moment, rel=1e-6)
    assert found.reactions("B")["dy"].values[0] == pytest.approx(2.0 * moment / LENGTH, rel=1e-6)
    assert found.displacement("B", "dy").values[0] == pytest.approx(1e-3, rel=1e-12)


def test_supports_that_shake_are_in_equilibrium() -> None:
    shaken = bs.Harmonic(9.0, sine=1.0)
    motion = bs.SupportMotion("end", nodes="B", displacement=(0, 4e-3, 0), time=shaken)
    run = between_supports(motion, 0.5)
    assert len(run.impacts) > 2
    found = bs.recovery(run)
    free = found.forces.model.free
    lacking = found.lacking(run.times)
    assert np.abs(lacking[free]).max() < 1e-9 * np.abs(lacking).max()


def test_joined_parts_have_the_forces_of_the_whole() -> None:
    """Two halves of a cantilever, the second turned end for end, against the whole."""
    half = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0)},
        beams=[bs.Beam("AB", nodes=("A", "B"), elements=3, material=STEEL, section=BAR)],
    )
    ends = ["A", "B"]
    reduced = bs.craig_bampton(bs.Component(half, interface=ends), modes=4)
    turned = bs.Rotation(axis=(0, 0, 1), angle=math.pi)
    parts = {"root": bs.Placed(reduced), "tip": bs.Placed(reduced, at=(2, 0, 0), rotation=turned)}
    joined = bs.Assembly(
        parts=parts,
        joints=[("root.B", "tip.B")],
        supports=[bs.Support(nodes="root.A", fixed=DOFS)],
    )
    basis = bs.ModalBasis.from_structure(joined, modes=2, damping=0.8)
    load = bs.NodalForce("end", node="tip.A", force=(7.0, -3.0, 5.0), moment=(0.4, 0.9, -0.6))
    run = bs.simulate(bs.Problem(basis, loads=[load], duration=20.0)).at([20.0])
    found = bs.recovery(run)
    root = found.section_forces("root.AB", 0.25)
    assert root["Mz"].values[0] == pytest.approx(-0.6 - 3.0 * 1.75, rel=1e-7)
    assert root["N"].values[0] == pytest.approx(7.0, rel=1e-7)
    # Along the turned beam the part beyond a section is the one towards the root.
    tip = found.section_forces("tip.AB", 0.25)
    assert tip["N"].values[0] == pytest.approx(7.0, rel=1e-7)
    assert abs(tip["Mz"].values[0]) == pytest.approx(0.6 + 3.0 * 0.25, rel=1e-7)
    stress = found.stress("root.AB", 0.25, (0.01, 0.0))
    expected = 7.0 / BAR.area + 0.01 * (0.6 + 3.0 * 1.75) / BAR.inertia_z
    assert stress.values[0] == pytest.approx(expected, rel=1e-7)
    with pytest.raises(bs.InputError, match="joined parts"):
        found.reactions("root.A")


def test_needs_a_structure() -> None:
    basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    run = bs.simulate(bs.Problem(basis, duration=1.0))
    with pytest.raises(bs.InputError, match="masses of a structure"):
        bs.recovery(run)


def test_refuses(frame: bs.Response) -> None:
    found = bs.recovery(frame)
    with pytest.raises(bs.InputError, match="unknown beam"):
        found.section_forces("AX", 0.1)
    with pytest.raises(bs.InputError, match="must be on the beam"):
        found.section_forces("AB", 2.5)
    with pytest.raises(bs.InputError, match="those of nodes"):
        found.reactions("AB@0.3")
    with pytest.raises(bs.InputError, match="outside the section"):
        found.stress("AB", 0.1, (1.0, 0.0))
