//! What dampers take out of a phase that nothing else drives, in closed form.
//!
//! With rates `r_j = a_j lambda_j exp(lambda_j t)` a damped velocity is `Re sum s_j r_j`, and the
//! integral of its square is the difference of a quadratic form of the rates,
//!
//! ```text
//! Re sum_jk [ K_jk r_j r_k + L_jk r_j conj(r_k) ],
//! K_jk = s_j s_k / (2 (lambda_j + lambda_k)),  L_jk = s_j conj(s_k) / (2 (lambda_j + conj lambda_k)).
//! ```

use super::cluster::Cluster;
use super::phase::{Phase, Phases, Workspace};
use super::quadrature::integral;
use super::rows::{ComplexBlock, Rows, entry};
use super::single_mode::Rates;
use super::singles::Single;
use super::spectrum::Spectrum;
use super::view::View;
use super::works::{Powers, Works, damper};
use crate::law::Law;
use crate::number::{Complex, Instructions, LANES, Lanes, Number};
use crate::problem::Problem;
use std::borrow::Cow;
use std::cell::OnceCell;
use std::ops::Range;

/// Squares of the rates of coupled exponents that lie together.
#[derive(Debug, Clone)]
struct Form {
    /// Where their blocks begin.
    first_block: usize,
    squares: Squares,
}

#[derive(Debug, Clone)]
enum Squares {
    /// Where every column is an exponent.
    Closed(Primitive),
    /// Where some belong to clusters: dampers as rows of the rates, each with its constant.
    Quadrature(Vec<(Vec<ComplexBlock>, f64)>),
}

impl Form {
    /// The form of `sum_g factor_g (Re sum_j row_gj r_j)^2` over some blocks of exponents, which
    /// the rows are of.
    #[inline(always)]
    fn new<I: Instructions>(
        spectrum: &Spectrum,
        blocks: Range<usize>,
        rows: &[&[ComplexBlock]],
        factors: &[f64],
    ) -> Self {
        let is_clustered = |cluster: &Cluster| blocks.contains(&(cluster.at / LANES));
        let squares = if spectrum.clusters.iter().any(is_clustered) {
            let dampers = rows.iter().zip(factors);
            let dampers = dampers.filter(|(_, factor)| **factor != 0.0);
            Squares::Quadrature(
                dampers
                    .map(|(row, factor)| (row.to_vec(), *factor))
                    .collect(),
            )
        } else {
            let lambda = &spectrum.lambda[blocks.clone()];
            Squares::Closed(Primitive::new::<I>(lambda, rows, factors))
        };
        Self {
            first_block: blocks.start,
            squares,
        }
    }

