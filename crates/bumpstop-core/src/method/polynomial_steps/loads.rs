//! Loads and the motions of obstacles between two knots of the tables.
//!
//! Knots are ends of steps, and between them each table is one line: a stage at the end of a step
//! sees that line, not what begins there.

use crate::forcing::{Forcing, Moved, Onset};
use crate::law::Local;

/// The loads of one stretch of time.
#[derive(Debug)]
pub(crate) struct Loads<'a> {
    forcing: &'a Forcing,
    /// Where the stretch begins, in s.
    start: f64,
    onset: Onset,
    places: Vec<usize>,
}

impl<'a> Loads<'a> {
    pub(crate) fn new(forcing: &'a Forcing) -> Self {
        Self {
            forcing,
            start: 0.0,
            onset: Onset::default(),
            places: Vec::new(),
        }
    }

    /// Turns to the stretch from a time on; returns where it ends.
    pub(crate) fn turn(&mut self, time: f64) -> f64 {
        self.start = time;
        self.forcing.onset(time, &mut self.places, &mut self.onset);
        self.forcing.next_knot(&self.places)
    }

    pub(crate) fn vary(&self) -> bool {
        self.forcing.varies()
    }

    /// The forces that change, one a mode.
    pub(crate) fn changing(&self, time: f64, to: &mut [f64]) {
        to.fill(0.0);
        let channels = self.forcing.channels().iter().enumerate();
        for (number, channel) in channels.filter(|(_, channel)| channel.moves.is_none()) {
            let [value, _] = self.channel(number, time);
            for (force, direction) in to.iter_mut().zip(&channel.direction) {
                *force += direction * value;
            }
        }
        for harmonic in self.forcing.harmonics() {
            let unit = harmonic.unit(time);
            for (force, amplitude) in to.iter_mut().zip(&harmonic.amplitude) {
                *force += amplitude.real_product(unit);
            }
        }
    }

    /// How far the obstacle of a law has moved along each local coordinate, and how fast it moves.
    pub(crate) fn motion(&self, law: usize, time: f64) -> [Local<f64>; 2] {
        let mut motion = [Local::default(); 2];
        for (number, channel) in self.forcing.channels().iter().enumerate() {
            if let Some(moved) = channel.moves.filter(|moved| moved.law == law) {
                let [value, rate] = self.channel(number, time);
                motion[0][moved.coordinate] += value;
                motion[1][moved.coordinate] += rate;
            }
        }
        for harmonic in self.forcing.harmonics() {
            for (moved, amplitude) in harmonic.motions.iter().filter(|(m, _)| m.law == law) {
                let turned = *amplitude * harmonic.unit(time);
                motion[0][moved.coordinate] += turned.re;
                motion[1][moved.coordinate] -= harmonic.omega * turned.im;
            }
        }
        motion
    }

    /// The derivatives over their factorials, times powers of h, of an obstacle's motion at a
    /// time: its Taylor coefficients in parts of a step.
    pub(crate) fn series(&self, moved: Moved, time: f64, h: f64, to: &mut [f64]) {
        to.fill(0.0);
        let since = time - self.start;
        for (number, channel) in self.forcing.channels().iter().enumerate() {
            if channel.moves == Some(moved) {
                let mut shifted = self.coefficients(number).to_vec();
                taylor_shift(&mut shifted, since);
                let mut power = 1.0;
                for (to, coefficient) in to.iter_mut().zip(shifted) {
                    *to += coefficient * power;
                    power *= h;
                }
            }
        }
        for harmonic in self.forcing.harmonics() {
            for (_, amplitude) in harmonic.motions.iter().filter(|(m, _)| *m == moved) {
                let mut turning = *amplitude * harmonic.unit(time);
                for (power, to) in to.iter_mut().enumerate() {
                    *to += turning.re;
                    let factor = harmonic.omega * h / (power + 1) as f64;
                    (turning.re, turning.im) = (-factor * turning.im, factor * turning.re);
                }
            }
        }
    }

    /// Value and rate of a channel.
    fn channel(&self, number: usize, time: f64) -> [f64; 2] {
        let since = time - self.start;
        let highest_first = self.coefficients(number).iter().rev();
        highest_first.fold([0.0; 2], |[value, rate], c| {
            [value * since + c, rate * since + value]
        })
    }

    fn coefficients(&self, number: usize) -> &[f64] {
        let stride = self.forcing.stride();
        &self.onset.coefficients[number * stride..][..stride]
    }
}

/// The coefficients of `sum c_n (by + x)^n` in x, by repeated synthetic division.
fn taylor_shift(c: &mut [f64], by: f64) {
    for lowest in 0..c.len().saturating_sub(1) {
        for n in (lowest..c.len() - 1).rev() {
            c[n] += by * c[n + 1];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forcing::{Beyond, Table};

    #[test]
    fn a_stretch_sees_what_holds_before_its_end() {
        let table = Table::new(vec![0.0, 1.0, 1.0], vec![1.0, 3.0, 9.0], Beyond::Hold).unwrap();
        let forcing = (Forcing::constant(vec![5.0]).unwrap())
            .with_table(vec![2.0], table)
            .and_then(|f| f.with_harmonic(3.0, &[0.0], &[1.0]))
            .unwrap();
        let mut loads = Loads::new(&forcing);
        assert_eq!(loads.turn(0.0), 1.0);
        let mut force = [0.0];
        for time in [0.25, 1.0] {
            loads.changing(time, &mut force);
            let expected = 2.0 * (1.0 + 2.0 * time) + f64::sin(3.0 * time);
            assert!((force[0] - expected).abs() < 1e-14);
        }
        assert_eq!(loads.turn(1.0), f64::INFINITY);
        loads.changing(1.0, &mut force);
        assert!((force[0] - 18.0 - f64::sin(3.0)).abs() < 1e-13);
    }

    #[test]
    fn the_series_of_an_obstacle_is_its_motion() {
        let moved = Moved {
            law: 1,
            coordinate: 2,
        };
        let forcing = (Forcing::constant(vec![0.0]).unwrap())
            .with_polynomial_motion(moved, vec![1.0, -2.0, 0.5, 0.25])
            .and_then(|f| f.with_harmonic_motion(moved, 3.0, 0.1, 0.2))
            .unwrap();
        let mut loads = Loads::new(&forcing);
        loads.turn(0.3);
        let (from, h) = (0.4, 0.1);
        let mut series = [0.0; 11];
        loads.series(moved, from, h, &mut series);
        for theta in [0.0, 0.4, 1.0] {
            let found = series.iter().rev().fold(0.0, |sum, c| sum * theta + c);
            let [value, rate, ..] = forcing.motion(1, from + theta * h).map(|order| order[2]);
            assert!((found - value).abs() < 1e-14);
            let [other, other_rate] = loads.motion(1, from + theta * h).map(|order| order[2]);
            assert!((other - value).abs() < 1e-14 && (other_rate - rate).abs() < 1e-14);
        }
    }
}
