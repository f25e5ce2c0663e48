//! Shafts whose speed changes: how they turn, and what that does to the modes.
//!
//! With the angle phi of a shaft, its speed W and its acceleration W', the modes feel
//! `-W G q' - W' S q` of gyroscopic matrices G and S for the speed and for the acceleration one,
//! and `a (W^2 cos phi + W' sin phi) + b (W^2 sin phi - W' cos phi)` of masses out of centre, which
//! is minus the second derivative of `a cos phi + b sin phi`.
//!
//! Source: M. Lalanne, G. Ferraris, Rotordynamics Prediction in Engineering, 2nd edition, Wiley,
//! 1998, chapters 1 and 3.

use crate::error::{Error, Result, check_finite, check_length};
use crate::system::Coupling;

/// Angle in rad, speed, acceleration, and the rate of that, at an instant.
pub type Turn = [f64; 4];

/// How a shaft turns: its speed is a polynomial in time between knots, and goes on beyond the last.
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    stretches: Vec<Stretch>,
}

/// What holds from a knot on.
#[derive(Debug, Clone, PartialEq)]
struct Stretch {
    start: f64,
    /// Coefficients of the angle in powers of the time since then, the constant first.
    angle: Vec<f64>,
}

impl Course {
    /// From the angle at t = 0 and, for each stretch, its first instant and the coefficients of the
    /// speed in powers of the time since then. The first stretch begins at t = 0.
    ///
    /// # Errors
    /// When there is no stretch, a number is not finite, the first stretch does not begin at zero, or
    /// one does not begin after the one before it.
    pub fn new(angle: f64, speeds: &[(f64, Vec<f64>)]) -> Result<Self> {
        check_finite("a shaft's angle", &[angle])?;
        check_length(
            "the stretches of a shaft's speed",
            &[0.0; 1],
            speeds.len().min(1),
        )?;
        let mut stretches: Vec<Stretch> = Vec::with_capacity(speeds.len());
        for (start, speed) in speeds {
            check_finite("a shaft's speed", speed)?;
            let (length, begun) = match stretches.last() {
                None => (*start, angle),
                Some(last) => (start - last.start, last.turn(*start)[0]),
            };
            let in_order = if stretches.is_empty() {
                length == 0.0
            } else {
                length > 0.0
            };
            if !in_order {
                return Err(Error::NotPositive {
                    what: "the length of a stretch of a shaft's speed",
                    value: length,
                });
            }
            let powers = speed.iter().zip(1_u32..);
            let integrated = powers.map(|(c, power)| c / f64::from(power));
            stretches.push(Stretch {
                start: *start,
                angle: std::iter::once(begun).chain(integrated).collect(),
            });
        }
        Ok(Self { stretches })
    }

    /// The turn at a time; just after it at a knot.
    pub fn turn(&self, time: f64) -> Turn {
        self.turn_in(self.stretch(time), time)
    }

    /// The number of the stretch that goes on from a time.
    fn stretch(&self, time: f64) -> usize {
        let begun = self.stretches.partition_point(|s| s.start <= time);
        begun.saturating_sub(1)
    }

    /// The turn that a stretch tells, also beyond its end.
    fn turn_in(&self, stretch: usize, time: f64) -> Turn {
        self.stretches[stretch].turn(time)
    }

    /// Where the stretch after a given one begins; infinity for the last.
    fn end(&self, stretch: usize) -> f64 {
        (self.stretches.get(stretch + 1)).map_or(f64::INFINITY, |next| next.start)
    }
}

impl Stretch {
    /// Value and three derivatives of the angle's polynomial.
    fn turn(&self, time: f64) -> Turn {
        let since = time - self.start;
        let mut taylor = [0.0; 4];
        for c in self.angle.iter().rev() {
            for order in (1..4).rev() {
                taylor[order] = taylor[order] * since + taylor[order - 1];
            }
            taylor[0] = taylor[0] * since + c;
        }
        let [angle, speed, half, sixth] = taylor;
        [angle, speed, 2.0 * half, 6.0 * sixth]
    }
}

/// A shaft that turns by a course, and what of it the modes feel.
#[derive(Debug, Clone, PartialEq)]
pub struct Rotation {
    course: Course,
    /// The gyroscopic matrix at 1 rad/s.
    gyroscopic: Option<Coupling>,
    /// What multiplies displacements at 1 rad/s2.
    accelerating: Option<Coupling>,
    /// Modal forces at 1 rad/s, of masses out of centre at the angles 0 and a quarter turn.
    unbalance: [Vec<f64>; 2],
}

