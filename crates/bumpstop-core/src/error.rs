//! What can go wrong in the core, with the values a user needs to mend it.

use thiserror::Error;

/// Everything the core refuses or fails at.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Error {
    /// An array has the wrong length.
    #[error("{what} has {found} entries instead of {expected}")]
    Length {
        /// The array.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length it should have.
        expected: usize,
    },
    /// A number is NaN or infinite.
    #[error("{what} holds a number that is not finite")]
    NotFinite {
        /// The array or argument.
        what: &'static str,
    },
    /// A number is negative that cannot be.
    #[error("{what} must not be negative (got {value})")]
    Negative {
        /// The argument.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A number must be positive.
    #[error("{what} must be positive (got {value})")]
    NotPositive {
        /// The argument.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// An explicit scheme was given masses that dofs share.
    #[error(
        "the central difference of a full model needs a diagonal mass matrix: take lumped masses, or the newmark method"
    )]
    CoupledMasses,
    /// A scheme that the full model has not.
    #[error(
        "the {method} method does not take a full model; central_difference, newmark, hht and generalized_alpha do"
    )]
    NotInFamily {
        /// The method.
        method: &'static str,
    },
    /// The mass matrix is not positive definite.
    #[error("the mass matrix is not positive definite: some motion has no mass")]
    SingularMass,
    /// Arrays of a sparse matrix do not fit together, or two matrices not to each other.
    #[error("the sizes or places of {what} do not fit together")]
    Sizes {
        /// The matrix, or the matrices.
        what: &'static str,
    },
    /// A matrix is not its own transpose.
    #[error("{what} is not symmetric: its entries ({row}, {column}) and ({column}, {row}) differ")]
    NotSymmetric {
        /// The matrix.
        what: &'static str,
        /// Row of an entry, from 0.
        row: usize,
        /// Column of it.
        column: usize,
    },
    /// A mass on the diagonal is negative.
    #[error("the mass of dof {unknown} (counted from 0) is negative")]
    NegativeMass {
        /// Number of the dof.
        unknown: usize,
    },
    /// Some motion has a negative kinetic energy.
    #[error("the mass matrix is not positive: some motion has a negative kinetic energy")]
    IndefiniteMass,
    /// A matrix has no inverse, to rounding.
    #[error(
        "the matrix is singular at unknown {unknown} (counted from 0): what is left of its diagonal is {ratio:.0e} of it"
    )]
    Singular {
        /// Number of the unknown.
        unknown: usize,
        /// The pivot relative to the diagonal.
        ratio: f64,
    },
    /// Numbers left the range of floating point in a factorisation.
    #[error("the numbers of the matrices are too large or too far apart to be factored")]
    Factorisation,
    /// Memory does not suffice.
    #[error("there is not enough memory for the factored matrix")]
    Memory,
    /// Inertia and eigenvalues tell different numbers of modes.
    #[error(
        "the {told} modes that the inertia tells from {low:e} to {high:e} rad2/s2 were not found: the matrices are too badly conditioned to be certain"
    )]
    Uncertain {
        /// Modes that there must be.
        told: usize,
        /// Lower end of the range.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// More modes were asked for than there are.
    #[error("{asked} modes were asked for, but the matrices have {available}")]
    TooManyModes {
        /// Modes asked for.
        asked: usize,
        /// Size of the matrices.
        available: usize,
    },
    /// A method that needs modes of their own was given coupled ones.
    #[error(
        "the {method} method does not take modes that damping, gyroscopic or circulatory forces couple; the exact method does"
    )]
    CoupledModes {
        /// The method.
        method: &'static str,
    },
    /// A restitution out of its range.
    #[error("the restitution of a rigid stop must be from 0 to 1 (got {value})")]
    Restitution {
        /// Its value.
        value: f64,
    },
    /// A resolution out of its range.
    #[error("the resolution of a rigid stop must be from 1e-13 to 1 (got {value})")]
    Resolution {
        /// Its value.
        value: f64,
    },
    /// A run starts inside a rigid stop.
    #[error("the run starts {depth:e} m inside rigid stop {law} (counted from 0 among the laws)")]
    InsideStop {
        /// The stop.
        law: usize,
        /// How deep, in m.
        depth: f64,
    },
    /// The law of impact asks for what cannot be.
    #[error(
        "stops that are touched together at t = {time:e} s ask for speeds that exclude each other; give them the same restitution"
    )]
    NoImpactLaw {
        /// Instant, in s.
        time: f64,
    },
    /// A method that needs forces was given a rigid stop.
    #[error(
        "the {method} method does not take rigid stops; the exact method does, or give the stop a stiffness"
    )]
    RigidStops {
        /// The method.
        method: &'static str,
    },
    /// A method that takes rigid stops was given one that rubs.
    #[error(
        "the {method} method does not take friction at rigid stops, as law {law} (counted from 0) has it; moreau_jean does, or give the stop a stiffness"
    )]
    RigidFriction {
        /// The method.
        method: &'static str,
        /// The law.
        law: usize,
    },
    /// An obstacle's motion jumps.
    #[error("an obstacle cannot jump: its motion has two values at t = {time:e} s")]
    Jump {
        /// Instant, in s.
        time: f64,
    },
    /// What moves is not an obstacle that a motion can be given to.
    #[error(
        "law {law} (counted from 0) cannot be moved: there is none, it has no such coordinate, or its stop is rigid"
    )]
    Immovable {
        /// The law.
        law: usize,
    },
    /// A fixed step would be unstable.
    #[error("a step of {dt:e} s is above the stability limit of {method}, {limit:e} s")]
    Unstable {
        /// The method.
        method: &'static str,
        /// The step asked for, in s.
        dt: f64,
        /// The largest stable step, in s.
        limit: f64,
    },
    /// A run would keep more than fits in memory.
    #[error(
        "{steps} steps of {modes} modes need {gibibytes:.1} GiB of memory; take a larger step or a shorter run"
    )]
    TooManySteps {
        /// Number of steps.
        steps: usize,
        /// Number of modes.
        modes: usize,
        /// Memory that the run would need.
        gibibytes: f64,
    },
    /// A parameter of a scheme is out of its range.
    #[error("{what} must be from {low:.4} to {high:.4} (got {value})")]
    Parameter {
        /// Its name.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The least that it may be.
        low: f64,
        /// The most.
        high: f64,
    },
    /// The matrix that a step solves with has no inverse.
    #[error("the equations of a step cannot be solved: take another step")]
    SingularStep,
    /// A scheme for equations of motion was given a law with equations of its own.
    #[error(
        "the {method} method does not take laws whose memory follows rate equations, such as law {law} (counted from 0); the adaptive methods do"
    )]
    FlowingMemory {
        /// The method.
        method: &'static str,
        /// The law.
        law: usize,
    },
    /// A shaft whose speed changes was given to a method with matrices that do not.
    #[error(
        "the {method} method does not take shafts whose speed changes; the adaptive methods do"
    )]
    SpeedChanges {
        /// The method.
        method: &'static str,
    },
    /// A law that is to be asked once a step was given to a method that asks otherwise.
    #[error(
        "the {method} method does not take law {law} (counted from 0), which is asked once a step, in order; symplectic_euler does"
    )]
    Stepped {
        /// The method.
        method: &'static str,
        /// The law.
        law: usize,
    },
    /// Somebody outside told no force.
    #[error("law {law} (counted from 0) told no force in the step from t = {time:e} s on")]
    NoAnswer {
        /// Start of the step, in s.
        time: f64,
        /// The law.
        law: usize,
    },
    /// No force of a law was found that agrees with the motion at the end of a step.
    #[error(
        "no force of law {law} (counted from 0) agrees with the motion at t = {time:e} s; take a smaller step"
    )]
    NoContactForce {
        /// Instant, in s.
        time: f64,
        /// The law.
        law: usize,
    },
    /// A relative tolerance out of its range.
    #[error("the relative tolerance must be from {finest:e} to below 1 (got {value})")]
    Tolerance {
        /// Its value.
        value: f64,
        /// The finest there is.
        finest: f64,
    },
    /// Step control came down to rounding.
    #[error(
        "no step from t = {time:e} s on is small enough for the tolerance (the last tried is {step:.1e} s): a force grows beyond bounds or jumps where no law says so"
    )]
    SmallStep {
        /// Instant reached, in s.
        time: f64,
        /// The step, in s.
        step: f64,
    },
    /// The steps of a run do not fit in memory.
    #[error(
        "the steps up to t = {time:e} s fill the memory, or the 4 GiB of it that a run may take; take a larger tolerance or step, or a shorter run"
    )]
    LongRecord {
        /// Instant reached, in s.
        time: f64,
    },
    /// A method for linear states was given a law that has others.
    #[error(
        "the {method} method takes piecewise-linear laws alone, and law {law} (counted from 0) is none; an adaptive method takes it"
    )]
    Smooth {
        /// The method.
        method: &'static str,
        /// The law.
        law: usize,
    },
    /// The motion left the range of floating-point numbers.
    #[error(
        "the motion grew beyond all bounds at t = {time:e} s; take a smaller step, if the method has one, and check the units"
    )]
    Overflow {
        /// Instant, in s.
        time: f64,
    },
    /// A run with steps blew up.
    #[error(
        "the motion blows up: at t = {time:e} s there is {ratio:.0e} times the energy that was there and was given{}; take a smaller step, a tenth of the shortest contact or less, or a method that follows the switches: exact, or an adaptive one",
        most_of_it(*place)
    )]
    BlowUp {
        /// Instant, in s.
        time: f64,
        /// Energy from nowhere, over what was there and was given.
        ratio: f64,
        /// What has most of it, if that is told.
        place: Option<Place>,
    },
    /// A run whose steps follow the motion gained energy from nowhere.
    #[error(
        "the motion blows up: at t = {time:e} s there is {ratio:.0e} times the energy that was there and was given{}; take a finer tolerance or more points per period, and look whether a law gives energy that it does not tell",
        most_of_it(Some(Place::Mode(*mode)))
    )]
    RanAway {
        /// Instant, in s.
        time: f64,
        /// Energy from nowhere, over what was there and was given.
        ratio: f64,
        /// The mode that has most of it, counted from 0.
        mode: usize,
    },
    /// A law is so stiff that the instants of a run lie too far apart for it.
    #[error(
        "law {law} (counted from 0) has a stiffness of {stiffness:e} N/m, which moves faster than the instants of a run of {duration} s can tell; the stiffest that they can is {most:.1e} N/m"
    )]
    TooStiff {
        /// The law.
        law: usize,
        /// Its stiffness, in N/m.
        stiffness: f64,
        /// The most that the run takes, in N/m.
        most: f64,
        /// Length of the run, in s.
        duration: f64,
    },
    /// Events follow each other without time advancing.
    #[error("the laws switch without end at t = {time:e} s")]
    EndlessSwitching {
        /// Instant, in s.
        time: f64,
    },
    /// No spectrum of a phase passed its check.
    #[error(
        "the motion from t = {time} s on could not be separated into exponentials to more than {defect:.1e}: either numbers lie too many orders of magnitude apart, or vibration modes with the laws' present states nearly coincide; check the units, or take an adaptive method"
    )]
    Defective {
        /// Instant at which the phase starts, in s.
        time: f64,
        /// Largest relative error with which the state is reproduced.
        defect: f64,
    },
    /// A polynomial in time has too many powers.
    #[error("a load's polynomial is of degree {found}; the highest is {highest}")]
    Degree {
        /// Its degree.
        found: usize,
        /// The highest that is taken.
        highest: usize,
    },
    /// The times of a table are not in order.
    #[error("the times of a load's table go backwards at t = {time} s")]
    Backwards {
        /// The first time that is earlier than the one before it, in s.
        time: f64,
    },
    /// A time outside the run was asked for.
    #[error("t = {time} s lies outside the run, which goes from 0 to {duration} s")]
    OutsideRun {
        /// The time asked for, in s.
        time: f64,
        /// Length of the run, in s.
        duration: f64,
    },
    /// There is no law of this number.
    #[error("there is no law {law}")]
    NoLaw {
        /// The number, from 0.
        law: usize,
    },
    /// A number of a stop is asked for that is none, or rubs.
    #[error("law {law} is no plain stop, whose numbers may vary")]
    NoStop {
        /// The law's number.
        law: usize,
    },
    /// An eigenvalue iteration failed.
    #[error("the eigenvalue iteration did not converge")]
    Eigenvalues,
    /// The caller asked to stop.
    #[error("interrupted at t = {time:e} s")]
    Interrupted {
        /// Instant reached, in s.
        time: f64,
    },
}

