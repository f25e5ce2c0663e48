//! Eigenvalues as distances from damped poles, so that none of their digits is lost near these.

use crate::number::{Complex, Instructions, Lanes, Number};

/// The pole from which each of eight roots is measured: that of a mode by itself.
#[derive(Clone, Copy)]
pub(crate) struct Nearest<I: Instructions> {
    pub omega2: Lanes<I>,
    pub damping: Lanes<I>,
}

impl<I: Instructions> Nearest<I> {
    /// The damped pole itself.
    #[inline(always)]
    pub(crate) fn pole(&self) -> Complex<Lanes<I>> {
        let half = self.damping * Lanes::<I>::of(0.5);
        let im2 = (self.omega2 - half * half).max(Lanes::<I>::of(0.0));
        Complex::new(-half, im2.sqrt())
    }
}

/// Eigenvalues as distances from their nearest poles.
pub(crate) struct Eigenvalue<I: Instructions> {
    origin: Nearest<I>,
    pole: Complex<Lanes<I>>,
    pub delta: Complex<Lanes<I>>,
    pub value: Complex<Lanes<I>>,
}

impl<I: Instructions> Eigenvalue<I> {
    #[inline(always)]
    pub(crate) fn new(origin: Nearest<I>, pole: Complex<Lanes<I>>) -> Self {
        Self {
            origin,
            pole,
            delta: Complex::zero(),
            value: pole,
        }
    }

    #[inline(always)]
    pub(crate) fn set(&mut self, delta: Complex<Lanes<I>>) {
        self.delta = delta;
        self.value = self.pole + delta;
    }

    /// `D_o(s) = delta (2 p_o + c_o + delta)`
    #[inline(always)]
    pub(crate) fn own_pole(&self) -> Complex<Lanes<I>> {
        self.delta * (self.pole + self.value).plus(self.origin.damping)
    }

    /// `delta (2 p_o + delta)`
    #[inline(always)]
    pub(crate) fn near(&self) -> Complex<Lanes<I>> {
        self.delta * (self.pole + self.value)
    }

    /// `D_i(s) = (w_i^2 - w_o^2) + (c_i - c_o) p_o + delta (2 p_o + c_i + delta)`
    #[inline(always)]
    pub(crate) fn pole(
        &self,
        near: Complex<Lanes<I>>,
        omega2: f64,
        damping: f64,
    ) -> Complex<Lanes<I>> {
        let damping = Lanes::<I>::of(damping);
        let apart = Lanes::<I>::of(omega2) - self.origin.omega2;
        let near = self.delta.scale_add(damping, near);
        let drift = self.pole.scale_add(damping - self.origin.damping, near);
        drift.plus(apart)
    }
}
