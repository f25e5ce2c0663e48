//! Affine functions of a law's local motion, and powers made of them.

use super::{COORDINATES, Local};
use crate::number::Number;

/// `constant + position . x + velocity . x' + acceleration . x''` of the local coordinates x.
///
/// Along a phase it is a sum of exponentials as the coordinates are, so that its zeros can be
/// certified and products of two of them be integrated in closed form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Affine {
    /// Value at the origin at rest.
    pub constant: f64,
    /// Factors of the local coordinates.
    pub position: Local<f64>,
    /// Factors of the local velocities.
    pub velocity: Local<f64>,
    /// Factors of the local accelerations.
    pub acceleration: Local<f64>,
}

impl Affine {
    /// The function that is zero.
    pub const ZERO: Self = Self {
        constant: 0.0,
        position: [0.0; COORDINATES],
        velocity: [0.0; COORDINATES],
        acceleration: [0.0; COORDINATES],
    };

    /// One local coordinate.
    pub const fn coordinate(number: usize) -> Self {
        let mut coordinate = Self::ZERO;
        coordinate.position[number] = 1.0;
        coordinate
    }

    /// The rate of one local coordinate.
    pub const fn rate(number: usize) -> Self {
        let mut rate = Self::ZERO;
        rate.velocity[number] = 1.0;
        rate
    }

    /// The same times a factor.
    pub fn times(&self, factor: f64) -> Self {
        Self {
            constant: factor * self.constant,
            position: self.position.map(|x| factor * x),
            velocity: self.velocity.map(|x| factor * x),
            acceleration: self.acceleration.map(|x| factor * x),
        }
    }

    /// Whether it asks for a local coordinate or its derivatives.
    #[inline(always)]
    pub fn sees(&self, number: usize) -> bool {
        self.position[number] != 0.0
            || self.velocity[number] != 0.0
            || self.acceleration[number] != 0.0
    }

    /// Its value from position and velocity, for functions without acceleration.
    #[inline(always)]
    pub fn at<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> T {
        let mut total = T::of(self.constant);
        for i in 0..COORDINATES {
            total += T::of(self.position[i]) * position[i];
            total += T::of(self.velocity[i]) * velocity[i];
        }
        total
    }

    /// All factors in a row, the constant first.
    fn flat(&self) -> [f64; 1 + 3 * COORDINATES] {
        let mut all = [0.0; 1 + 3 * COORDINATES];
        all[0] = self.constant;
        let parts = [self.position, self.velocity, self.acceleration];
        all[1..].copy_from_slice(parts.as_flattened());
        all
    }

    /// Whether another function is the same up to a factor.
    pub fn is_multiple_of(&self, other: &Self) -> bool {
        let (a, b) = (self.flat(), other.flat());
        let Some(pivot) = (0..a.len()).rev().find(|&i| a[i] != 0.0) else {
            return false;
        };
        b[pivot] != 0.0 && (0..a.len()).all(|i| a[i] * b[pivot] == b[i] * a[pivot])
    }
}

/// The most products that a power is made of.
const MOST_PRODUCTS: usize = 4;

/// A power as a sum of products of two affine functions, mostly a force and a velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Power {
    products: [(Affine, Affine); MOST_PRODUCTS],
    count: usize,
}

impl Power {
    /// No power.
    pub const NONE: Self = Self {
        products: [(Affine::ZERO, Affine::ZERO); MOST_PRODUCTS],
        count: 0,
    };

    /// A power of so many products, four at most.
    pub fn of(products: &[(Affine, Affine)]) -> Self {
        let mut power = Self::NONE;
        power.products[..products.len()].copy_from_slice(products);
        power.count = products.len();
        power
    }

    /// The power of a damper along one local coordinate, its constant in N s/m.
    pub fn of_damper(number: usize, damping: f64) -> Self {
        if damping == 0.0 {
            return Self::NONE;
        }
        let rate = Affine::rate(number);
        Self::of(&[(rate.times(damping), rate)])
    }

    /// Its products.
    pub fn products(&self) -> &[(Affine, Affine)] {
        &self.products[..self.count]
    }

    /// Its value, in W.
    #[inline(always)]
    pub fn at<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> T {
        let mut total = T::of(0.0);
        for (force, rate) in self.products() {
            total += force.at(position, velocity) * rate.at(position, velocity);
        }
        total
    }
}
