//! The spectrum of one combination of law states: every motion of a phase is a constant plus
//! exponentials, and this says which.
//!
//! Modes that the acting laws couple share eigenvalues, shapes and left vectors; the others
//! move by themselves. Modes that are alike (same `omega2`, same damping) and pushed by one law
//! only are split into the combination that it pushes and the rest that it does not see.

use super::dense;
use super::secular::Coupling;
use super::single_mode::SingleMode;
use crate::error::{Error, Result};
use crate::law::{COORDINATES, Law, Piece, State};
use crate::number::{Complex, Instructions, LANES, Lanes, Number, padded};
use crate::problem::Problem;

/// Complex numbers in arrays of whole lanes, rows of `stride`.
#[derive(Debug, Clone, Default)]
pub(crate) struct Rows {
    pub re: Vec<f64>,
    pub im: Vec<f64>,
    pub stride: usize,
}

impl Rows {
    pub(crate) fn zeros(rows: usize, stride: usize) -> Self {
        Self {
            re: vec![0.0; rows * stride],
            im: vec![0.0; rows * stride],
            stride,
        }
    }

    /// Eight entries of a row.
    #[inline(always)]
    pub(crate) fn lanes<I: Instructions>(&self, row: usize, offset: usize) -> Complex<Lanes<I>> {
        let at = row * self.stride + offset;
        Complex::new(
            Lanes::<I>::load(&self.re[at..]),
            Lanes::<I>::load(&self.im[at..]),
        )
    }

    /// Writes eight entries of a row.
    #[inline(always)]
    pub(crate) fn put<I: Instructions>(
        &mut self,
        row: usize,
        offset: usize,
        value: Complex<Lanes<I>>,
    ) {
        let at = row * self.stride + offset;
        value.re.store(&mut self.re[at..]);
        value.im.store(&mut self.im[at..]);
    }

    pub(crate) fn get(&self, row: usize, column: usize) -> Complex<f64> {
        let at = row * self.stride + column;
        Complex::new(self.re[at], self.im[at])
    }

    pub(crate) fn set(&mut self, row: usize, column: usize, value: Complex<f64>) {
        let at = row * self.stride + column;
        (self.re[at], self.im[at]) = (value.re, value.im);
    }
}

/// A mode's part in a coupled combination.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Member {
    pub mode: usize,
    pub group: usize,
    pub weight: f64,
}

/// What a single motion is the motion of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Subject {
    /// A mode, less its part in a combination.
    Mode(usize),
    /// The only combination that a law pushes.
    Combination,
}

/// Something that moves by itself.
#[derive(Debug, Clone)]
pub(crate) struct Single {
    pub subject: Subject,
    pub motion: SingleMode,
    /// Where its exponents start.
    pub at: usize,
    /// Share of its damping that is modal; the rest belongs to `law`.
    pub modal_share: f64,
    pub law: Option<usize>,
}

/// All that a phase needs to know of the linear system between two switches.
#[derive(Debug, Clone)]
pub(crate) struct Spectrum {
    pub states: Vec<State>,
    /// Exponents; the first `coupled_stride` belong to the coupled groups. One of each conjugate
    /// pair, or a real one; padding has exponent zero.
    pub lambda: Rows,
    /// Number of coupled groups.
    pub groups: usize,
    pub coupled_stride: usize,
    /// Shapes, one row a group.
    pub shape: Rows,
    /// Left vectors: amplitude = sum over groups of position row y + velocity row y'.
    pub left_position: Rows,
    pub left_velocity: Rows,
    /// Constant part of the groups under constant forces.
    pub at_rest: Vec<f64>,
    /// Damping of the groups by the structure alone.
    pub group_damping: Vec<f64>,
    pub members: Vec<Member>,
    /// Number of combinations that members belong to; a lone one is a single, not a group.
    pub combinations: usize,
    pub singles: Vec<Single>,
    /// How each local coordinate sees the motion, in the order of laws and their rows.
    pub views: Vec<View>,
    /// Whether some exponent grows.
    pub grows: bool,
    /// Largest modulus of an exponent.
    pub fastest: f64,
    /// Whether the coupled part came from the secular equation.
    pub is_secular: bool,
}

/// Whether the secular equation may be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Secular {
    /// Where it applies.
    Try,
    /// Not after its result has failed the check of a phase.
    Skip,
}

