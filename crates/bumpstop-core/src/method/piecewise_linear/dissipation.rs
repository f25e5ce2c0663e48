//! What dampers take out of a phase that nothing else drives, in closed form.
//!
//! With rates `r_j = a_j lambda_j exp(lambda_j t)` a damped velocity is `Re sum s_j r_j`, and the
//! integral of its square is the difference of a quadratic form of the rates,
//!
//! ```text
//! Re sum_jk [ K_jk r_j r_k + L_jk r_j conj(r_k) ],
//! K_jk = s_j s_k / (2 (lambda_j + lambda_k)),  L_jk = s_j conj(s_k) / (2 (lambda_j + conj lambda_k)).
//! ```
//!
//! Where a sum of two exponents is small beside them, rounding may have made it, and the factors
//! with it: of an oscillation that no damper sees. The quotient may be anything then, and large
//! forms would differ by their rounding. Such products are integrated as they are,
//! `s_j s_k r_j(0) r_k(0) (exp(sigma t) - 1)/sigma` with the sum `sigma`.

use super::cluster::Cluster;
use super::phase::{Phase, Phases, Workspace};
use super::product::grown;
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
                form.until::<I>(&work.rate_at_start[first..], &work.rate[first..], t)
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

/// Part of the exponents' size below which their sum is integrated as it is.
const NEAR: f64 = 1e-4;

/// A quadratic form of the coupled rates, and what is no difference of one.
#[derive(Debug, Clone)]
struct Primitive {
    with: Rows,
    with_conjugate: Rows,
    lasting: Vec<Lasting>,
}

/// A product of two rates that hardly turns.
#[derive(Debug, Clone, Copy)]
struct Lasting {
    first: usize,
    second: usize,
    /// Whether the second is taken conjugate.
    is_conjugate: bool,
    factor: Complex<f64>,
    exponent: Complex<f64>,
}