    /// The same for rows of all exponents.
    #[inline(always)]
    fn of_whole_rows<I: Instructions>(
        spectrum: &Spectrum,
        rows: &[Cow<'_, [ComplexBlock]>],
        factors: &[f64],
    ) -> Self {
        let is_seen = |block: &usize| rows.iter().any(|row| row[*block] != ComplexBlock::ZERO);
        let mut seen = (0..spectrum.coupled_width).filter(is_seen);
        let first = seen.next().unwrap_or(0);
        let blocks = first..seen.next_back().unwrap_or(first) + 1;
        let rows: Vec<&[ComplexBlock]> = rows.iter().map(|row| &row[blocks.clone()]).collect();
        Self::new::<I>(spectrum, blocks, &rows, factors)
    }

    /// Its integral from the start of a phase to `t` after it; the workspace holds the rates there.
    #[inline(always)]
    fn until<I: Instructions>(
        &self,
        phases: &Phases,
        phase: Phase,
        t: f64,
        work: &Workspace,
    ) -> f64 {
        let first = self.first_block;
        match &self.squares {
            Squares::Closed(form) => {
                form.value::<I>(&work.rate[first..]) - form.value::<I>(&work.rate_at_start[first..])
            }
            Squares::Quadrature(dampers) => {
                let pace = 2.0 * phases.spectra[phase.spectrum].pace();
                let power = |work: &Workspace| -> f64 {
                    (dampers.iter())
                        .map(|(row, factor)| {
                            let rate = real_product(row, &work.rate[first..]);
                            factor * rate * rate
                        })
                        .sum()
                };
                let mut other = Workspace::default();
                integral(t, pace, |t| {
                    phases.turn::<I>(phase, t, &mut other);
                    power(&other)
                })
            }
        }
    }
}

fn real_product(row: &[ComplexBlock], rates: &[ComplexBlock]) -> f64 {
    let mut total = 0.0;
    for (row, rate) in row.iter().zip(rates) {
        for lane in 0..LANES {
            total += row.re[lane] * rate.re[lane] - row.im[lane] * rate.im[lane];
        }
    }
    total
}

/// A quadratic form of the coupled rates.
#[derive(Debug, Clone)]
struct Primitive {
    with: Rows,
    with_conjugate: Rows,
}

impl Primitive {
    /// The form of `sum_g factor_g (Re sum_j row_gj r_j)^2`.
    #[inline(always)]
    fn new<I: Instructions>(
        lambda: &[ComplexBlock],
        rows: &[&[ComplexBlock]],
        factors: &[f64],
    ) -> Self {
        let width = lambda.len();
        let mut form = Self {
            with: Rows::zeros(width * LANES, width),
            with_conjugate: Rows::zeros(width * LANES, width),
        };
        for j in 0..width * LANES {
            let own = entry(lambda, j);
            if own.re == 0.0 && own.im == 0.0 {
                continue;
            }
            for b in 0..width {
                let (mut with, mut conjugate) =
                    (Complex::<Lanes<I>>::zero(), Complex::<Lanes<I>>::zero());
                for (row, factor) in rows.iter().zip(factors) {
                    let mine = entry(row, j).scale(0.5 * factor);
                    let mine = Complex::new(Lanes::<I>::of(mine.re), Lanes::<I>::of(mine.im));
                    let other = row[b].lanes();
                    with += mine * other;
                    conjugate += mine * other.conj();
                }
                let own = Complex::new(Lanes::<I>::of(own.re), Lanes::<I>::of(own.im));
                let other = lambda[b].lanes();
                form.with.row_mut(j)[b].put(with * recip_or_zero(own + other));
                let between = conjugate * recip_or_zero(own + other.conj());
                form.with_conjugate.row_mut(j)[b].put(between);
            }
        }
        form
    }

    #[inline(always)]
    fn value<I: Instructions>(&self, rates: &[ComplexBlock]) -> f64 {
        let width = self.with.width();
        let mut total = 0.0;
        for j in 0..width * LANES {
            let own = entry(rates, j);
            let mut inner = Complex::<Lanes<I>>::zero();
            let rows = self.with.row(j).iter().zip(self.with_conjugate.row(j));
            for (other, (with, conjugate)) in rates.iter().zip(rows) {
                let other = other.lanes();
                inner = with.lanes().mul_add(other, inner);
                inner = conjugate.lanes().mul_add(other.conj(), inner);
            }
            total += own.re * inner.re.total() - own.im * inner.im.total();
        }
        total
    }
}

/// An undamped pair does not dissipate: its form is zero, not zero by zero.
#[inline(always)]
fn recip_or_zero<I: Instructions>(z: Complex<Lanes<I>>) -> Complex<Lanes<I>> {
    let norm = z.norm2();
    let zero = Lanes::<I>::of(0.0);
    z.conj()
        .scale(zero.select_less(norm, Lanes::<I>::of(1.0) / norm, zero))
}

/// The forms of one spectrum.
#[derive(Debug, Clone)]
pub(crate) struct Dissipation {
    modal: Vec<Form>,
    laws: Vec<Option<Form>>,
}

impl Dissipation {
    /// The forms for the laws' states of a spectrum, whose powers are all those of dampers.
    #[inline(always)]
    pub(crate) fn new<I: Instructions, L: Law>(
        problem: &Problem<L>,
        powers: &OnceCell<Powers>,
        spectrum: &Spectrum,
    ) -> Self {
        let mut laws = Vec::with_capacity(problem.laws.len());
        let mut first_view = 0;
        for (law, state) in problem.laws.iter().zip(&spectrum.states) {
            let views = &spectrum.views[first_view..];
            first_view += law.rows().len();
            let power = law.dissipation(*state);
            let (mut rows, mut constants) = (Vec::new(), Vec::new());
            for (coordinate, constant) in power.products().iter().filter_map(damper) {
                rows.push(views[coordinate].whole(&spectrum.clusters));
                constants.push(constant);
            }
            let acts = spectrum.groups > 0 && !rows.is_empty();
            laws.push(acts.then(|| Form::of_whole_rows::<I>(spectrum, &rows, &constants)));
        }
        Self {
            modal: modal_forms::<I, L>(problem, powers, spectrum),
            laws,
        }
    }