impl Spectrum {
    /// Solves the eigenproblem for the laws in the given states.
    #[inline(always)]
    pub(crate) fn new<I: Instructions, L: Law>(
        problem: &Problem<L>,
        states: &[State],
        secular: Secular,
    ) -> Result<Self> {
        let acting = Acting::new(problem, states);
        let mut spectrum = match acting.as_slice() {
            [] => Self::empty(states),
            [one] => Self::of_one_spring::<I, L>(problem, states, one, secular)?,
            several => dense::spectrum(problem, states, several)?,
        };
        spectrum.add_singles(problem);
        spectrum.lay_out_exponents();
        spectrum.grows = spectrum.lambda.re.iter().any(|re| *re > 0.0);
        spectrum.fastest = (spectrum.lambda.re.iter().zip(&spectrum.lambda.im))
            .fold(0.0f64, |m, (re, im)| m.max(re * re + im * im))
            .sqrt();
        for law in &problem.laws {
            for row in law.rows() {
                let view = View::new::<I>(&spectrum, row);
                spectrum.views.push(view);
            }
        }
        Ok(spectrum)
    }

    /// A spectrum without any mode yet.
    pub(crate) fn empty(states: &[State]) -> Self {
        Self {
            states: states.to_vec(),
            lambda: Rows::default(),
            groups: 0,
            coupled_stride: 0,
            shape: Rows::default(),
            left_position: Rows::default(),
            left_velocity: Rows::default(),
            at_rest: Vec::new(),
            group_damping: Vec::new(),
            members: Vec::new(),
            combinations: 0,
            singles: Vec::new(),
            views: Vec::new(),
            grows: false,
            fastest: 0.0,
            is_secular: false,
        }
    }

    /// One spring and damper: the secular equation, or the dense problem where it declines.
    #[inline(always)]
    fn of_one_spring<I: Instructions, L: Law>(
        problem: &Problem<L>,
        states: &[State],
        law: &Acting,
        secular: Secular,
    ) -> Result<Self> {
        let mut spectrum = Self::empty(states);
        let groups = group_alike(problem, law);
        spectrum.members = groups.members;
        let coupling = &groups.coupling;
        spectrum.combinations = coupling.omega2.len();
        if spectrum.combinations == 1 {
            spectrum.add_lone_combination(problem, law, coupling);
            return Ok(spectrum);
        }
        let forces = group_forces(problem, &spectrum.members, coupling.omega2.len());
        spectrum.groups = coupling.omega2.len();
        spectrum.group_damping.clone_from(&coupling.damping);
        spectrum.at_rest = static_groups(coupling, &forces, law.constant).ok_or(Error::NoRest)?;
        let roots = match secular {
            Secular::Try => coupling.solve::<I>(),
            Secular::Skip => None,
        };
        spectrum.is_secular = roots.is_some();
        match roots {
            Some(roots) => spectrum.set_secular::<I>(coupling, roots),
            None => dense::set_coupled(&mut spectrum, coupling)?,
        }
        Ok(spectrum)
    }

    /// Shapes and left vectors from the roots of the secular equation: with psi_i = phi_i/D_i,
    /// `a = 2 psi'[(lambda + C) y + y'] / (psi' (2 lambda + C) psi)`, C with the stop's damper.
    #[inline(always)]
    fn set_secular<I: Instructions>(&mut self, coupling: &Coupling, roots: super::secular::Roots) {
        let n = coupling.omega2.len();
        let stride = roots.stride;
        self.coupled_stride = stride;
        self.lambda = Rows {
            re: roots.lambda_re,
            im: roots.lambda_im,
            stride,
        };
        self.shape = Rows {
            re: roots.inverse_re,
            im: roots.inverse_im,
            stride,
        };
        self.left_position = Rows::zeros(n, stride);
        self.left_velocity = Rows::zeros(n, stride);
        let (k, c) = (
            Lanes::<I>::of(coupling.stiffness),
            Lanes::<I>::of(coupling.stop_damping),
        );
        let two = Lanes::<I>::of(2.0);
        for o in (0..stride).step_by(LANES) {
            let lambda = self.lambda.lanes(0, o);
            // phi' psi = -1/kappa at a root.
            let kappa = Complex::new(k + c * lambda.re, c * lambda.im);
            let contact = safe_recip(kappa);
            let mut norm = (contact * contact).scale(c);
            for i in 0..n {
                let psi = self
                    .shape
                    .lanes(i, o)
                    .scale(Lanes::<I>::of(coupling.phi[i]));
                self.shape.put(i, o, psi);
                let rate = lambda.scale(two).plus(Lanes::<I>::of(coupling.damping[i]));
                norm += psi * psi * rate;
            }
            let factor = safe_recip(norm).scale(two);
            for i in 0..n {
                let psi = self.shape.lanes(i, o) * factor;
                let damper = (contact * factor).scale(c * Lanes::<I>::of(coupling.phi[i]));
                let with_rate = psi * lambda.plus(Lanes::<I>::of(coupling.damping[i]));
                self.left_velocity.put(i, o, psi);
                self.left_position.put(i, o, with_rate - damper);
            }
        }
    }

