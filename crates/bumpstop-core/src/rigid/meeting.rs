//! The stops that are in touch at one instant: what their impulses do, and which of them hold.

use super::complementarity;
use super::contacts::Cause;
use super::directions::Directions;
use crate::dynamics::Moment;
use crate::error::{Error, Result};
use crate::law::{Law, State};
use crate::problem::Problem;

/// Rates and accelerations below these parts of the terms that they are summed of are zero.
const NO_RATE: f64 = 64.0 * f64::EPSILON;
const NO_ACCELERATION: f64 = 1e-12;

/// Stops in touch.
pub(super) struct Meeting<'a, L> {
    pub problem: &'a Problem<L>,
    pub cause: Cause,
    pub time: f64,
    pub directions: Directions<'a>,
    /// How far the distance of each has gone, in m.
    pub sizes: Vec<f64>,
}

/// What became of one stop.
#[derive(Debug, Clone, Copy)]
pub(super) struct Outcome {
    pub law: usize,
    /// Impulse of an impact, in N s.
    pub impulse: f64,
    /// Rate of the distance before and after it, in m/s.
    pub before: f64,
    pub after: f64,
    /// Impulse that ends rebounds too low to be followed.
    pub end: f64,
    pub rests: bool,
}

impl<L: Law> Meeting<'_, L> {
    /// Changes the velocities; the states stand as they were before.
    pub(super) fn run(&self, q: &[f64], v: &mut [f64], states: &[State]) -> Result<Vec<Outcome>> {
        let before = self.rates(v, &vec![0.0; self.sizes.len()]);
        let speeds = self.directions.sizes(v);
        let impulses = self.strike(&before, v)?;
        let after = self.rates(v, &speeds);
        let moment = Moment {
            time: self.time,
            displacement: q,
            velocity: v,
            states,
        };
        let resting = self.resting(&moment, &after)?;
        let ends = self.end_rebounds(&resting, &after, v);
        let outcome = |place: usize| Outcome {
            law: self.directions.laws[place],
            impulse: impulses[place],
            before: before[place],
            after: after[place],
            end: ends[place],
            rests: resting.contains(&place),
        };
        Ok((0..before.len()).map(outcome).collect())
    }

    fn restitution(&self, place: usize) -> f64 {
        let law = &self.problem.laws[self.directions.laws[place]];
        law.restitution().unwrap_or(1.0)
    }

    /// The height below which rebounds are not followed, in m.
    fn lowest(&self, place: usize) -> f64 {
        self.problem.laws[self.directions.laws[place]].resolution() * self.sizes[place]
    }

    /// Rates of the distances, zero where they are rounding: of the terms that they are summed of,
    /// or of what they were summed of before.
    fn rates(&self, v: &[f64], before: &[f64]) -> Vec<f64> {
        let sizes = self.directions.sizes(v).into_iter().zip(before);
        let sizes = sizes.map(|(now, before)| now.max(*before));
        let rates = self.directions.project(v).into_iter().zip(sizes);
        let rate = |(u, size): (f64, f64)| if u.abs() <= NO_RATE * size { 0.0 } else { u };
        rates.map(rate).collect()
    }

    /// Newton's law for all of them together: impulses `s >= 0` and `u+ + e u- >= 0`, one of the
    /// two zero for each.
    fn strike(&self, before: &[f64], v: &mut [f64]) -> Result<Vec<f64>> {
        if before.iter().all(|u| *u >= 0.0) {
            return Ok(vec![0.0; before.len()]);
        }
        let wanted: Vec<f64> = (before.iter().enumerate())
            .map(|(place, u)| (1.0 + self.restitution(place)) * u)
            .collect();
        let impulses = complementarity::solve(&self.directions.delassus(), &wanted)
            .ok_or(Error::NoImpactLaw { time: self.time })?;
        self.directions.add(&impulses, v);
        Ok(impulses)
    }

    /// The stops that the structure goes on to rest on: those that it neither approaches nor
    /// leaves, to the resolution, and whose reactions push.
    fn resting(&self, moment: &Moment<'_>, rates: &[f64]) -> Result<Vec<usize>> {
        let acceleration = moment.free_acceleration(self.problem);
        let noise = self.noise(&acceleration, moment);
        let stays = |place: usize| self.cause != Cause::Leave(self.directions.laws[place]);
        let candidates = || (0..rates.len()).filter(|&place| stays(place));
        let mut held: Vec<usize> = candidates().filter(|&place| rates[place] == 0.0).collect();
        loop {
            let reactions = self.reactions(&held, &acceleration)?;
            let mut pushed = acceleration.clone();
            self.directions.some(&held).add(&reactions, &mut pushed);
            let along = self.directions.project(&pushed);
            let settles = |place: usize| {
                let (rate, inwards) = (rates[place], -along[place]);
                self.restitution(place) < 1.0
                    && rate > 0.0
                    && inwards > noise[place]
                    && rate * rate <= 2.0 * inwards * self.lowest(place)
            };
            let more: Vec<usize> = candidates()
                .filter(|&place| !held.contains(&place) && settles(place))
                .collect();
            if more.is_empty() {
                let holds = |(place, reaction): (usize, f64)| {
                    let touched = self.cause == Cause::Touch(self.directions.laws[place]);
                    let pushes = reaction > 0.0 || touched && along[place] <= noise[place];
                    pushes.then_some(place)
                };
                return Ok(held.into_iter().zip(reactions).filter_map(holds).collect());
            }
            held.extend(more);
        }
    }

    /// Reactions `r >= 0` and accelerations `>= 0` of the distances, one of the two zero for each.
    fn reactions(&self, places: &[usize], acceleration: &[f64]) -> Result<Vec<f64>> {
        let some = self.directions.some(places);
        complementarity::solve(&some.delassus(), &some.project(acceleration))
            .ok_or(Error::NoImpactLaw { time: self.time })
    }

    /// Bounds of the rounding of the distances' accelerations.
    fn noise(&self, acceleration: &[f64], moment: &Moment<'_>) -> Vec<f64> {
        let system = &self.problem.system;
        let mut sizes = Vec::with_capacity(acceleration.len());
        for (mode, a) in acceleration.iter().enumerate() {
            let elastic = system.omega2()[mode] * moment.displacement[mode];
            let damped = system.damping()[mode] * moment.velocity[mode];
            sizes.push(a.abs() + elastic.abs() + damped.abs());
        }
        let sums = self.directions.sizes(&sizes);
        sums.iter().map(|sum| NO_ACCELERATION * sum).collect()
    }

    /// Takes away what is left of the rates of stops that hold.
    fn end_rebounds(&self, resting: &[usize], rates: &[f64], v: &mut [f64]) -> Vec<f64> {
        let mut ends = vec![0.0; rates.len()];
        let some = self.directions.some(resting);
        let lack: Vec<f64> = some.project(v).iter().map(|u| -u).collect();
        let impulses = some.impulses(&lack);
        some.add(&impulses, v);
        // Where one settles all that hold have impulses; else there is nothing but rounding.
        if resting.iter().any(|&place| rates[place] != 0.0) {
            for (place, impulse) in resting.iter().zip(impulses) {
                ends[*place] = impulse;
            }
        }
        ends
    }
}
