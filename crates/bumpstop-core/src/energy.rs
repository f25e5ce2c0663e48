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
