//! Affine functions of a law's local motion, and powers made of them.

use super::{COORDINATES, Local, LocalMotion};
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

    /// Whether it depends on accelerations.
    #[inline(always)]
    pub fn asks_acceleration(&self) -> bool {
        self.acceleration != Self::ZERO.acceleration
    }

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

    /// The sum of two functions.
    pub fn plus(&self, other: &Self) -> Self {
        let sum = |a: &Local<f64>, b: &Local<f64>| std::array::from_fn(|i| a[i] + b[i]);
        Self {
            constant: self.constant + other.constant,
            position: sum(&self.position, &other.position),
            velocity: sum(&self.velocity, &other.velocity),
            acceleration: sum(&self.acceleration, &other.acceleration),
        }
    }

    /// Its time derivative, for functions without acceleration.
    pub fn derivative(&self) -> Self {
        debug_assert!(self.acceleration == [0.0; COORDINATES]);
        Self {
            constant: 0.0,
            position: [0.0; COORDINATES],
            velocity: self.position,
            acceleration: self.velocity,
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

    /// Its value at an instant, and the size below which that counts as zero.
    pub fn value(&self, motion: &LocalMotion) -> (f64, f64) {
        self.term(0, motion)
    }

    /// Its value and its first two derivatives, for functions without acceleration, each with the
    /// size below which it counts as zero.
    pub fn series(&self, motion: &LocalMotion) -> [(f64, f64); 3] {
        std::array::from_fn(|order| self.term(order, motion))
    }

    fn term(&self, order: usize, motion: &LocalMotion) -> (f64, f64) {
        let constant = if order == 0 { self.constant } else { 0.0 };
        let (mut value, mut zero) = (constant, f64::EPSILON * constant.abs());
        let factors = [&self.position, &self.velocity, &self.acceleration];
        let known = (motion.derivatives.iter().zip(motion.zero)).skip(order);
        for (factors, (derivatives, size)) in factors.into_iter().zip(known) {
            for (factor, derivative) in factors.iter().zip(derivatives) {
                value += factor * derivative;
                zero += factor.abs() * size;
            }
        }
        (value, zero)
    }

    /// All factors in a row, the constant first.
    #[inline(always)]
    fn flat(&self) -> [f64; 1 + 3 * COORDINATES] {
        let mut all = [0.0; 1 + 3 * COORDINATES];
        all[0] = self.constant;
        let parts = [self.position, self.velocity, self.acceleration];
        all[1..].copy_from_slice(parts.as_flattened());
        all
    }

    /// Whether another function is the same up to a factor and rounding.
    pub fn is_multiple_of(&self, other: &Self) -> bool {
        let (a, b) = (self.flat(), other.flat());
        let mut pivot = None;
        for (i, factor) in a.iter().enumerate() {
            if *factor != 0.0 {
                pivot = Some(i);
            }
        }
        let Some(pivot) = pivot else {
            return false;
        };
        let mut alike = b[pivot] != 0.0;
        for i in 0..a.len() {
            let (x, y) = (a[i] * b[pivot], b[i] * a[pivot]);
            alike &= (x - y).abs() <= ALIKE * x.abs().max(y.abs());
        }
        alike
    }

    /// Whether the rate of this function is another one up to a factor, so that it turns where
    /// the other is zero.
    pub fn rises_with(&self, other: &Self) -> bool {
        // A rate has neither a constant nor positions.
        let is_rate = other.constant == 0.0 && other.position == [0.0; COORDINATES];
        is_rate
            && self.acceleration == [0.0; COORDINATES]
            && self.derivative().is_multiple_of(other)
    }
}

/// Factors of two functions are alike if they differ by no more than this part of them.
const ALIKE: f64 = 1e-14;

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

    /// The sum of two powers.
    pub fn plus(&self, other: &Self) -> Self {
        let mut sum = *self;
        for product in other.products() {
            sum.products[sum.count] = *product;
            sum.count += 1;
        }
        sum
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
