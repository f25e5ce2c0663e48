//! Natural modes: the symmetric eigenproblem `K x = omega^2 M x`.
//!
//! Few dofs are solved with [`dense`] matrices. Many are kept sparse: [`lanczos`] finds the
//! eigenvalues nearest to a shift by solves with a [`factor`] of `K - s M`, and [`sturm`] counts
//! prove that none was missed; [`selection`] puts both together.

pub mod dense;
mod dissection;
mod elimination;
pub mod factor;
mod graph;
mod grouping;
mod lanczos;
pub mod pencil;
pub mod selection;
pub mod sturm;

use faer::Mat;

/// Modes of an undamped structure.
#[derive(Debug, Clone)]
pub struct Modes {
    /// Squared angular frequencies in ascending order, in rad2/s2.
    pub omega2: Vec<f64>,
    /// Shapes with unit modal mass, one column a mode.
    pub shapes: Mat<f64>,
}

impl Modes {
    fn retain(&mut self, wanted: impl Fn(f64) -> bool) {
        let kept: Vec<usize> = (0..self.omega2.len())
            .filter(|&i| wanted(self.omega2[i]))
            .collect();
        let shapes = &self.shapes;
        self.shapes = Mat::from_fn(shapes.nrows(), kept.len(), |r, c| shapes[(r, kept[c])]);
        self.omega2 = kept.into_iter().map(|i| self.omega2[i]).collect();
    }
}