impl Rotation {
    /// Of shafts on so many modes; nothing of it is felt yet.
    pub fn new(course: Course, modes: usize) -> Self {
        Self {
            course,
            gyroscopic: None,
            accelerating: None,
            unbalance: [vec![0.0; modes], vec![0.0; modes]],
        }
    }

    /// The same with gyroscopic matrices, one row a mode, in 1 and rad: what multiplies velocities
    /// at the speed one, and displacements at the acceleration one.
    ///
    /// # Errors
    /// When one is not square of the right size or a number is not finite.
    pub fn with_gyroscopic(
        mut self,
        speed: Vec<Vec<f64>>,
        acceleration: Vec<Vec<f64>>,
    ) -> Result<Self> {
        let modes = self.modes();
        self.gyroscopic = Coupling::new("the gyroscopic matrix", speed, modes)?;
        let what = "the gyroscopic matrix of the acceleration";
        self.accelerating = Coupling::new(what, acceleration, modes)?;
        Ok(self)
    }

    /// The same with masses out of centre: their modal forces at 1 rad/s at the angles 0 and a
    /// quarter turn.
    ///
    /// # Errors
    /// When a length is wrong or a number not finite.
    pub fn with_unbalance(mut self, forces: [Vec<f64>; 2]) -> Result<Self> {
        for force in &forces {
            check_length("the force of an unbalance", force, self.modes())?;
            check_finite("the force of an unbalance", force)?;
        }
        self.unbalance = forces;
        Ok(self)
    }

    /// Number of modes.
    pub fn modes(&self) -> usize {
        self.unbalance[0].len()
    }

    /// The shaft between two knots, around a time.
    pub(crate) fn around(&self, time: f64) -> Turning<'_> {
        Turning {
            rotation: self,
            stretch: self.course.stretch(time),
        }
    }
}

/// A shaft on one stretch of its course: an instant at its end sees what holds before it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Turning<'a> {
    rotation: &'a Rotation,
    stretch: usize,
}

/// A part of what turning does to a mode.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Parts {
    /// Of velocities: no work in all.
    pub gyroscopic: f64,
    /// Of displacements.
    pub accelerating: f64,
    /// Of masses out of centre.
    pub unbalance: f64,
}

impl Parts {
    /// All of it.
    pub(crate) fn sum(&self) -> f64 {
        self.gyroscopic + self.accelerating + self.unbalance
    }
}

impl Turning<'_> {
    /// Where the stretch ends, in s.
    pub(crate) fn end(&self) -> f64 {
        self.rotation.course.end(self.stretch)
    }

    fn turn(&self, time: f64) -> Turn {
        self.rotation.course.turn_in(self.stretch, time)
    }

    /// The force on each mode at a time.
    pub(crate) fn forces<'b>(
        &'b self,
        time: f64,
        [q, v]: [&'b [f64]; 2],
    ) -> impl Iterator<Item = Parts> + 'b {
        let [angle, speed, acceleration, _] = self.turn(time);
        let (sin, cos) = angle.sin_cos();
        let (inward, along) = (speed * speed, acceleration);
        let weights = [inward * cos + along * sin, inward * sin - along * cos];
        let rotation = self.rotation;
        (0..q.len()).map(move |mode| Parts {
            gyroscopic: -speed * product(&rotation.gyroscopic, mode, v),
            accelerating: -acceleration * product(&rotation.accelerating, mode, q),
            unbalance: rotation.unbalance_force(mode, weights),
        })
    }

    /// How the force on each mode changes at a time, per s.
    pub(crate) fn force_rates<'b>(
        &'b self,
        time: f64,
        [q, v, a]: [&'b [f64]; 3],
    ) -> impl Iterator<Item = f64> + 'b {
        let [angle, speed, acceleration, jerk] = self.turn(time);
        let (sin, cos) = angle.sin_cos();
        let (mixed, turned) = (3.0 * speed * acceleration, jerk - speed * speed * speed);
        let weights = [mixed * cos + turned * sin, mixed * sin - turned * cos];
        let rotation = self.rotation;
        (0..q.len()).map(move |mode| {
            rotation.unbalance_force(mode, weights)
                - speed * product(&rotation.gyroscopic, mode, a)
                - acceleration * product(&rotation.gyroscopic, mode, v)
                - acceleration * product(&rotation.accelerating, mode, v)
                - jerk * product(&rotation.accelerating, mode, q)
        })
    }

    /// Bounds, at a time, of the damping and of the stiffness that it adds to motions of the modes.
    pub(crate) fn sizes(&self, time: f64) -> [f64; 2] {
        let [_, speed, acceleration, _] = self.turn(time);
        let size = |matrix: &Option<Coupling>| matrix.as_ref().map_or(0.0, Coupling::size);
        [
            speed.abs() * size(&self.rotation.gyroscopic),
            acceleration.abs() * size(&self.rotation.accelerating),
        ]
    }

    /// The speed at a time, in rad/s.
    pub(crate) fn speed(&self, time: f64) -> f64 {
        self.turn(time)[1]
    }
}

