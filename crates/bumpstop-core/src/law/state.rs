//! States of a law, and the local motion that decides between them.

use super::{COORDINATES, Local};

/// A state of a law, by its number in the law's own list, with what it remembers.
///
/// Two states of one number have the same stiffness and damping matrices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// Which of the law's states it is.
    pub number: u8,
    /// Which part of its obstacle it is at; 0 for laws without parts.
    pub part: u16,
    /// Internal variables, such as the anchor of a friction spring; zero for laws without.
    pub memory: [f64; 2],
}

impl State {
    /// The first of a law's list; what has not been touched yet is in it.
    pub const FIRST: Self = Self::plain(0);

    /// A state without memory.
    pub const fn plain(number: u8) -> Self {
        Self::with_memory(number, [0.0; 2])
    }

    /// A state with its internal variables.
    pub const fn with_memory(number: u8, memory: [f64; 2]) -> Self {
        Self {
            number,
            part: 0,
            memory,
        }
    }
}

/// Local coordinates and their first three time derivatives at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LocalMotion {
    /// The n-th derivatives of all coordinates.
    pub derivatives: [Local<f64>; 4],
    /// Sizes below which the n-th derivatives count as zero.
    pub zero: [f64; 4],
}

impl LocalMotion {
    /// A motion of which only position and velocity are known, to the last digit.
    pub fn of(position: Local<f64>, velocity: Local<f64>) -> Self {
        let still = [0.0; COORDINATES];
        Self {
            derivatives: [position, velocity, still, still],
            zero: [0.0; 4],
        }
    }

    /// Position.
    pub fn position(&self) -> &Local<f64> {
        &self.derivatives[0]
    }

    /// Velocity.
    pub fn velocity(&self) -> &Local<f64> {
        &self.derivatives[1]
    }

    /// Adds to the derivatives of a coordinate, and to the sizes that count as zero.
    pub(crate) fn add(&mut self, coordinate: usize, derivatives: [f64; 4], zero: [f64; 4]) {
        debug_assert!(coordinate < COORDINATES);
        for order in 0..4 {
            self.derivatives[order][coordinate] += derivatives[order];
            self.zero[order] += zero[order];
        }
    }
}
