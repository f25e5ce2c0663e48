//! Coulomb friction in the two directions of a contact plane.
//!
//! A spring and a damper side by side stand in a row with a slider. With the stretch s of the
//! spring and the speed v along the plane they would carry `w = k s + c v` if the slider held; it
//! holds up to `|w| = mu_static F`. When it slides its force is `mu_dynamic F` along `e = w / |w|`:
//! spring and damper carry `k s + c s' = mu_dynamic F e`, and the slider takes the rest of the speed,
//! `(|w| - mu_dynamic F) / c` along e, until nothing is left of that. The force on the structure is -w
//! limited in size, as by a radial return; the damper is what makes the stretch follow a rate
//! equation of its own.
//!
//! Source of spring, damper and limit: the shocks and friction of code_aster's manual R5.06.03; of
//! the return: J. C. Simo, T. J. R. Hughes, Computational Inelasticity, Springer, 1998, section 2.7.

use super::Friction;
use crate::number::Number;

/// Two components along the contact plane.
pub(super) type Along<T> = [T; 2];

/// What friction does at an instant.
pub(super) struct Rub<T> {
    /// Force on the structure, in N.
    pub force: Along<T>,
    /// Rate of the stretch, in m/s.
    pub stretching: Along<T>,
    /// Power that damper and slider take, in W.
    pub power: T,
}

/// The squared length.
#[inline(always)]
fn square<T: Number>([a, b]: Along<T>) -> T {
    a * a + b * b
}

/// What the contact would carry if the slider held.
#[inline(always)]
fn held<T: Number>(friction: &Friction, stretch: Along<T>, speed: Along<T>) -> Along<T> {
    let carried = |s: T, v: T| T::of(friction.stiffness) * s + T::of(friction.damping) * v;
    [carried(stretch[0], speed[0]), carried(stretch[1], speed[1])]
}

/// While it sticks.
pub(super) fn stick<T: Number>(friction: &Friction, stretch: Along<T>, speed: Along<T>) -> Rub<T> {
    Rub {
        force: held(friction, stretch, speed).map(|w| -w),
        stretching: speed,
        power: T::of(friction.damping) * square(speed),
    }
}

/// While it slides under a normal force.
pub(super) fn slip<T: Number>(
    friction: &Friction,
    stretch: Along<T>,
    speed: Along<T>,
    push: T,
) -> Rub<T> {
    let carried = held(friction, stretch, speed);
    let size = square(carried).sqrt().max(T::of(f64::MIN_POSITIVE));
    let limit = T::of(friction.dynamic_coefficient) * push;
    let sliding = (size - limit) / T::of(friction.damping);
    let along = carried.map(|w| w / size);
    let stretching = [speed[0] - sliding * along[0], speed[1] - sliding * along[1]];
    Rub {
        force: along.map(|e| -(limit * e)),
        stretching,
        power: T::of(friction.damping) * square(stretching) + limit * sliding,
    }
}

/// Positive while the slider holds under a normal force, or while it goes on: a squared length.
#[inline(always)]
pub(super) fn margin<T: Number>(
    friction: &Friction,
    sticks: bool,
    stretch: Along<T>,
    speed: Along<T>,
    push: T,
) -> T {
    let coefficient = if sticks {
        friction.static_coefficient
    } else {
        friction.dynamic_coefficient
    };
    let limit = T::of(coefficient) * push;
    let left = limit * limit - square(held(friction, stretch, speed));
    T::of((if sticks { 1.0 } else { -1.0 }) / friction.stiffness.powi(2)) * left
}

/// Energy in the spring.
pub(super) fn stored<T: Number>(friction: &Friction, stretch: Along<T>) -> T {
    T::of(0.5 * friction.stiffness) * square(stretch)
}
