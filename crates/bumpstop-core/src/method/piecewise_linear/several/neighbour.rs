//! Starts from a set of springs that has one less.
//!
//! One more spring adds a term to the dynamic stiffness of the neighbour. On the neighbour's
//! motions, taken for what they nearly are, real and each with its own damping, that is the
//! secular equation of one spring. Its roots are close enough for the search to begin there.

use super::{Springs, Start};
use crate::method::piecewise_linear::family::Family;
use crate::method::piecewise_linear::rows::{ComplexBlock, Rows, entry};
use crate::method::piecewise_linear::secular::Coupling;
use crate::number::{Complex, Instructions, LANES, Vectorised, dispatch};

/// Part of the largest that every motion is taken to have in the spring's.
const LEAST: f64 = 1e-12;

/// The exponents and vectors of a neighbour, and the spring that it lacks, by number.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Neighbour<'a> {
    pub lambda: &'a [ComplexBlock],
    pub family: &'a Family,
    pub spring: usize,
}

/// One of its motions.
#[derive(Debug, Clone, Copy)]
struct Motion {
    omega2: f64,
    damping: f64,
    /// How the spring sees it.
    phi: f64,
    /// The mode that takes the largest part in it.
    mode: usize,
}

impl Neighbour<'_> {
    /// Where to search; `None` where the secular equation does not tell.
    pub(super) fn starts(&self, springs: &Springs, slow: f64) -> Option<Vec<Start>> {
        let mut motions = self.motions(springs);
        motions.sort_by(|a, b| a.omega2.total_cmp(&b.omega2));
        let largest = motions.iter().fold(0.0f64, |m, motion| m.max(motion.phi));
        let mut coupling = Coupling::default();
        coupling.start(springs.stiffness[self.spring], springs.dampers[self.spring]);
        for motion in &mut motions {
            motion.phi = motion.phi.max(LEAST * largest);
            coupling.push(motion.omega2, motion.damping, motion.phi);
        }
        let apart = |pair: &[Motion]| pair[1].omega2 > pair[0].omega2;
        // Written so that what is no number has no start.
        let is_told = largest > 0.0
            && motions.windows(2).all(apart)
            && motions[0].omega2 >= slow * slow
            && coupling.is_lightly_damped();
        if !is_told {
            return None;
        }
        let roots = dispatch(Roots(&coupling))?;
        let starts = (0..motions.len()).map(|j| {
            let guess = entry(&roots, j);
            let mu = guess.norm2();
            // The root lies between two poles; the motion that takes more of it tells the mode.
            let part = |motion: &Motion| motion.phi / (motion.omega2 - mu).abs();
            let (below, above) = (&motions[j], motions.get(j + 1));
            let nearer = above
                .filter(|above| part(above) > part(below))
                .unwrap_or(below);
            springs.start(nearer.mode, guess)
        });
        Some(starts.collect())
    }

    /// With `2 / n_j` the left vectors are made of the shapes, `phi_j^2 = Re (l_j z_j lambda_j)`
    /// is the spring's factor of a real shape of unit modal mass.
    fn motions(&self, springs: &Springs) -> Vec<Motion> {
        let n = springs.modes();
        let mut seen = vec![[Complex::<f64>::zero(); 2]; n];
        let mut largest = vec![(0.0, 0); n];
        for i in 0..n {
            let phi = springs.phi(i)[self.spring];
            for j in 0..n {
                let shape = entry(self.family.shape(i), j);
                let left = entry(self.family.left_velocity(i), j);
                seen[j][0] = Complex::new(
                    seen[j][0].re + phi * shape.re,
                    seen[j][0].im + phi * shape.im,
                );
                seen[j][1] =
                    Complex::new(seen[j][1].re + phi * left.re, seen[j][1].im + phi * left.im);
                let size = shape.norm2();
                if size > largest[j].0 {
                    largest[j] = (size, i);
                }
            }
        }
        let motion = |j: usize| {
            let lambda = entry(self.lambda, j);
            let phi2 = (seen[j][0] * seen[j][1] * lambda).re;
            Motion {
                omega2: lambda.norm2(),
                damping: -2.0 * lambda.re,
                phi: phi2.max(0.0).sqrt(),
                mode: largest[j].1,
            }
        };
        (0..n).map(motion).collect()
    }
}

/// The roots of a secular equation.
struct Roots<'a>(&'a Coupling);

impl Vectorised for Roots<'_> {
    type Output = Option<Vec<ComplexBlock>>;
    #[inline(always)]
    fn run<I: Instructions>(self) -> Self::Output {
        let n = self.0.omega2.len();
        let width = n.div_ceil(LANES);
        let mut inverses = Rows::zeros(n, width);
        let mut roots = Vec::with_capacity(width);
        for block in 0..width {
            let mut root = ComplexBlock::ZERO;
            root.put(self.0.solve_block::<I>(block, &mut inverses)?);
            roots.push(root);
        }
        Some(roots)
    }
}