impl Rotation {
    fn unbalance_force(&self, mode: usize, weights: [f64; 2]) -> f64 {
        let both = self.unbalance.iter().zip(weights);
        both.map(|(force, weight)| weight * force[mode]).sum()
    }
}

fn product(matrix: &Option<Coupling>, mode: usize, motion: &[f64]) -> f64 {
    matrix.as_ref().map_or(0.0, |m| m.product(mode, motion))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At rest for a second, then faster by 3 rad/s2 and 0.5 rad/s3.
    fn course() -> Course {
        Course::new(0.25, &[(0.0, vec![2.0]), (1.0, vec![2.0, 3.0, 0.5])]).unwrap()
    }

    #[test]
    fn a_course_is_the_integral_of_its_speeds() {
        let course = course();
        assert_eq!(course.turn(0.5), [1.25, 2.0, 0.0, 0.0]);
        let [angle, speed, acceleration, jerk] = course.turn(3.0);
        assert!((angle - (2.25 + 4.0 + 6.0 + 4.0 / 3.0)).abs() < 1e-14);
        assert_eq!([speed, acceleration, jerk], [10.0, 5.0, 1.0]);
    }

    #[test]
    fn an_instant_at_the_end_of_a_stretch_sees_what_holds_before_it() {
        let rotation = Rotation::new(course(), 1);
        let first = rotation.around(0.0);
        assert_eq!(first.end(), 1.0);
        assert_eq!(first.turn(1.0)[2], 0.0);
        let second = rotation.around(first.end());
        assert_eq!(second.end(), f64::INFINITY);
        assert_eq!(second.turn(1.0)[2], 3.0);
    }

    #[test]
    fn rates_of_forces_are_their_slopes() {
        let gyroscopic = vec![vec![0.0, 0.7], vec![-0.7, 0.0]];
        let accelerating = vec![vec![0.0, 0.7], vec![0.0, 0.0]];
        let rotation = (Rotation::new(course(), 2))
            .with_gyroscopic(gyroscopic, accelerating)
            .and_then(|r| r.with_unbalance([vec![1.0, 0.5], vec![-0.25, 2.0]]))
            .unwrap();
        let turning = rotation.around(1.5);
        let (q, v, a) = ([0.3, -0.2], [1.0, 0.4], [-2.0, 3.0]);
        let moved = |by: f64| {
            let later = |x: [f64; 2], rate: [f64; 2]| [x[0] + by * rate[0], x[1] + by * rate[1]];
            let (q, v) = (later(q, v), later(v, a));
            let forces: Vec<_> = turning
                .forces(1.5 + by, [&q, &v])
                .map(|p| p.sum())
                .collect();
            forces
        };
        let h = 1e-5;
        let (before, after) = (moved(-h), moved(h));
        for (mode, rate) in turning.force_rates(1.5, [&q, &v, &a]).enumerate() {
            let slope = (after[mode] - before[mode]) / (2.0 * h);
            assert!((rate - slope).abs() < 1e-7 * rate.abs(), "{rate} {slope}");
        }
    }

    #[test]
    fn stretches_out_of_order_are_refused() {
        for speeds in [
            vec![],
            vec![(1.0, vec![0.0])],
            vec![(0.0, vec![1.0]), (0.0, vec![2.0])],
            vec![(0.0, vec![f64::NAN])],
        ] {
            assert!(Course::new(0.0, &speeds).is_err(), "{speeds:?}");
        }
    }
}