impl Error {
    /// Refuses a parameter of a scheme that is out of its range.
    pub(crate) fn check_parameter(
        what: &'static str,
        value: f64,
        [low, high]: [f64; 2],
    ) -> Result<()> {
        if (low..=high).contains(&value) {
            return Ok(());
        }
        Err(Self::Parameter {
            what,
            value,
            low,
            high,
        })
    }
}

/// Result with the core's error.
pub type Result<T> = std::result::Result<T, Error>;

/// Refuses arrays that hold NaN or infinities.
pub fn check_finite(what: &'static str, values: &[f64]) -> Result<()> {
    if values.iter().all(|v| v.is_finite()) {
        Ok(())
    } else {
        Err(Error::NotFinite { what })
    }
}

/// Refuses an array of the wrong length.
pub fn check_length(what: &'static str, values: &[f64], expected: usize) -> Result<()> {
    if values.len() == expected {
        Ok(())
    } else {
        Err(Error::Length {
            what,
            found: values.len(),
            expected,
        })
    }
}

/// Where most of an energy is, for a message.
/// What of a structure moves most.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// A mode, counted from 0.
    Mode(usize),
    /// A dof of a full model, counted from 0.
    Dof(usize),
}

fn most_of_it(place: Option<Place>) -> String {
    match place {
        Some(Place::Mode(mode)) => format!(", most of it in mode {}", mode + 1),
        Some(Place::Dof(dof)) => format!(", most of it in dof {} of the free ones", dof + 1),
        None => String::new(),
    }
}
