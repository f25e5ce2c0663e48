//! A crack across a shaft that turns: a hinge whose stiffness depends on where it is bent to.
//!
//! Coordinates are the rotations `D = (D_y, D_z)` of one side of the crack against the other, about
//! two axes across the shaft. In the frame that turns with the shaft by the angle g they are
//! `l2 = cos g D_y + sin g D_z`, `l3 = -sin g D_y + cos g D_z`, of the direction
//! `phi = atan2(l2, l3)`. The moments that resist are
//!
//! `m2 = K(phi) l2 + K'(phi) l3 / 2`, `m3 = K(phi) l3 - K'(phi) l2 / 2`,
//!
//! turned back: with the slope K' of K the gradient of the energy `K(phi) |D|^2 / 2`. Tables may tell
//! K and K' by themselves. The first number of the memory is the time, whose rate is one.
//!
//! Source: S. Andrieux, C. Vare, A 3D cracked beam model with unilateral contact, European Journal of
//! Mechanics A/Solids 21, 793-810, 2002; in code_aster ROTOR_FISS.

use super::{Law, Local, LocalMotion, Piece, State};
use crate::error::{Error, Result, check_finite, check_length};
use crate::number::Number;
use crate::rotation::Course;
use std::borrow::Cow;
use std::f64::consts::TAU;

/// A function of a direction, by cubics between breaks; it repeats itself after a full turn.
#[derive(Debug, Clone, PartialEq)]
pub struct Periodic {
    breaks: Vec<f64>,
    /// Coefficients in powers of the angle since the break, the constant first.
    cubics: Vec<[f64; 4]>,
}

impl Periodic {
    /// From ascending breaks within one turn and the coefficients from each break on.
    ///
    /// # Errors
    /// When there are none, a number is not finite, or breaks are out of order.
    pub fn new(breaks: Vec<f64>, cubics: Vec<[f64; 4]>) -> Result<Self> {
        check_finite("the breaks of a function of the direction", &breaks)?;
        check_finite("a function of the direction", cubics.as_flattened())?;
        let what = "the cubics of a function of the direction";
        check_length(what, &vec![0.0; cubics.len()], breaks.len().max(1))?;
        let next = breaks.iter().skip(1).copied();
        for (at, after) in breaks.iter().zip(next.chain([breaks[0] + TAU])) {
            if after <= *at {
                return Err(Error::NotPositive {
                    what: "the width between two breaks of a function of the direction",
                    value: after - at,
                });
            }
        }
        Ok(Self { breaks, cubics })
    }

    /// Value and slope at an angle.
    fn at(&self, angle: f64) -> [f64; 2] {
        let first = self.breaks[0];
        let within = first + (angle - first).rem_euclid(TAU);
        let place = self.breaks.partition_point(|at| *at <= within).max(1) - 1;
        let since = within - self.breaks[place];
        let highest_first = self.cubics[place].iter().rev();
        highest_first.fold([0.0; 2], |[value, slope], c| {
            [value * since + c, slope * since + value]
        })
    }

    /// The largest magnitude at breaks.
    fn largest(&self) -> f64 {
        self.cubics.iter().fold(0.0, |most, c| c[0].abs().max(most))
    }

    /// As a function of both parts of a vector in the direction; no slope where it has no length.
    fn of<T: Number>(&self, [l2, l3]: [T; 2]) -> T {
        T::function(
            [l2, l3],
            |[l2, l3]| self.at(l2.atan2(l3))[0],
            |[l2, l3]| {
                let square = l2 * l2 + l3 * l3;
                let slope = self.at(l2.atan2(l3))[1];
                let each = if square > 0.0 { slope / square } else { 0.0 };
                [each * l3, -each * l2]
            },
        )
    }
}

/// A crack of a shaft.
#[derive(Debug, Clone, PartialEq)]
pub struct CrackedRotor {
    rows: [Vec<f64>; 2],
    stiffness: Periodic,
    derivative: Periodic,
    course: Course,
}

/// Where the time stands in the memory.
const TIME: usize = 0;

/// Rotations and moments in the frame that turns.
struct Bent<T> {
    rotation: [T; 2],
    moment: [T; 2],
}

