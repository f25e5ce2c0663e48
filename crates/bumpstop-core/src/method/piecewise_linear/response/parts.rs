//! Numbers for the modes, split into those of the combinations that laws push and of what moves by
//! itself.

use crate::method::piecewise_linear::singles::Subject;
use crate::method::piecewise_linear::spectrum::Spectrum;
use crate::number::Complex;

/// Numbers for the combinations and the singles of a spectrum.
#[derive(Clone)]
pub(super) struct Parts {
    pub combined: Vec<f64>,
    pub singles: Vec<f64>,
}

impl Parts {
    /// Splits numbers for the modes.
    pub(super) fn of(spectrum: &Spectrum, modal: &[f64]) -> Self {
        let mut combined = vec![0.0; spectrum.combinations];
        spectrum.gather(modal, &mut combined);
        let mut own = modal.to_vec();
        for member in &spectrum.members {
            own[member.mode] -= member.weight * combined[member.group];
        }
        let single = |subject: Subject| match subject {
            Subject::Mode(mode) => own[mode],
            Subject::Combination(number) => combined[number],
        };
        let singles = spectrum.singles.iter().map(|s| single(s.subject)).collect();
        Self { combined, singles }
    }

    /// The numbers for the modes again.
    pub(super) fn modes(mut self, spectrum: &Spectrum, modes: usize) -> Vec<f64> {
        let mut modal = vec![0.0; modes];
        for (single, x) in spectrum.singles.iter().zip(&self.singles) {
            match single.subject {
                Subject::Mode(mode) => modal[mode] = *x,
                Subject::Combination(number) => self.combined[number] = *x,
            }
        }
        for member in &spectrum.members {
            modal[member.mode] += member.weight * self.combined[member.group];
        }
        modal
    }
}

/// The same with complex numbers.
pub(super) struct ComplexParts {
    pub combined: Vec<Complex<f64>>,
    pub singles: Vec<Complex<f64>>,
}

impl ComplexParts {
    pub(super) fn zero(spectrum: &Spectrum) -> Self {
        Self {
            combined: vec![Complex::zero(); spectrum.combinations],
            singles: vec![Complex::zero(); spectrum.singles.len()],
        }
    }

    pub(super) fn of_real(parts: &Parts) -> Self {
        let complex = |numbers: &[f64]| numbers.iter().map(|x| Complex::real(*x)).collect();
        Self {
            combined: complex(&parts.combined),
            singles: complex(&parts.singles),
        }
    }

    pub(super) fn of(spectrum: &Spectrum, modal: &[Complex<f64>]) -> Self {
        let part = |of: fn(&Complex<f64>) -> f64| {
            let modal: Vec<f64> = modal.iter().map(of).collect();
            Parts::of(spectrum, &modal)
        };
        let (re, im) = (part(|z| z.re), part(|z| z.im));
        Self {
            combined: paired(&re.combined, &im.combined),
            singles: paired(&re.singles, &im.singles),
        }
    }

    pub(super) fn modes(&self, spectrum: &Spectrum, modes: usize) -> Vec<Complex<f64>> {
        let part = |of: fn(&Complex<f64>) -> f64| {
            let parts = Parts {
                combined: self.combined.iter().map(of).collect(),
                singles: self.singles.iter().map(of).collect(),
            };
            parts.modes(spectrum, modes)
        };
        paired(&part(|z| z.re), &part(|z| z.im))
    }
}

fn paired(re: &[f64], im: &[f64]) -> Vec<Complex<f64>> {
    let both = re.iter().zip(im);
    both.map(|(re, im)| Complex::new(*re, *im)).collect()
}