    /// A law that pushes a single mode, or a single combination of like ones, only changes its
    /// stiffness and damping.
    fn add_lone_combination<L: Law>(
        &mut self,
        problem: &Problem<L>,
        law: &Acting,
        coupling: &Coupling,
    ) {
        let phi = coupling.phi[0];
        let (modal, added) = (coupling.damping[0], law.damping * phi * phi);
        let force = group_forces(problem, &self.members, 1)[0] + phi * law.constant;
        let stiffness = coupling.omega2[0] + law.stiffness * phi * phi;
        let damping = modal + added;
        self.singles.push(Single {
            subject: Subject::Combination,
            motion: SingleMode::new(stiffness, damping, force, problem.duration),
            at: 0,
            modal_share: if damping > 0.0 { modal / damping } else { 0.0 },
            law: Some(law.law),
        });
    }

    /// Adds the modes, or parts of modes, that no acting law sees.
    #[inline(always)]
    fn add_singles<L: Law>(&mut self, problem: &Problem<L>) {
        let (omega2, damping) = (problem.system.omega2(), problem.system.damping());
        let forces = problem.forcing.forces();
        let mut weight = vec![0.0; omega2.len()];
        for member in &self.members {
            weight[member.mode] = member.weight;
        }
        let pushed = self.group_force_of_modes(forces);
        for mode in 0..omega2.len() {
            if weight[mode].abs() == 1.0 {
                continue;
            }
            let force = forces[mode] - pushed[mode];
            self.singles.push(Single {
                subject: Subject::Mode(mode),
                motion: SingleMode::new(omega2[mode], damping[mode], force, problem.duration),
                at: 0,
                modal_share: 1.0,
                law: None,
            });
        }
    }

    /// The part of each mode's force that its group takes.
    fn group_force_of_modes(&self, forces: &[f64]) -> Vec<f64> {
        let mut totals = vec![0.0; self.combinations];
        for m in &self.members {
            totals[m.group] += m.weight * forces[m.mode];
        }
        let mut pushed = vec![0.0; forces.len()];
        for m in &self.members {
            pushed[m.mode] = m.weight * totals[m.group];
        }
        pushed
    }

    fn lay_out_exponents(&mut self) {
        let mut at = self.coupled_stride;
        for single in &mut self.singles {
            single.at = at;
            at += single.motion.exponents().1;
        }
        let stride = padded(at);
        self.lambda.re.resize(stride, 0.0);
        self.lambda.im.resize(stride, 0.0);
        self.lambda.stride = stride;
        for single in &self.singles {
            let (exponents, count) = single.motion.exponents();
            for (i, lambda) in exponents.iter().enumerate().take(count) {
                self.lambda.set(0, single.at + i, *lambda);
            }
        }
    }

    /// Number of exponents, padding included.
    #[inline(always)]
    pub(crate) fn exponents(&self) -> usize {
        self.lambda.stride
    }

    /// `exp(lambda t)` for all exponents.
    #[inline(always)]
    pub(crate) fn exponentials<I: Instructions>(&self, t: f64, to: &mut Rows) {
        for o in (0..self.exponents()).step_by(LANES) {
            let exponents: Complex<Lanes<I>> = self.lambda.lanes(0, o);
            to.put(0, o, exponents.scale(Lanes::<I>::of(t)).exp());
        }
    }

    /// Coordinates of groups: `sum weight q`.
    #[inline(always)]
    pub(crate) fn gather(&self, modal: &[f64], groups: &mut [f64]) {
        groups.fill(0.0);
        for m in &self.members {
            groups[m.group] += m.weight * modal[m.mode];
        }
    }

