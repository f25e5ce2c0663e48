//! Embedded Runge-Kutta pairs with dense output. One file a pair.

mod bogacki_shampine;
mod dop853;
mod dormand_prince;

/// An explicit Runge-Kutta formula with what estimates its error and continues it inside a step.
///
/// Stage i is the derivative at `t + c_i h`, `y + h sum_j a_ij k_j`; the step ends in
/// `y + h sum_i b_i k_i`, and one more stage, number `b.len()`, is the derivative there: the first
/// of the next step.
#[derive(Debug)]
pub(crate) struct Pair {
    /// The method's name.
    pub name: &'static str,
    /// What the error estimate goes with: the power of the step.
    pub error_order: f64,
    pub c: &'static [f64],
    pub a: &'static [&'static [f64]],
    pub b: &'static [f64],
    /// Weights of all stages up to the one at the end. Of two estimates, of the orders five and
    /// three, the second corrects the first: see [`super::control`].
    pub errors: &'static [&'static [f64]],
    /// Stages that only the dense output needs.
    pub extra: &'static [(f64, &'static [f64])],
    /// What the dense output adds to the cubic through both ends: see [`crate::method::polynomial_steps`].
    pub corrections: &'static [&'static [f64]],
}

impl Pair {
    /// How many stages there are.
    pub(crate) fn stages(&self) -> usize {
        self.b.len() + 1 + self.extra.len()
    }

    /// Degree of the dense output in time.
    pub(crate) fn degree(&self) -> usize {
        3 + self.corrections.len()
    }
}

/// The pairs there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PairName {
    /// Bogacki and Shampine, order three.
    Rk32,
    /// Dormand and Prince, order five.
    Rk54,
    /// Dormand and Prince, order eight.
    Dop853,
}

impl PairName {
    /// All pairs.
    pub const ALL: [Self; 3] = [Self::Rk32, Self::Rk54, Self::Dop853];

    /// The method's name.
    pub fn name(self) -> &'static str {
        self.pair().name
    }

    pub(crate) fn pair(self) -> &'static Pair {
        match self {
            Self::Rk32 => &bogacki_shampine::PAIR,
            Self::Rk54 => &dormand_prince::PAIR,
            Self::Dop853 => &dop853::PAIR,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Order of the formula, of its dense output, and of its error estimates.
    fn orders(pair: &Pair) -> (usize, usize, &'static [usize]) {
        match pair.name {
            "rk32" => (3, 3, &[2]),
            "rk54" => (5, 4, &[4]),
            _ => (8, 7, &[5, 3]),
        }
    }

    fn sum(weights: &[f64], values: &[f64]) -> f64 {
        weights.iter().zip(values).map(|(w, x)| w * x).sum()
    }

    /// Abscissae of all stages, and the stages of y' = t^n from t = 0 with h = 1.
    fn abscissae(pair: &Pair) -> Vec<f64> {
        let mut c = pair.c.to_vec();
        c.push(1.0);
        c.extend(pair.extra.iter().map(|(c, _)| *c));
        c
    }

    /// The dense output's weights of the stages at theta.
    fn weights(pair: &Pair, theta: f64) -> Vec<f64> {
        (0..pair.stages())
            .map(|stage| {
                let b = pair.b.get(stage).copied().unwrap_or(0.0);
                let [first, last] = [0, pair.b.len()].map(|at| f64::from(u8::from(at == stage)));
                let mut parts = vec![b, first - b, 2.0 * b - first - last];
                let of = |weights: &&[f64]| weights.get(stage).copied().unwrap_or(0.0);
                parts.extend(pair.corrections.iter().map(of));
                let nested = |sum: f64, (k, part): (usize, &f64)| {
                    (sum + part) * if k % 2 == 0 { theta } else { 1.0 - theta }
                };
                parts.iter().enumerate().rev().fold(0.0, nested)
            })
            .collect()
    }

    #[test]
    fn stages_stand_where_their_weights_sum_to() {
        for name in PairName::ALL {
            let pair = name.pair();
            let rows = pair.a.iter().copied().zip(pair.c.iter().copied());
            let extra = pair.extra.iter().map(|(c, a)| (*a, *c));
            for (weights, c) in rows.chain(extra) {
                assert!((weights.iter().sum::<f64>() - c).abs() < 1e-14, "{name:?}");
            }
        }
    }

    #[test]
    fn formulas_integrate_powers_and_exponentials_at_their_order() {
        for name in PairName::ALL {
            let pair = name.pair();
            let (order, dense, errors) = orders(pair);
            let c = abscissae(pair);
            for power in 0..order {
                let stages: Vec<f64> = c.iter().map(|c| c.powi(power as i32)).collect();
                let whole = 1.0 / (power + 1) as f64;
                assert!((sum(pair.b, &stages) - whole).abs() < 1e-14, "{name:?}");
                for (weights, order) in pair.errors.iter().zip(errors) {
                    let found = sum(weights, &stages).abs();
                    assert_eq!(found < 1e-14, power < *order, "{name:?} {power}: {found}");
                }
                for theta in [0.2, 0.5, 0.9] {
                    let whole = f64::powi(theta, power as i32 + 1) / (power + 1) as f64;
                    let error = (sum(&weights(pair, theta), &stages) - whole).abs();
                    assert_eq!(error < 1e-13, power < dense, "{name:?} {power}: {error}");
                }
            }
        }
    }

    /// y' = y takes in how the stages feed each other.
    #[test]
    fn the_exponential_is_followed_at_the_order() {
        for name in PairName::ALL {
            let pair = name.pair();
            let (order, dense, _) = orders(pair);
            let errors = [0.25, 0.125].map(|h: f64| {
                let mut k: Vec<f64> = Vec::new();
                for a in pair.a {
                    k.push(1.0 + h * sum(a, &k));
                }
                let end = 1.0 + h * sum(pair.b, &k);
                k.push(end);
                for (_, a) in pair.extra {
                    k.push(1.0 + h * sum(a, &k));
                }
                let inside = 1.0 + h * sum(&weights(pair, 0.3), &k);
                [end - h.exp(), inside - (0.3 * h).exp()].map(f64::abs)
            });
            for (place, order) in [order, dense].into_iter().enumerate() {
                let found = (errors[0][place] / errors[1][place]).log2();
                assert!(
                    (found - order as f64 - 1.0).abs() < 0.4,
                    "{name:?}: {found}"
                );
            }
        }
    }
}
