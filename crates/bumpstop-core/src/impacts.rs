//! Impacts: one closing of a stop and the reopening after it.

/// One impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// Instant of closing, in s; 0 where the run starts in contact.
    pub start: f64,
    /// Instant of reopening, in s; NaN while still closed at the end of the run.
    pub end: f64,
    /// `-d'` at closing, in m/s.
    pub closing_speed: f64,
    /// `d'` at reopening, in m/s; NaN while still closed.
    pub opening_speed: f64,
    /// Largest force, in N.
    pub peak_force: f64,
    /// Its instant, in s.
    pub peak_time: f64,
    /// Integral of the force, in N s.
    pub impulse: f64,
    /// Work that the structure did on the stop, in J.
    pub energy_absorbed: f64,
    /// Work that the stop did on the structure, in J: the energy given back.
    pub energy_returned: f64,
}

impl Impact {
    /// An impact that starts now.
    pub(crate) fn starting(time: f64, closing_speed: f64) -> Self {
        Self {
            start: time,
            end: f64::NAN,
            closing_speed,
            opening_speed: f64::NAN,
            peak_force: 0.0,
            peak_time: time,
            impulse: 0.0,
            energy_absorbed: 0.0,
            energy_returned: 0.0,
        }
    }

    /// Takes note of a force.
    pub(crate) fn see_force(&mut self, time: f64, force: f64) {
        if force > self.peak_force {
            self.peak_force = force;
            self.peak_time = time;
        }
    }

    /// Adds work done on the structure, returned where positive.
    pub(crate) fn add_work(&mut self, work: f64) {
        if work > 0.0 {
            self.energy_returned += work;
        } else {
            self.energy_absorbed -= work;
        }
    }

    /// Adds the work of an impulse during which the rate of the distance goes from one value to
    /// another: it is linear in the impulse that grows, and changes sign once at most.
    pub(crate) fn add_work_of_impulse(&mut self, impulse: f64, [before, after]: [f64; 2]) {
        if before < 0.0 && after > 0.0 {
            let share = |rate: f64| 0.5 * impulse * rate * rate / (after - before);
            self.add_work(-share(before));
            self.add_work(share(after));
        } else {
            self.add_work(0.5 * impulse * (before + after));
        }
    }
}

/// A law's motion at one step of a fixed-step scheme.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample {
    pub time: f64,
    pub distance: f64,
    pub speed: f64,
    pub force: f64,
    pub in_contact: bool,
}

/// Impacts from samples: crossings by linear interpolation of the distance, impulse and work
/// by the trapezoidal rule, the peak at a sample.
pub(crate) fn from_samples(samples: &[Sample]) -> Vec<Impact> {
    let mut impacts = Vec::new();
    let mut current: Option<Impact> = None;
    let Some(first) = samples.first() else {
        return impacts;
    };
    if first.in_contact {
        let mut impact = Impact::starting(first.time, -first.speed);
        impact.see_force(first.time, first.force);
        current = Some(impact);
    }
    for pair in samples.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        if !a.in_contact && b.in_contact {
            let (time, speed) = crossing(a, b);
            current = Some(Impact::starting(time, -speed));
        }
        if let Some(impact) = &mut current {
            let half = 0.5 * (b.time - a.time);
            impact.impulse += half * (a.force + b.force);
            impact.add_work(half * (a.force * a.speed + b.force * b.speed));
            impact.see_force(b.time, b.force);
        }
        if a.in_contact && !b.in_contact {
            let (time, speed) = crossing(a, b);
            if let Some(mut impact) = current.take() {
                impact.end = time;
                impact.opening_speed = speed;
                impacts.push(impact);
            }
        }
    }
    impacts.extend(current);
    impacts
}

/// Instant and speed at which the distance passes zero between two samples.
fn crossing(a: Sample, b: Sample) -> (f64, f64) {
    let span = a.distance - b.distance;
    let part = if span == 0.0 {
        0.0
    } else {
        (a.distance / span).clamp(0.0, 1.0)
    };
    (
        a.time + part * (b.time - a.time),
        a.speed + part * (b.speed - a.speed),
    )
}
