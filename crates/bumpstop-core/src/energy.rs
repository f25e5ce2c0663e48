//! The energy ledger.
//!
//! Kinetic energy, elastic energy and the energy stored in laws are functions of the state;
//! what damping and laws dissipate and what loads give is integrated, each from its own power.
//! None is the remainder of the others, so that the residual says something.

/// The ledger at one instant, in J.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ledger {
    /// Half of the sum of squared modal velocities.
    pub kinetic: f64,
    /// Half of the sum of `omega2 q^2`.
    pub elastic: f64,
    /// Stored in each law.
    pub law_stored: Vec<f64>,
    /// Dissipated by modal damping since t = 0.
    pub modal_dissipation: f64,
    /// Dissipated by each law since t = 0.
    pub law_dissipated: Vec<f64>,
    /// Work of the loads since t = 0.
    pub load_work: f64,
    /// Work of the forces of a circulatory matrix since t = 0.
    pub circulatory_work: f64,
    /// Work of the obstacles that move since t = 0.
    pub obstacle_work: f64,
}

impl Ledger {
    /// Kinetic, elastic and stored energy together.
    pub fn held(&self) -> f64 {
        self.kinetic + self.elastic + self.law_stored.iter().sum::<f64>()
    }

    /// Held plus dissipated minus given: constant in time when the run is right.
    pub fn balance(&self) -> f64 {
        self.held() + self.modal_dissipation + self.law_dissipated.iter().sum::<f64>()
            - self.load_work
            - self.circulatory_work
            - self.obstacle_work
    }

    /// Size of the largest term, the scale of the residual.
    pub fn scale(&self) -> f64 {
        let laws = (self.law_stored.iter().chain(&self.law_dissipated))
            .fold(0.0f64, |m, e| m.max(e.abs()));
        [
            self.kinetic,
            self.elastic,
            self.modal_dissipation,
            self.load_work,
            self.circulatory_work,
            self.obstacle_work,
        ]
        .iter()
        .fold(laws, |m, e| m.max(e.abs()))
    }
}

/// Times what was there and was given, beyond which an energy that comes from nowhere tells that a
/// run has gone wrong. Steps that are merely coarse stay far below it, and one that is unstable
/// passes it soon.
pub(crate) const BLOWN_UP: f64 = 100.0;

/// Tells from the ledger when a run blows up. What dampers and laws take has no say in it: it is
/// integrated along steps that may be far too long for a stiff damper, which then seems to take too
/// much, and gives nothing. What they give, as a law that drives the structure does, counts as given.
#[derive(Debug)]
pub(crate) struct Growth {
    held: f64,
    start: f64,
    given: f64,
    /// See [`swing`].
    swing: f64,
}

impl Growth {
    /// From the ledger at t = 0.
    pub(crate) fn new(ledger: &Ledger) -> Self {
        Self {
            held: ledger.held(),
            start: ledger.scale(),
            given: 0.0,
            swing: 1.0,
        }
    }

    /// For steps that let the energy of a stable run swing by a factor, and whose overshoot may have the
    /// energy `jolt`: that of the velocity which the accelerations at the start make in one step, as HHT
    /// and generalised alpha do of modes far faster than it.
    pub(crate) fn of_steps(ledger: &Ledger, swing: f64, jolt: f64) -> Self {
        let growth = Self::new(ledger);
        Self {
            start: growth.start + jolt,
            swing,
            ..growth
        }
    }

    /// Looks at a later ledger; gives the energy that came from nowhere, over what was there and
    /// was given, where that is too much or no number.
    pub(crate) fn sees(&mut self, ledger: &Ledger) -> Option<f64> {
        let given = [
            ledger.load_work,
            ledger.circulatory_work,
            ledger.obstacle_work,
        ];
        let lost = ledger
            .law_dissipated
            .iter()
            .chain([&ledger.modal_dissipation]);
        let given: f64 = given.iter().map(|work| work.abs()).sum();
        let given = given + lost.map(|lost| (-lost).max(0.0)).sum::<f64>();
        self.given = self.given.max(given);
        let excess = ledger.held() - self.held;
        let known = self.start + self.given;
        let is_calm = excess <= BLOWN_UP * self.swing * known && ledger.balance().is_finite();
        (!is_calm).then_some(excess / known)
    }
}

/// The factor by which the energy of a stable run may swing, with steps that are a given part of the
/// limit. Symplectic Euler keeps `v v / 2 + w w x x / 2 - h w w x v / 2`, which lies between `1 - h w / 2`
/// and `1 + h w / 2` times the energy; what the central difference and Newmark's explicit kin keep,
/// `v v / 2 + (1 - part part) w w x x / 2`, lets it swing less. Beyond the limit there is no bound.
pub(crate) fn swing(part: f64) -> f64 {
    if part < 1.0 {
        (1.0 + part) / (1.0 - part)
    } else {
        1.0
    }
}

/// The mode that has the most energy, if that is a number.
pub(crate) fn largest_share(omega2: &[f64], displacement: &[f64], velocity: &[f64]) -> usize {
    let motion = displacement.iter().zip(velocity);
    let energies = omega2
        .iter()
        .zip(motion)
        .map(|(w2, (q, v))| v * v + w2 * q * q);
    let largest = energies.enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b));
    largest.map_or(0, |(mode, _)| mode)
}

/// Largest change of the balance relative to the largest energy seen.
pub fn residual<'a>(ledgers: impl Iterator<Item = &'a Ledger>) -> f64 {
    let mut first = None;
    let (mut worst, mut scale) = (0.0f64, 0.0f64);
    for ledger in ledgers {
        let start = *first.get_or_insert(ledger.balance());
        let change = (ledger.balance() - start).abs();
        worst = if change > worst || change.is_nan() {
            change
        } else {
            worst
        };
        scale = scale.max(ledger.scale());
    }
    if worst == 0.0 { 0.0 } else { worst / scale }
}

/// Kinetic and elastic energy of a state, in J.
pub fn of_structure(omega2: &[f64], displacement: &[f64], velocity: &[f64]) -> (f64, f64) {
    let kinetic = velocity.iter().map(|v| v * v).sum::<f64>();
    let elastic = (omega2.iter().zip(displacement))
        .map(|(w2, q)| w2 * q * q)
        .sum::<f64>();
    (0.5 * kinetic, 0.5 * elastic)
}