impl CrackedRotor {
    /// A crack with rotations `rows . q`, its stiffness in N m/rad and what stands for the slope of
    /// that in N m/rad2, in a shaft that turns by a course.
    ///
    /// # Errors
    /// When a number is not finite.
    pub fn new(
        rows: [Vec<f64>; 2],
        stiffness: Periodic,
        derivative: Periodic,
        course: Course,
    ) -> Result<Self> {
        for row in &rows {
            check_finite("a row of the crack", row)?;
        }
        Ok(Self {
            rows,
            stiffness,
            derivative,
            course,
        })
    }

    /// Sine and cosine of the shaft's angle.
    fn angle(&self, state: State) -> (f64, f64) {
        self.course.turn(state.memory[TIME])[0].sin_cos()
    }

    /// Numbers along the fixed axes, along those that turn.
    fn turned<T: Number>(&self, state: State, fixed: &Local<T>) -> [T; 2] {
        let (sin, cos) = self.angle(state);
        let (sin, cos) = (T::of(sin), T::of(cos));
        [
            cos * fixed[0] + sin * fixed[1],
            cos * fixed[1] - sin * fixed[0],
        ]
    }

    fn bent<T: Number>(&self, state: State, position: &Local<T>) -> Bent<T> {
        let [l2, l3] = self.turned(state, position);
        let stiffness = self.stiffness.of([l2, l3]);
        let half = T::of(0.5) * self.derivative.of([l2, l3]);
        Bent {
            rotation: [l2, l3],
            moment: [stiffness * l2 + half * l3, stiffness * l3 - half * l2],
        }
    }
}

