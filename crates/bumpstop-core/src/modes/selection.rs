//! The lowest modes, those of a band or those around a shift, of sparse matrices, with the proof
//! that none is missing among them.

use super::Modes;
use super::factor::Factor;
use super::lanczos::{Lanczos, Wanted};
use super::pencil::Pencil;
use super::sturm::{Count, count, count_between, count_beyond};
use crate::error::{Error, Result};
use faer::{Mat, MatRef};

/// Shifts off zero begin at this part of a dof's own stiffness over its mass.
const SMALL_SHIFT: f64 = 1e-10;

/// Eigenvalues known this well can be told apart from their neighbours.
const KNOWN: f64 = 1e-6;

/// The least relative distance of two eigenvalues between which a count is taken.
const GAP: f64 = 1e-5;

/// How often missed eigenvalues are looked for.
const ATTEMPTS: usize = 4;

/// Which modes are asked for; numbers are squared angular frequencies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Selection {
    /// So many of the lowest.
    Lowest(usize),
    /// All from one number to another, both included.
    Band {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// So many nearest to a number.
    Around {
        /// The number.
        shift: f64,
        /// How many.
        count: usize,
    },
}

/// All flexible modes of a range, which holds those that were asked for.
#[derive(Debug, Clone)]
pub struct Selected {
    /// The flexible modes of the range; the rigid ones are the caller's.
    pub modes: Modes,
    /// The count at the lower end of the range; none where it has no lower end.
    pub low: Option<Count>,
    /// The count at the upper end.
    pub high: Count,
}

/// Finds modes of K and M, given all motions that strain nothing.
///
/// `rigid` holds the latter, M-orthonormal; they count as eigenvalues of exactly zero.
///
/// # Errors
/// [`Error::TooManyModes`], [`Error::Eigenvalues`], [`Error::Uncertain`], [`Error::Singular`],
/// [`Error::Sizes`], [`Error::IndefiniteMass`], [`Error::Memory`], [`Error::Factorisation`].
pub fn selected_modes(
    pencil: &Pencil,
    rigid: MatRef<f64>,
    selection: Selection,
) -> Result<Selected> {
    if rigid.nrows() != pencil.size() {
        return Err(Error::Sizes {
            what: "the matrices and the rigid motions",
        });
    }
    let search = Search { pencil, rigid };
    match selection {
        Selection::Lowest(count) => search.lowest(count),
        Selection::Band { low, high } => search.band(low, high),
        Selection::Around { shift, count } => search.around(shift, count),
    }
}

/// What every selection searches in.
struct Search<'a> {
    pencil: &'a Pencil,
    rigid: MatRef<'a, f64>,
}

/// A factor of `K - shift M`.
struct Shifted {
    shift: f64,
    factor: Factor,
}

/// So many sorted values lie before a gap, which is wide enough to take a count in it.
struct Gap {
    before: usize,
    low: f64,
    high: f64,
}