    /// Amplitudes of the coupled exponents from the groups' state, measured from rest.
    #[inline(always)]
    pub(crate) fn amplitudes<I: Instructions>(
        &self,
        position: &[f64],
        velocity: &[f64],
        to: &mut Rows,
    ) {
        for o in (0..self.coupled_stride).step_by(LANES) {
            let mut total = Complex::<Lanes<I>>::zero();
            for g in 0..self.groups {
                let y = Lanes::<I>::of(position[g]);
                total += self.left_position.lanes(g, o).scale(y);
                total += self
                    .left_velocity
                    .lanes(g, o)
                    .scale(Lanes::<I>::of(velocity[g]));
            }
            to.put(0, o, total);
        }
    }

    /// `Re sum_j shape_gj z_j` over the coupled exponents.
    #[inline(always)]
    pub(crate) fn group_sum<I: Instructions>(&self, group: usize, z: &Rows) -> f64 {
        let mut total = Lanes::<I>::of(0.0);
        for o in (0..self.coupled_stride).step_by(LANES) {
            total += self.shape.lanes::<I>(group, o).real_product(z.lanes(0, o));
        }
        total.total()
    }
}

/// How one local coordinate sees the motion of a phase.
#[derive(Debug, Clone)]
pub(crate) struct View {
    /// Weight of each exponent's amplitude.
    pub exponents: Rows,
    /// Position at rest of the coupled groups.
    pub rest: f64,
    /// Weight of each single motion.
    pub singles: Vec<f64>,
}

impl View {
    #[inline(always)]
    pub(crate) fn new<I: Instructions>(spectrum: &Spectrum, row: &[f64]) -> Self {
        let mut combined = vec![0.0; spectrum.combinations];
        spectrum.gather(row, &mut combined);
        let mut exponents = Rows::zeros(1, spectrum.exponents());
        for o in (0..spectrum.coupled_stride).step_by(LANES) {
            let mut total = Complex::<Lanes<I>>::zero();
            for (g, weight) in combined.iter().enumerate() {
                total += spectrum.shape.lanes(g, o).scale(Lanes::<I>::of(*weight));
            }
            exponents.put(0, o, total);
        }
        let mut singles = Vec::with_capacity(spectrum.singles.len());
        for single in &spectrum.singles {
            let weight = match single.subject {
                Subject::Mode(mode) => row[mode],
                Subject::Combination => combined[0],
            };
            singles.push(weight);
            for i in 0..single.motion.exponents().1 {
                exponents.set(0, single.at + i, Complex::real(weight));
            }
        }
        let rest = spectrum
            .at_rest
            .iter()
            .zip(&combined)
            .map(|(y, w)| y * w)
            .sum();
        Self {
            exponents,
            rest,
            singles,
        }
    }
}

/// A law in a state that acts, with one local coordinate.
#[derive(Debug, Clone)]
pub(crate) struct Acting {
    pub law: usize,
    pub row: Vec<f64>,
    pub constant: f64,
    pub stiffness: f64,
    pub damping: f64,
}

impl Acting {
    fn new<L: Law>(problem: &Problem<L>, states: &[State]) -> Vec<Self> {
        let mut acting = Vec::new();
        for (index, (law, state)) in problem.laws.iter().zip(states).enumerate() {
            let piece = law.piece(*state).unwrap_or(Piece::FREE);
            for (i, row) in law.rows().iter().enumerate().take(COORDINATES) {
                let alone = piece.constant[i] == 0.0
                    && piece.stiffness[i] == [0.0; COORDINATES]
                    && piece.damping[i] == [0.0; COORDINATES];
                if !alone && row.iter().any(|r| *r != 0.0) {
                    acting.push(Self {
                        law: index,
                        row: row.clone(),
                        constant: piece.constant[i],
                        stiffness: piece.stiffness[i][i],
                        damping: piece.damping[i][i],
                    });
                }
            }
        }
        acting
    }
}

struct Groups {
    members: Vec<Member>,
    coupling: Coupling,
}