impl Law for CrackedRotor {
    fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }

    fn state_name(&self, _state: State) -> Cow<'static, str> {
        "turning".into()
    }

    fn initial_state(&self, _motion: &LocalMotion, _: impl Fn(State) -> LocalMotion) -> State {
        State::FIRST
    }

    fn sampled_state(&self, previous: State, _: &Local<f64>, _: &Local<f64>) -> State {
        previous
    }

    fn force<T: Number>(&self, state: State, position: &Local<T>, _: &Local<T>) -> Local<T> {
        let (sin, cos) = self.angle(state);
        let (sin, cos) = (T::of(sin), T::of(cos));
        let [m2, m3] = self.bent(state, position).moment;
        [-(cos * m2 - sin * m3), -(sin * m2 + cos * m3), T::of(0.0)]
    }

    fn is_piecewise_linear(&self) -> bool {
        false
    }

    fn flows(&self) -> bool {
        true
    }

    fn memory_rates(&self, _state: State, _: &Local<f64>, _: &Local<f64>) -> [f64; 2] {
        [1.0, 0.0]
    }

    /// The time is known to the last digit.
    fn memory_sizes(&self, _position: &Local<f64>) -> [f64; 2] {
        [0.0; 2]
    }

    /// The direction in which the crack is bent, seen from the shaft, in rad.
    fn internal_variables(
        &self,
        state: State,
        position: &Local<f64>,
        _velocity: &Local<f64>,
    ) -> [f64; 2] {
        let [l2, l3] = self.turned(state, position);
        [l2.atan2(l3).rem_euclid(TAU), f64::NAN]
    }

    fn piece(&self, _state: State) -> Option<Piece> {
        None
    }

    fn stored<T: Number>(&self, state: State, position: &Local<T>) -> T {
        let [l2, l3] = self.turned(state, position);
        T::of(0.5) * self.stiffness.of([l2, l3]) * (l2 * l2 + l3 * l3)
    }

    /// What the moments take from the motion and do not store. As the shaft turns the energy at a
    /// bend that is held changes, which its drive gives or takes; what a table of the slope that is
    /// not that of the stiffness makes is lost or won.
    fn dissipated_power<T: Number>(
        &self,
        state: State,
        position: &Local<T>,
        velocity: &Local<T>,
    ) -> T {
        let Bent {
            rotation: [l2, l3], ..
        } = self.bent(state, position);
        let [a2, a3] = self.turned(state, velocity);
        let speed = T::of(self.course.turn(state.memory[TIME])[1]);
        let slope = T::function(
            [l2, l3],
            |[l2, l3]| self.stiffness.at(l2.atan2(l3))[1],
            |_| [0.0; 2],
        );
        let excess = self.derivative.of([l2, l3]) - slope;
        let driven = slope * speed * (l2 * l2 + l3 * l3);
        T::of(0.5) * (excess * (l3 * a2 - l2 * a3) - driven)
    }

    fn distance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> (T, T) {
        (position[0], velocity[0])
    }

    /// No state is linear; with the crack closed it is about as stiff as this.
    fn stiffest(&self) -> Piece {
        let mut piece = Piece::FREE;
        let most = self.stiffness.largest();
        (piece.stiffness[0][0], piece.stiffness[1][1]) = (most, most);
        piece
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// K = 3 + phi-dependent cubics on four quarters that meet.
    fn law(derivative: Option<[f64; 4]>) -> CrackedRotor {
        let quarter = 0.25 * TAU;
        let breaks: Vec<f64> = (0..4).map(|n| f64::from(n) * quarter).collect();
        let up = [3.0, 0.0, 3.0 / (quarter * quarter), -2.0 / quarter.powi(3)];
        let down = [4.0, 0.0, -up[2], -up[3]];
        let stiffness = Periodic::new(breaks.clone(), vec![up, down, up, down]).unwrap();
        let slope = |c: [f64; 4]| derivative.unwrap_or([c[1], 2.0 * c[2], 3.0 * c[3], 0.0]);
        let slopes = [up, down, up, down].map(slope);
        let derivative = Periodic::new(breaks, slopes.to_vec()).unwrap();
        let rows = [vec![1.0, 0.0], vec![0.0, 1.0]];
        let course = Course::new(0.4, &[(0.0, vec![-2.0, 0.5])]).unwrap();
        CrackedRotor::new(rows, stiffness, derivative, course).unwrap()
    }

    #[test]
    fn moments_are_the_gradient_of_the_energy() {
        let law = law(None);
        for (time, y, z) in [(0.0, 0.3, 0.7), (1.3, -0.4, 0.2), (4.0, 0.1, -0.9)] {
            let state = State::with_memory(0, [time, 0.0]);
            let energy = |y: f64, z: f64| law.stored(state, &[y, z, 0.0]);
            let force = law.force(state, &[y, z, 0.0], &[0.0; 3]);
            let h = 1e-6;
            let by_y = (energy(y + h, z) - energy(y - h, z)) / (2.0 * h);
            let by_z = (energy(y, z + h) - energy(y, z - h)) / (2.0 * h);
            assert!((force[0] + by_y).abs() < 1e-8, "{force:?} {by_y}");
            assert!((force[1] + by_z).abs() < 1e-8, "{force:?} {by_z}");
        }
    }

    #[test]
    fn what_moments_take_is_stored_or_told_as_lost() {
        for law in [law(None), law(Some([0.2, -0.1, 0.0, 0.0]))] {
            let (time, [y, z], [dy, dz]) = (0.8, [0.3, -0.7], [1.1, 0.6]);
            let energy = |by: f64| {
                let state = State::with_memory(0, [time + by, 0.0]);
                law.stored(state, &[y + by * dy, z + by * dz, 0.0])
            };
            let state = State::with_memory(0, [time, 0.0]);
            let (position, velocity) = ([y, z, 0.0], [dy, dz, 0.0]);
            let force = law.force(state, &position, &velocity);
            let taken = -(force[0] * dy + force[1] * dz);
            let stored = (energy(1e-6) - energy(-1e-6)) / 2e-6;
            let lost = law.dissipated_power(state, &position, &velocity);
            assert!(
                (taken - stored - lost).abs() < 1e-8,
                "{taken} {stored} {lost}"
            );
        }
    }

    #[test]
    fn breaks_out_of_order_are_refused() {
        let cubic = [1.0, 0.0, 0.0, 0.0];
        for breaks in [vec![], vec![1.0, 0.5], vec![0.0, 7.0], vec![0.0, f64::NAN]] {
            let cubics = vec![cubic; breaks.len()];
            assert!(Periodic::new(breaks, cubics).is_err());
        }
    }
}
