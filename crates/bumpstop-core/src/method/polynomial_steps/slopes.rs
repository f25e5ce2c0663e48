//! How the force of a law answers to its motion.

use crate::law::{COORDINATES, Law, Local, Piece, State};
use crate::number::Dual;

/// Derivatives of a law's forces with respect to its positions and velocities.
pub(crate) fn slopes<L: Law>(
    law: &L,
    state: State,
    motion: [Local<f64>; 2],
) -> [[Local<f64>; COORDINATES]; 2] {
    let mut slopes = [[[0.0; COORDINATES]; COORDINATES]; 2];
    if law.piece(state) == Some(Piece::FREE) {
        return slopes;
    }
    for (order, slopes) in slopes.iter_mut().enumerate() {
        for c in 0..law.rows().len() {
            let mut dual = motion.map(|local| local.map(|value| Dual { value, slope: 0.0 }));
            dual[order][c].slope = 1.0;
            let force = law.force(state, &dual[0], &dual[1]);
            for (row, force) in slopes.iter_mut().zip(force) {
                row[c] = force.slope;
            }
        }
    }
    slopes
}