impl Lasting {
    /// Its integral from the start of a phase, with these rates, to `t` after it.
    fn until(&self, rates_at_start: &[ComplexBlock], t: f64) -> f64 {
        let [first, second] = [self.first, self.second].map(|j| entry(rates_at_start, j));
        let second = if self.is_conjugate {
            second.conj()
        } else {
            second
        };
        (self.factor * first * second).real_product(grown(self.exponent, t))
    }
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
            lasting: Vec::new(),
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
                form.add::<I>([j, b], lambda, [with, conjugate]);
            }
        }
        form
    }

    /// Adds the products of an exponent with those of a block and with their conjugates.
    #[inline(always)]
    fn add<I: Instructions>(
        &mut self,
        [j, b]: [usize; 2],
        lambda: &[ComplexBlock],
        [with, conjugate]: [Complex<Lanes<I>>; 2],
    ) {
        let own = entry(lambda, j);
        let least = NEAR * NEAR * own.norm2();
        let own = Complex::new(Lanes::<I>::of(own.re), Lanes::<I>::of(own.im));
        let other = lambda[b].lanes();
        let (sum, difference) = (own + other, own + other.conj());
        self.with.row_mut(j)[b].put(with * recip_or_zero(sum, least));
        self.with_conjugate.row_mut(j)[b].put(conjugate * recip_or_zero(difference, least));
        self.keep_lasting::<I>([j, b], false, [with, sum], least);
        self.keep_lasting::<I>([j, b], true, [conjugate, difference], least);
    }

    /// Keeps the products of a block whose exponents are small. Those of no size at all belong to
    /// undamped pairs, which do not dissipate.
    #[inline(always)]
    fn keep_lasting<I: Instructions>(
        &mut self,
        [first, block]: [usize; 2],
        is_conjugate: bool,
        [factors, exponents]: [Complex<Lanes<I>>; 2],
        least: f64,
    ) {
        for (lane, size) in exponents.norm2().numbers().into_iter().enumerate() {
            if size == 0.0 || size >= least {
                continue;
            }
            let at =
                |z: Complex<Lanes<I>>| Complex::new(z.re.numbers()[lane], z.im.numbers()[lane]);
            self.lasting.push(Lasting {
                first,
                second: block * LANES + lane,
                is_conjugate,
                factor: at(factors),
                exponent: at(exponents),
            });
        }
    }

    /// Its integral from the start of a phase to `t` after it, with the rates at both.
    #[inline(always)]
    fn until<I: Instructions>(
        &self,
        at_start: &[ComplexBlock],
        at_end: &[ComplexBlock],
        t: f64,
    ) -> f64 {
        let lasting = self.lasting.iter().map(|pair| pair.until(at_start, t));
        self.value::<I>(at_end) - self.value::<I>(at_start) + lasting.sum::<f64>()
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

/// The reciprocal, zero where the square of the modulus is below the least one.
#[inline(always)]
fn recip_or_zero<I: Instructions>(z: Complex<Lanes<I>>, least: f64) -> Complex<Lanes<I>> {
    let norm = z.norm2();
    let (zero, inverse) = (Lanes::<I>::of(0.0), Lanes::<I>::of(1.0) / norm);
    z.conj()
        .scale(norm.select_less(Lanes::of(least), zero, inverse))
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

#[cfg(test)]
mod tests {
    use super::super::rows::set_entry;
    use super::*;
    use crate::number::Plain;

    /// What a damper of strength one takes out of two exponentials with these exponents, factors
    /// and rates.
    fn taken([lambda, row, rate]: [[Complex<f64>; 2]; 3], t: f64) -> f64 {
        let blocks = [lambda, row, rate].map(|entries| {
            let mut block = [ComplexBlock::ZERO];
            entries
                .into_iter()
                .enumerate()
                .for_each(|(j, z)| set_entry(&mut block, j, z));
            block
        });
        let [lambda, row, at_start] = blocks;
        let mut at_end = [ComplexBlock::ZERO];
        for j in 0..2 {
            let turn = entry(&lambda, j).scale(t).exp();
            set_entry(&mut at_end, j, entry(&at_start, j) * turn);
        }
        let form = Primitive::new::<Plain>(&lambda, &[&row], &[1.0]);
        form.until::<Plain>(&at_start, &at_end, t)
    }

    /// The factor and the real part of the exponent are what rounding leaves of an undamped motion
    /// that the damper does not see.
    #[test]
    fn rounding_takes_nothing_out() {
        let none = Complex::zero();
        for growth in [-1e-43, 1e-43, -1e-25, 1e-17] {
            let lambda = [Complex::new(growth, 1522.0), none];
            let row = [Complex::new(1e-15, -3e-16), none];
            let rate = [Complex::new(0.4, 0.7), none];
            let found = taken([lambda, row, rate], 2e-3);
            assert!(found.abs() < 1e-30, "{growth:e}: {found:e}");
        }
    }

    /// `integral of (cos w x + exp(-d x) cos w x)^2` and the like, by quadrature.
    #[test]
    fn lightly_and_heavily_damped_pairs_give_their_energy() {
        let t = 0.3;
        for damping in [1e-12, 1e-7, 1e-5, 1e-3, 0.3, 40.0] {
            let lambda = [
                Complex::new(-damping, 25.0),
                Complex::new(-2.0 * damping, 25.0),
            ];
            let row = [Complex::new(0.8, 0.1), Complex::new(-0.3, 0.6)];
            let rate = [Complex::new(0.4, 0.7), Complex::new(1.1, -0.2)];
            let speed = |x: f64| -> f64 {
                let terms =
                    (0..2).map(|j| (row[j] * rate[j]).real_product(lambda[j].scale(x).exp()));
                terms.sum()
            };
            let expected = integral(t, 200.0, |x| speed(x).powi(2));
            let found = taken([lambda, row, rate], t);
            assert!(
                (found - expected).abs() < f64::EPSILON / NEAR,
                "{damping:e}: {found} {expected}"
            );
        }
    }
}