impl Search<'_> {
    fn lowest(&self, count: usize) -> Result<Selected> {
        self.check_count(count)?;
        let Shifted { shift, factor } = self.factored_below_zero()?;
        let below = factor.negative;
        let wanted = count.saturating_sub(self.rigid.ncols().max(below));
        let mut lanczos = Lanczos::new(self.pencil, &factor, self.rigid)?;
        let gap = self.grown(wanted, |more| {
            let above = wanted + more;
            lanczos.converge(Wanted::Sides { below, above })?;
            let known = lanczos.known(KNOWN)?.into_iter().rev().filter(|&t| t > 0.0);
            let omega2 = known.map(|theta| shift + 1.0 / theta);
            Ok((omega2.collect(), lanczos.is_complete()))
        })?;
        let above = gap.before;
        let found = converged(lanczos, Wanted::Sides { below, above })?;
        drop(factor);
        let high = count_between(self.pencil, gap.low, gap.high)?;
        let modes = self.completed(found, shift, None, high)?;
        Ok(Selected {
            modes,
            low: None,
            high,
        })
    }

    fn band(&self, low: f64, high: f64) -> Result<Selected> {
        let middle = 0.5 * low + 0.5 * high;
        let low = match low {
            0.0 => count(self.pencil, self.small_shifts())?,
            _ => count_beyond(self.pencil, low, middle)?,
        };
        let high = count_beyond(self.pencil, high, middle)?;
        let mut found = Mat::zeros(self.pencil.size(), 0);
        let told = self.flexible(Some(low), high);
        if told > 0 {
            let Shifted { shift, factor } = self.factored_near(middle, high.at - low.at)?;
            let below = factor.negative;
            let at = shift;
            let below = self.flexible(Some(low), Count { at, below });
            let above = told - below;
            let lanczos = Lanczos::new(self.pencil, &factor, self.rigid)?;
            found = converged(lanczos, Wanted::Sides { below, above })?;
        }
        let modes = self.completed(found, middle, Some(low), high)?;
        Ok(Selected {
            modes,
            low: Some(low),
            high,
        })
    }

    fn around(&self, centre: f64, count: usize) -> Result<Selected> {
        self.check_count(count)?;
        let near = centre.abs().max(self.pencil.scale() * SMALL_SHIFT);
        let Shifted { shift, factor } = self.factored_near(centre, near)?;
        let mut lanczos = Lanczos::new(self.pencil, &factor, self.rigid)?;
        let rigid = self.rigid.ncols();
        let flexible = self.pencil.size() - rigid;
        let gap = self.grown(count, |more| {
            lanczos.converge(Wanted::Nearest((count + more).min(flexible)))?;
            let known = lanczos.known(KNOWN)?.into_iter();
            let mut away: Vec<f64> = known.map(|theta| (1.0 / theta).abs()).collect();
            away.extend(std::iter::repeat_n(shift.abs(), rigid));
            away.sort_by(f64::total_cmp);
            Ok((away, lanczos.is_complete()))
        })?;
        let rigid_inside = if shift.abs() <= gap.low { rigid } else { 0 };
        let found = converged(lanczos, Wanted::Nearest(gap.before - rigid_inside))?;
        drop(factor);
        let low = count_between(self.pencil, shift - gap.high, shift - gap.low)?;
        let high = count_between(self.pencil, shift + gap.low, shift + gap.high)?;
        let modes = self.completed(found, shift, Some(low), high)?;
        Ok(Selected {
            modes,
            low: Some(low),
            high,
        })
    }

    /// Asks for more values until a gap follows the wanted ones.
    fn grown(
        &self,
        wanted: usize,
        mut values: impl FnMut(usize) -> Result<(Vec<f64>, bool)>,
    ) -> Result<Gap> {
        let mut more = 1;
        loop {
            let (values, all) = values(more)?;
            let start = if self.rigid.ncols() > 0 {
                0.0
            } else {
                f64::NEG_INFINITY
            };
            if let Some(gap) = gap_after(&values, wanted, start) {
                return Ok(gap);
            }
            if all {
                let low = values.last().copied().unwrap_or(0.0);
                return Ok(Gap {
                    before: values.len(),
                    low,
                    high: low + low.abs() + self.pencil.scale(),
                });
            }
            more *= 4;
        }
    }

    /// Adds what a count tells is missing, and leaves out what lies outside the range.
    fn completed(
        &self,
        mut vectors: Mat<f64>,
        shift: f64,
        low: Option<Count>,
        high: Count,
    ) -> Result<Modes> {
        let told = self.flexible(low, high);
        let from = low.map_or(f64::NEG_INFINITY, |count| count.at);
        for _ in 0..ATTEMPTS {
            let mut modes = self.modes(&vectors);
            modes.retain(|omega2| from < omega2 && omega2 < high.at);
            let found = modes.omega2.len();
            if found == told {
                return Ok(modes);
            }
            if found > told {
                break;
            }
            let fixed = beside(self.rigid, vectors.as_ref());
            let Shifted { factor, .. } = self.factored_near(shift, shift)?;
            let lanczos = Lanczos::new(self.pencil, &factor, fixed.as_ref())?;
            let missed = converged(lanczos, Wanted::Nearest(told - found))?;
            vectors = beside(vectors.as_ref(), missed.as_ref());
        }
        Err(Error::Uncertain {
            low: from,
            high: high.at,
            told,
        })
    }

    /// Number of flexible modes from one count to another.
    fn flexible(&self, low: Option<Count>, high: Count) -> usize {
        let (from, below) = low.map_or((f64::NEG_INFINITY, 0), |count| (count.at, count.below));
        let rigid = if from < 0.0 && 0.0 < high.at {
            self.rigid.ncols()
        } else {
            0
        };
        high.below.saturating_sub(below + rigid)
    }

    fn modes(&self, vectors: &Mat<f64>) -> Modes {
        let quotient = |c| self.pencil.quotient(vectors.as_ref(), c);
        let omega2: Vec<f64> = (0..vectors.ncols()).map(quotient).collect();
        let mut order: Vec<usize> = (0..omega2.len()).collect();
        order.sort_by(|&a, &b| omega2[a].total_cmp(&omega2[b]));
        Modes {
            shapes: Mat::from_fn(vectors.nrows(), order.len(), |r, c| vectors[(r, order[c])]),
            omega2: order.into_iter().map(|i| omega2[i]).collect(),
        }
    }

    /// Factors at zero, or just below it where the matrix is singular there.
    fn factored_below_zero(&self) -> Result<Shifted> {
        let zero = if self.rigid.ncols() == 0 {
            Some(0.0)
        } else {
            None
        };
        self.factored_at(zero.into_iter().chain(self.small_shifts()))
    }

    /// Factors at a shift, or beside it where it is an eigenvalue.
    fn factored_near(&self, shift: f64, width: f64) -> Result<Shifted> {
        let parts = [0.0, 1e-3, -1e-3, 1e-2, -1e-2];
        self.factored_at(parts.map(|part| shift + part * width))
    }

    fn factored_at(&self, shifts: impl IntoIterator<Item = f64>) -> Result<Shifted> {
        let mut refused = Error::Factorisation;
        for shift in shifts {
            let factor = self.pencil.factored(shift)?;
            match factor.singularity() {
                None => return Ok(Shifted { shift, factor }),
                Some(error) => refused = error,
            }
        }
        Err(refused)
    }

    /// Negative shifts, small beside the eigenvalues that the matrices resolve.
    fn small_shifts(&self) -> impl Iterator<Item = f64> {
        let least = SMALL_SHIFT * self.pencil.scale();
        [1.0, 1e2, 1e4].into_iter().map(move |part| -part * least)
    }

    fn check_count(&self, asked: usize) -> Result<()> {
        let available = self.pencil.size();
        if asked > available {
            return Err(Error::TooManyModes { asked, available });
        }
        Ok(())
    }
}

/// The first gap behind at least `wanted` of the sorted values, the first of which lies
/// somewhere above `start`.
fn gap_after(values: &[f64], wanted: usize, start: f64) -> Option<Gap> {
    (wanted..values.len()).find_map(|before| {
        let high = values[before];
        let low = match before {
            0 if start.is_finite() => start,
            0 => high - high.abs(),
            _ => values[before - 1],
        };
        let wide = high - low > GAP * high.abs().max(low.abs());
        wide.then_some(Gap { before, low, high })
    })
}

fn converged(mut lanczos: Lanczos, wanted: Wanted) -> Result<Mat<f64>> {
    if wanted.count() == 0 {
        return Ok(Mat::zeros(lanczos.size(), 0));
    }
    lanczos.converge(wanted)?;
    lanczos.vectors(wanted)
}

fn beside(left: MatRef<f64>, right: MatRef<f64>) -> Mat<f64> {
    let first = left.ncols();
    Mat::from_fn(left.nrows(), first + right.ncols(), |r, c| {
        if c < first {
            left[(r, c)]
        } else {
            right[(r, c - first)]
        }
    })
}
