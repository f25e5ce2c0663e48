//! Motions of obstacles.

use super::{Channel, Forcing, Harmonic, History, Table};
use crate::error::{Error, Result, check_finite};
use crate::law::{COORDINATES, Local};
use crate::number::Complex;

/// An obstacle that moves: so much as it moves is taken off a local coordinate of its law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Moved {
    /// The law, by number.
    pub law: usize,
    /// Which of its coordinates.
    pub coordinate: usize,
}

impl Forcing {
    /// Moves an obstacle by `c_0 + c_1 t + c_2 t^2 + ...`, in m.
    ///
    /// # Errors
    /// When a number is not finite or the degree is too high.
    pub fn with_polynomial_motion(self, moved: Moved, coefficients: Vec<f64>) -> Result<Self> {
        let still = vec![0.0; self.forces().len()];
        Ok(self.with_polynomial(still, coefficients)?.moving(moved))
    }

    /// Moves an obstacle by a piecewise-linear function of time, in m.
    ///
    /// # Errors
    /// When the table jumps: an obstacle moves at a finite speed.
    pub fn with_table_motion(self, moved: Moved, table: Table) -> Result<Self> {
        if let Some(time) = table.jump() {
            return Err(Error::Jump { time });
        }
        let still = vec![0.0; self.forces().len()];
        Ok(self.with_table(still, table)?.moving(moved))
    }

    /// Moves an obstacle by `cosine cos(omega t) + sine sin(omega t)`, in m.
    ///
    /// # Errors
    /// When a number is not finite or the frequency is not positive.
    pub fn with_harmonic_motion(
        mut self,
        moved: Moved,
        omega: f64,
        cosine: f64,
        sine: f64,
    ) -> Result<Self> {
        check_finite("an obstacle's motion", &[cosine, sine])?;
        let still = vec![0.0; self.forces().len()];
        let mut fresh = Harmonic::new(omega, &still, &still)?;
        fresh.motions.push((moved, Complex::new(cosine, -sine)));
        self.join(fresh);
        Ok(self)
    }

    /// Marks the latest channel as the motion of an obstacle.
    fn moving(mut self, moved: Moved) -> Self {
        if let Some(channel) = self.channels.last_mut() {
            channel.moves = Some(moved);
        }
        self
    }

    /// The obstacles that move, some of them several times.
    pub fn moved(&self) -> impl Iterator<Item = Moved> + '_ {
        let by_channels = self.channels.iter().filter_map(|channel| channel.moves);
        let by_harmonics = self.harmonics.iter().flat_map(|harmonic| &harmonic.motions);
        by_channels.chain(by_harmonics.map(|(moved, _)| *moved))
    }

    /// A law's local position and velocity at a time less those of its obstacle.
    pub(crate) fn seen_from_obstacle(
        &self,
        law: usize,
        time: f64,
        mut local: [Local<f64>; 2],
    ) -> [Local<f64>; 2] {
        for (local, moved) in local.iter_mut().zip(self.motion(law, time)) {
            for (local, moved) in local.iter_mut().zip(moved) {
                *local -= moved;
            }
        }
        local
    }

    /// How far the obstacle of a law has moved at a time along each local coordinate, in m, and the
    /// first three derivatives just after it.
    pub fn motion(&self, law: usize, time: f64) -> [Local<f64>; 4] {
        let mut motion = [[0.0; COORDINATES]; 4];
        for channel in &self.channels {
            if let Some(moved) = channel.moves.filter(|moved| moved.law == law) {
                for (to, part) in motion.iter_mut().zip(channel.derivatives(time)) {
                    to[moved.coordinate] += part;
                }
            }
        }
        for harmonic in &self.harmonics {
            for (moved, amplitude) in harmonic.motions.iter().filter(|(m, _)| m.law == law) {
                let mut turning = *amplitude * harmonic.unit(time);
                for to in &mut motion {
                    to[moved.coordinate] += turning.re;
                    turning = turning * Complex::new(0.0, harmonic.omega);
                }
            }
        }
        motion
    }
}

impl Channel {
    /// Its value at a time and the first three derivatives just after it.
    fn derivatives(&self, time: f64) -> [f64; 4] {
        match &self.history {
            History::Polynomial(coefficients) => {
                let mut shifted = vec![0.0; coefficients.len().max(4)];
                super::shift(coefficients, time, &mut shifted);
                [shifted[0], shifted[1], 2.0 * shifted[2], 6.0 * shifted[3]]
            }
            History::Table(table) => {
                let [value, slope] = table.line(table.place(time), time);
                [value, slope, 0.0, 0.0]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forcing::Beyond;

    fn still() -> Forcing {
        Forcing::constant(vec![0.0, 0.0]).unwrap()
    }

    fn moved((law, coordinate): (usize, usize)) -> Moved {
        Moved { law, coordinate }
    }

    #[test]
    fn motions_add_up_and_loads_do_not_feel_them() {
        let table = Table::new(vec![0.0, 1.0], vec![2.0, 5.0], Beyond::Hold).unwrap();
        let [own, across, other] = [(1, 0), (1, 2), (0, 0)].map(moved);
        let forcing = (still().with_polynomial_motion(own, vec![1.0, -2.0, 0.5, 0.25]))
            .and_then(|f| f.with_table_motion(own, table))
            .and_then(|f| f.with_harmonic_motion(own, 3.0, 0.1, 0.2))
            .and_then(|f| f.with_harmonic_motion(other, 3.0, 7.0, 0.0))
            .and_then(|f| f.with_polynomial_motion(across, vec![0.0, 5.0]))
            .unwrap();
        let t = 0.4f64;
        let (sin, cos) = (3.0 * t).sin_cos();
        let expected = [
            1.0 - 2.0 * t + 0.5 * t * t + 0.25 * t.powi(3) + 2.0 + 3.0 * t + 0.1 * cos + 0.2 * sin,
            -2.0 + t + 0.75 * t * t + 3.0 - 0.3 * sin + 0.6 * cos,
            1.0 + 1.5 * t - 0.9 * cos - 1.8 * sin,
            1.5 + 2.7 * sin - 5.4 * cos,
        ];
        let motion = forcing.motion(1, t);
        for (a, b) in motion.iter().zip(expected) {
            assert!((a[0] - b).abs() < 1e-13, "{a:?} {b}");
        }
        assert_eq!(motion.map(|order| order[1]), [0.0; 4]);
        assert_eq!(motion.map(|order| order[2]), [2.0, 5.0, 0.0, 0.0]);
        assert_eq!(forcing.harmonics().len(), 1);
        let mut forces = [1.0; 2];
        forcing.at(t, &mut forces);
        assert_eq!(forces, [0.0; 2]);
        let all: Vec<_> = forcing.moved().collect();
        assert_eq!(all, [own, own, across, own, other]);
    }

    #[test]
    fn obstacles_do_not_jump() {
        let jumps = [
            (vec![0.0, 1.0, 1.0], vec![0.0, 1.0, 2.0], Beyond::Hold),
            (vec![0.0, 1.0], vec![0.0, 1.0], Beyond::Zero),
        ];
        for (times, values, beyond) in jumps {
            let table = Table::new(times, values, beyond).unwrap();
            assert!(still().with_table_motion(moved((0, 0)), table).is_err());
        }
    }
}