/// Sorts the modes that a law sees and joins those that are alike.
#[inline(always)]
fn group_alike<L: Law>(problem: &Problem<L>, law: &Acting) -> Groups {
    let (omega2, damping) = (problem.system.omega2(), problem.system.damping());
    let mut order: Vec<usize> = (0..omega2.len()).filter(|&i| law.row[i] != 0.0).collect();
    let sorted = order.windows(2).all(|w| omega2[w[0]] < omega2[w[1]]);
    if !sorted {
        order.sort_by(|&a, &b| {
            (omega2[a].total_cmp(&omega2[b])).then(damping[a].total_cmp(&damping[b]))
        });
    }
    let mut coupling = Coupling {
        stiffness: law.stiffness,
        stop_damping: law.damping,
        ..Coupling::default()
    };
    let mut members: Vec<Member> = Vec::with_capacity(order.len());
    for mode in order {
        let alike = coupling.omega2.last() == Some(&omega2[mode])
            && coupling.damping.last() == Some(&damping[mode]);
        if !alike {
            coupling.omega2.push(omega2[mode]);
            coupling.damping.push(damping[mode]);
            coupling.phi.push(0.0);
        }
        let group = coupling.omega2.len() - 1;
        coupling.phi[group] = coupling.phi[group].hypot(law.row[mode]);
        members.push(Member {
            mode,
            group,
            weight: law.row[mode],
        });
    }
    for member in &mut members {
        member.weight /= coupling.phi[member.group];
    }
    // A mode alone in its group keeps its sign in phi, so that its weight is exactly one.
    for group in 0..coupling.phi.len() {
        let mut own = members.iter_mut().filter(|m| m.group == group);
        if let (Some(only), None) = (own.next(), own.next()) {
            only.weight = 1.0;
            coupling.phi[group] = law.row[only.mode];
        }
    }
    Groups { members, coupling }
}

/// Constant forces on the groups.
fn group_forces<L: Law>(problem: &Problem<L>, members: &[Member], groups: usize) -> Vec<f64> {
    let mut forces = vec![0.0; groups];
    for m in members {
        forces[m.group] += m.weight * problem.forcing.forces()[m.mode];
    }
    forces
}

/// Static position of the groups on the spring: `w_i^2 y_i = p_i + phi_i F`,
/// `F = constant - k sum phi_i y_i`. The softest group's own row gives F, so that a rigid-body
/// mode (stiffness zero) needs no special case. Further ones (of other damping) stay where they
/// are if the forces on them balance; `None` if not.
fn static_groups(coupling: &Coupling, forces: &[f64], constant: f64) -> Option<Vec<f64>> {
    let Coupling {
        omega2,
        phi,
        stiffness,
        ..
    } = coupling;
    let soft = (0..omega2.len())
        .min_by(|&a, &b| omega2[a].abs().total_cmp(&omega2[b].abs()))
        .unwrap_or(0);
    let others = || (0..omega2.len()).filter(|&i| i != soft && omega2[i] != 0.0);
    let flexibility: f64 = others().map(|i| phi[i] * phi[i] / omega2[i]).sum();
    let pushed: f64 = others().map(|i| phi[i] * forces[i] / omega2[i]).sum();
    let compliance = flexibility + 1.0 / stiffness;
    // phi_s y_s + compliance F = constant/k - pushed,  F = (w_s^2 y_s - p_s)/phi_s
    let factor = phi[soft] + compliance * omega2[soft] / phi[soft];
    let right = constant / stiffness - pushed + compliance * forces[soft] / phi[soft];
    let y = right / factor;
    let force = (omega2[soft] * y - forces[soft]) / phi[soft];
    let pushed = |i: usize| forces[i] + phi[i] * force;
    let balanced = |i: usize| pushed(i).abs() <= BALANCED * forces[i].abs();
    (0..omega2.len())
        .map(|i| match omega2[i] {
            _ if i == soft => Some(y),
            0.0 => balanced(i).then_some(0.0),
            w2 => Some(pushed(i) / w2),
        })
        .collect()
}

/// Forces on a rigid-body mode are in balance when what is left of them is rounding.
const BALANCED: f64 = 1e-12;

/// Reciprocal, zero for zero (the padding of the lanes).
#[inline(always)]
fn safe_recip<I: Instructions>(z: Complex<Lanes<I>>) -> Complex<Lanes<I>> {
    let norm = z.norm2();
    let zero = Lanes::<I>::of(0.0);
    let inverse = zero.select_less(norm, Lanes::<I>::of(1.0) / norm, zero);
    z.conj().scale(inverse)
}
