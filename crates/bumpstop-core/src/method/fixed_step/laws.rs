//! What laws do within a step: their forces, and how these move each other's coordinates.

use crate::law::{COORDINATES, Law, Local, State};

/// The force of a law, which goes on to the state that it sees now.
#[inline(always)]
pub(crate) fn law_force<P: Law>(
    law: &P,
    state: &mut State,
    position: &Local<f64>,
    velocity: &Local<f64>,
) -> Local<f64> {
    let now = law.sampled_state(*state, position, velocity);
    // Part by part: a state copied as a whole takes its padding along, and that through memory,
    // in pieces for whose storing the next step would have to wait.
    (state.number, state.memory) = (now.number, now.memory);
    law.force(now, position, velocity)
}

/// How forces along one law's coordinates move another's: `sum_i a_i gain_i b_i` for its rows a
/// and b, zero beyond them.
pub(crate) type Coupling = [Local<f64>; COORDINATES];

/// How the second law's forces move the first's coordinates.
pub(crate) fn coupling<L: Law>(moved: &L, pushing: &L, gain: &[f64]) -> Coupling {
    let mut coupling = [[0.0; COORDINATES]; COORDINATES];
    for (to, a) in coupling.iter_mut().zip(moved.rows()) {
        for (to, b) in to.iter_mut().zip(pushing.rows()) {
            *to = a.iter().zip(b).zip(gain).map(|((a, b), g)| a * g * b).sum();
        }
    }
    coupling
}

/// Where one coordinate goes under all forces together, from where it would go without them.
#[inline(always)]
pub(crate) fn pushed<L: Law>(
    laws: &[&L],
    couplings: &[Coupling],
    coordinate: usize,
    forces: &[Local<f64>],
    free: f64,
) -> f64 {
    let mut total = free;
    for ((law, force), coupling) in laws.iter().zip(forces).zip(couplings) {
        for c in 0..law.rows().len() {
            total = force[c].mul_add(coupling[coordinate][c], total);
        }
    }
    total
}
