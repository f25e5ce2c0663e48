//! What damping takes out of a phase, in closed form.
//!
//! With rates `r_j = a_j lambda_j exp(lambda_j t)` a damped velocity is `Re sum s_j r_j`, and the
//! integral of its square is the difference of a quadratic form of the rates,
//!
//! ```text
//! Re sum_jk [ K_jk r_j r_k + L_jk r_j conj(r_k) ],
//! K_jk = s_j s_k / (2 (lambda_j + lambda_k)),  L_jk = s_j conj(s_k) / (2 (lambda_j + conj lambda_k)).
//! ```

use super::phase::{Phase, Phases, Workspace};
use super::spectrum::{Rows, Spectrum};
use crate::law::{Law, Piece};
use crate::number::{Complex, Instructions, LANES, Lanes, Number};
use crate::problem::Problem;

/// A quadratic form of the coupled rates.
#[derive(Debug, Clone)]
struct Form {
    with: Rows,
    with_conjugate: Rows,
}

impl Form {
    /// The form of `sum_g factor_g (Re sum_j rows_gj r_j)^2`.
    #[inline(always)]
    fn new<I: Instructions>(spectrum: &Spectrum, rows: &Rows, factors: &[f64]) -> Self {
        let stride = spectrum.coupled_stride;
        let mut form = Self {
            with: Rows::zeros(stride, stride),
            with_conjugate: Rows::zeros(stride, stride),
        };
        for j in 0..stride {
            let own = spectrum.lambda.get(0, j);
            if own.re == 0.0 && own.im == 0.0 {
                continue;
            }
            for o in (0..stride).step_by(LANES) {
                let (mut with, mut conjugate) =
                    (Complex::<Lanes<I>>::zero(), Complex::<Lanes<I>>::zero());
                for (g, factor) in factors.iter().enumerate() {
                    let mine = rows.get(g, j).scale(0.5 * factor);
                    let mine = Complex::new(Lanes::<I>::of(mine.re), Lanes::<I>::of(mine.im));
                    let other = rows.lanes(g, o);
                    with += mine * other;
                    conjugate += mine * other.conj();
                }
                let own = Complex::new(Lanes::<I>::of(own.re), Lanes::<I>::of(own.im));
                let other = spectrum.lambda.lanes(0, o);
                form.with.put(j, o, with * recip_or_zero(own + other));
                let between = conjugate * recip_or_zero(own + other.conj());
                form.with_conjugate.put(j, o, between);
            }
        }
        form
    }

    #[inline(always)]
    fn value<I: Instructions>(&self, rates: &Rows) -> f64 {
        let stride = self.with.stride;
        let mut total = 0.0;
        for j in 0..stride {
            let own = rates.get(0, j);
            let mut inner = Complex::<Lanes<I>>::zero();
            for o in (0..stride).step_by(LANES) {
                let other = rates.lanes(0, o);
                inner += self.with.lanes(j, o) * other;
                inner += self.with_conjugate.lanes(j, o) * other.conj();
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
    modal: Option<Form>,
    laws: Vec<Option<Form>>,
}

/// Energies that damping took, in J.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Dissipated {
    pub modal: f64,
    pub laws: Vec<f64>,
}

impl Dissipation {
    /// The forms for the laws' states of a spectrum.
    #[inline(always)]
    pub(crate) fn new<I: Instructions, L: Law>(problem: &Problem<L>, spectrum: &Spectrum) -> Self {
        let damped = spectrum.group_damping.iter().any(|c| *c != 0.0);
        let mut first_view = 0;
        let laws = (problem.laws.iter().zip(&spectrum.states))
            .map(|(law, state)| {
                let view = first_view;
                first_view += law.rows().len();
                let piece = law.piece(*state).unwrap_or(Piece::FREE);
                let factor = piece.damping[0][0];
                (factor != 0.0 && spectrum.groups > 0)
                    .then(|| Form::new::<I>(spectrum, &spectrum.views[view].exponents, &[factor]))
            })
            .collect();
        Self {
            modal: damped
                .then(|| Form::new::<I>(spectrum, &spectrum.shape, &spectrum.group_damping)),
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
    ) -> Dissipated {
        let spectrum = &phases.spectra[phase.spectrum];
        let mut total = Dissipated {
            modal: 0.0,
            laws: vec![0.0; self.laws.len()],
        };
        if self.modal.is_some() || self.laws.iter().any(Option::is_some) {
            for (instant, sign) in [(0.0, -1.0), (t, 1.0)] {
                phases.turn::<I>(phase, instant, work);
                if let Some(form) = &self.modal {
                    total.modal += sign * form.value::<I>(&work.rate);
                }
                for (law, form) in total.laws.iter_mut().zip(&self.laws) {
                    *law += sign * form.as_ref().map_or(0.0, |f| f.value::<I>(&work.rate));
                }
            }
        }
        for (index, single) in spectrum.singles.iter().enumerate() {
            let (x0, v0) = phases.kept(phase, index);
            let dissipated = single.motion.dissipation(x0, v0, t);
            total.modal += single.modal_share * dissipated;
            if let Some(law) = single.law {
                total.laws[law] += (1.0 - single.modal_share) * dissipated;
            }
        }
        total
    }
}
