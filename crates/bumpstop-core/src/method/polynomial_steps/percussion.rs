//! Impulses of rigid stops in steps of a fixed width.

use crate::impacts::Impact;

/// What a rigid stop did to a structure within one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Percussion {
    pub law: usize,
    /// The end of the step, in s, and its width.
    pub time: f64,
    pub h: f64,
    /// In N s.
    pub impulse: f64,
    /// Rate of the distance at both ends of the step, in m/s.
    pub before: f64,
    pub after: f64,
    /// Energy that friction took, in J.
    pub rubbed: f64,
}

/// Two ends of steps are the same where they differ by less than this part of one.
const SAME: f64 = 0.5;

impl Percussion {
    /// Energy taken from the structure, in J: the rate is linear in the impulse that grows.
    pub(crate) fn loss(&self) -> f64 {
        self.rubbed - 0.5 * self.impulse * (self.before + self.after)
    }

    /// Whether it goes on where another one ends.
    fn follows(&self, other: &Self) -> bool {
        (self.time - self.h - other.time).abs() < SAME * self.h
    }
}

/// The impacts that impulses of one stop make, in order of time: those of steps one after the other
/// are one, which lasts as long; that of a single step takes no time and has no finite force.
pub(crate) fn impacts<'a>(percussions: impl Iterator<Item = &'a Percussion>) -> Vec<Impact> {
    let mut impacts: Vec<Impact> = Vec::new();
    let mut last: Option<&Percussion> = None;
    for each in percussions {
        if !last.is_some_and(|last| each.follows(last)) {
            let mut impact = Impact::starting(each.time, -each.before);
            impact.see_force(each.time, f64::INFINITY);
            impacts.push(impact);
        }
        if let Some(impact) = impacts.last_mut() {
            if each.time > impact.start {
                // It lasts: the force of a step is its mean.
                if impact.peak_force.is_infinite() {
                    impact.peak_force = impact.impulse / each.h;
                }
                impact.see_force(each.time, each.impulse / each.h);
            }
            impact.end = each.time;
            impact.opening_speed = each.after;
            impact.impulse += each.impulse;
            impact.add_work_of_impulse(each.impulse, [each.before, each.after]);
            impact.add_work(-each.rubbed);
        }
        last = Some(each);
    }
    impacts
}