    /// What is dissipated from the start of a phase to `t` after it.
    #[inline(always)]
    pub(crate) fn until<I: Instructions>(
        &self,
        phases: &Phases,
        phase: Phase,
        t: f64,
        work: &mut Workspace,
    ) -> Works {
        let spectrum = &phases.spectra[phase.spectrum];
        let mut total = Works::none(self.laws.len());
        phases.turn::<I>(phase, 0.0, work);
        work.rate_at_start.clone_from(&work.rate);
        phases.turn::<I>(phase, t, work);
        for form in &self.modal {
            total.modal += form.until::<I>(phases, phase, t, work);
        }
        for (law, form) in total.laws.iter_mut().zip(&self.laws) {
            if let Some(form) = form {
                *law = form.until::<I>(phases, phase, t, work);
            }
        }
        let Workspace {
            rate,
            rate_at_start,
            ..
        } = work;
        for (index, single) in spectrum.singles.iter().enumerate() {
            let kept = phases.kept(phase, index);
            let rates = [rates_of(single, rate_at_start), rates_of(single, rate)];
            let dissipated = single.motion.dissipation(kept, t, rates);
            total.modal += single.modal_share * dissipated;
            if let Some(law) = single.law {
                total.laws[law] += (1.0 - single.modal_share) * dissipated;
            }
        }
        total
    }
}

/// The forms of the structure's own damping.
#[inline(always)]
fn modal_forms<I: Instructions, L: Law>(
    problem: &Problem<L>,
    powers: &OnceCell<Powers>,
    spectrum: &Spectrum,
) -> Vec<Form> {
    let mut forms = Vec::new();
    if spectrum.groups == 0 {
        return forms;
    }
    if problem.system.coupling().is_some() || spectrum.held.is_some() {
        let powers = Powers::in_cell(powers, problem);
        forms.push(form_of_dampers::<I>(powers, spectrum));
        return forms;
    }
    for family in spectrum.families() {
        let damping = family.own(&spectrum.group_damping);
        if damping.iter().all(|c| *c == 0.0) {
            continue;
        }
        let mut rows = Vec::with_capacity(family.groups);
        for group in 0..family.groups {
            rows.push(family.shape(group));
        }
        forms.push(Form::new::<I>(spectrum, family.blocks(), &rows, damping));
    }
    forms
}

/// The form of the dampers of a structure whose velocities are coupled.
#[inline(always)]
fn form_of_dampers<I: Instructions>(powers: &Powers, spectrum: &Spectrum) -> Form {
    let mut views = Vec::with_capacity(powers.dampers.len());
    let mut combined = Vec::new();
    for damper in &powers.dampers {
        let mut view = View::default();
        view.set::<I>(spectrum, &damper.row, &mut combined);
        views.push(view);
    }
    let rows: Vec<_> = (views.iter())
        .map(|view| view.whole(&spectrum.clusters))
        .collect();
    let constants: Vec<f64> = powers.dampers.iter().map(|d| d.constant).collect();
    Form::of_whole_rows::<I>(spectrum, &rows, &constants)
}

/// The rates of a single motion's own exponentials.
fn rates_of(single: &Single, rates: &[ComplexBlock]) -> Rates {
    let mut own = [Complex::zero(); 2];
    for (i, own) in own.iter_mut().enumerate().take(single.motion.exponents().1) {
        *own = entry(rates, single.at + i);
    }
    own
}
