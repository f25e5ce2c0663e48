//! Any of the laws, so that a problem can have several kinds.

use super::{
    BucklingStop, Constraint, CrackedRotor, Damper, ForceRelation, FrictionStop, Guard,
    HardeningSpring, HertzStop, Law, Local, LocalMotion, OutsideProgram, Piece, Power, RigidStop,
    SeismicDevice, ShapedStop, Spring, State, Stop, UserLaw, ZenerDamper,
};
use crate::number::Number;
use std::borrow::Cow;

/// A law of any kind; each does its own work.
#[derive(Debug, Clone, PartialEq)]
pub enum AnyLaw {
    /// A unilateral spring and damper.
    Stop(Stop),
    /// The same with friction along one direction.
    FrictionStop(FrictionStop),
    /// A multilinear elastic spring.
    Spring(Spring),
    /// A multilinear damper.
    Damper(Damper),
    /// A force by a formula of position and velocity.
    ForceRelation(ForceRelation),
    /// An obstacle that does not give way.
    RigidStop(RigidStop),
    /// An obstacle whose force is a power of the depth.
    HertzStop(HertzStop),
    /// A spring whose stiffness falls beyond a threshold, with a damper.
    SeismicDevice(SeismicDevice),
    /// An elastic-plastic spring.
    HardeningSpring(HardeningSpring),
    /// A stop that buckles.
    BucklingStop(BucklingStop),
    /// A law that answers from outside.
    UserLaw(UserLaw),
    /// A program outside, coupled step by step.
    OutsideProgram(OutsideProgram),
    /// Springs around a nonlinear dashpot.
    ZenerDamper(ZenerDamper),
    /// A crack across a shaft that turns.
    CrackedRotor(CrackedRotor),
    /// An obstacle of any shape.
    ShapedStop(ShapedStop),
}

impl From<Stop> for AnyLaw {
    fn from(law: Stop) -> Self {
        Self::Stop(law)
    }
}

impl From<FrictionStop> for AnyLaw {
    fn from(law: FrictionStop) -> Self {
        Self::FrictionStop(law)
    }
}

impl From<Spring> for AnyLaw {
    fn from(law: Spring) -> Self {
        Self::Spring(law)
    }
}

impl From<Damper> for AnyLaw {
    fn from(law: Damper) -> Self {
        Self::Damper(law)
    }
}

impl From<ForceRelation> for AnyLaw {
    fn from(law: ForceRelation) -> Self {
        Self::ForceRelation(law)
    }
}

impl From<RigidStop> for AnyLaw {
    fn from(stop: RigidStop) -> Self {
        Self::RigidStop(stop)
    }
}

impl From<HertzStop> for AnyLaw {
    fn from(stop: HertzStop) -> Self {
        Self::HertzStop(stop)
    }
}

impl From<SeismicDevice> for AnyLaw {
    fn from(law: SeismicDevice) -> Self {
        Self::SeismicDevice(law)
    }
}

impl From<HardeningSpring> for AnyLaw {
    fn from(law: HardeningSpring) -> Self {
        Self::HardeningSpring(law)
    }
}

impl From<BucklingStop> for AnyLaw {
    fn from(law: BucklingStop) -> Self {
        Self::BucklingStop(law)
    }
}

impl From<UserLaw> for AnyLaw {
    fn from(law: UserLaw) -> Self {
        Self::UserLaw(law)
    }
}

impl From<OutsideProgram> for AnyLaw {
    fn from(law: OutsideProgram) -> Self {
        Self::OutsideProgram(law)
    }
}

impl From<ZenerDamper> for AnyLaw {
    fn from(law: ZenerDamper) -> Self {
        Self::ZenerDamper(law)
    }
}

impl From<CrackedRotor> for AnyLaw {
    fn from(law: CrackedRotor) -> Self {
        Self::CrackedRotor(law)
    }
}

impl From<ShapedStop> for AnyLaw {
    fn from(stop: ShapedStop) -> Self {
        Self::ShapedStop(stop)
    }
}

/// Asks the law inside.
macro_rules! ask {
    ($self:ident, $law:ident => $answer:expr) => {
        match $self {
            Self::Stop($law) => $answer,
            Self::FrictionStop($law) => $answer,
            Self::Spring($law) => $answer,
            Self::Damper($law) => $answer,
            Self::ForceRelation($law) => $answer,
            Self::RigidStop($law) => $answer,
            Self::HertzStop($law) => $answer,
            Self::SeismicDevice($law) => $answer,
            Self::HardeningSpring($law) => $answer,
            Self::BucklingStop($law) => $answer,
            Self::UserLaw($law) => $answer,
            Self::OutsideProgram($law) => $answer,
            Self::ZenerDamper($law) => $answer,
            Self::CrackedRotor($law) => $answer,
            Self::ShapedStop($law) => $answer,
        }
    };
}

impl Law for AnyLaw {
    #[inline(always)]
    fn rows(&self) -> &[Vec<f64>] {
        ask!(self, law => law.rows())
    }

    fn state_name(&self, state: State) -> Cow<'static, str> {
        ask!(self, law => law.state_name(state))
    }

    fn initial_state(&self, motion: &LocalMotion, acting: impl Fn(State) -> LocalMotion) -> State {
        ask!(self, law => law.initial_state(motion, acting))
    }

    fn starts_by_velocity(&self, motion: &LocalMotion) -> bool {
        ask!(self, law => law.starts_by_velocity(motion))
    }

    #[inline(always)]
    fn sampled_state(
        &self,
        previous: State,
        position: &Local<f64>,
        velocity: &Local<f64>,
    ) -> State {
        ask!(self, law => law.sampled_state(previous, position, velocity))
    }

    #[inline(always)]
    fn force<T: Number>(&self, state: State, position: &Local<T>, velocity: &Local<T>) -> Local<T> {
        ask!(self, law => law.force(state, position, velocity))
    }

    #[inline(always)]
    fn on_contact<T: Number>(
        &self,
        state: State,
        position: &Local<T>,
        force: &Local<T>,
    ) -> Local<T> {
        ask!(self, law => law.on_contact(state, position, force))
    }

    #[inline(always)]
    fn as_stop(&self) -> Option<&Stop> {
        match self {
            Self::Stop(law) => Some(law),
            _ => None,
        }
    }

    fn is_piecewise_linear(&self) -> bool {
        ask!(self, law => law.is_piecewise_linear())
    }

    fn flows(&self) -> bool {
        ask!(self, law => law.flows())
    }

    fn memory_rates(&self, state: State, position: &Local<f64>, velocity: &Local<f64>) -> [f64; 2] {
        ask!(self, law => law.memory_rates(state, position, velocity))
    }

    fn memory_sizes(&self, position: &Local<f64>) -> [f64; 2] {
        ask!(self, law => law.memory_sizes(position))
    }

    fn internal_variables(
        &self,
        state: State,
        position: &Local<f64>,
        velocity: &Local<f64>,
    ) -> [f64; 2] {
        ask!(self, law => law.internal_variables(state, position, velocity))
    }

    fn has_failed(&self) -> bool {
        ask!(self, law => law.has_failed())
    }

    fn after_jump(&self, state: State, position: &Local<f64>, jump: [&Local<f64>; 2]) -> State {
        ask!(self, law => law.after_jump(state, position, jump))
    }

    fn is_stepped(&self) -> bool {
        ask!(self, law => law.is_stepped())
    }

    fn piece(&self, state: State) -> Option<Piece> {
        ask!(self, law => law.piece(state))
    }

    #[inline(always)]
    fn restitution(&self) -> Option<f64> {
        ask!(self, law => law.restitution())
    }

    fn resolution(&self) -> f64 {
        ask!(self, law => law.resolution())
    }

    fn rigid_friction(&self) -> f64 {
        ask!(self, law => law.rigid_friction())
    }

    #[inline(always)]
    fn constraint(&self, state: State) -> Option<Constraint> {
        ask!(self, law => law.constraint(state))
    }

    fn guard_count(&self, state: State) -> usize {
        ask!(self, law => law.guard_count(state))
    }

    fn guard(&self, state: State, index: usize) -> Guard {
        ask!(self, law => law.guard(state, index))
    }

    #[inline(always)]
    fn is_curved(&self, state: State, index: usize) -> bool {
        ask!(self, law => law.is_curved(state, index))
    }

    fn guard_value<T: Number>(
        &self,
        state: State,
        index: usize,
        position: &Local<T>,
        velocity: &Local<T>,
    ) -> T {
        ask!(self, law => law.guard_value(state, index, position, velocity))
    }

    fn flowing_guard<T: Number>(
        &self,
        state: State,
        index: usize,
        position: &Local<T>,
        velocity: &Local<T>,
        memory: &[T; 2],
    ) -> T {
        ask!(self, law => law.flowing_guard(state, index, position, velocity, memory))
    }

    fn next_state(
        &self,
        state: State,
        guard: usize,
        acting: impl Fn(State) -> LocalMotion,
    ) -> State {
        ask!(self, law => law.next_state(state, guard, acting))
    }

    #[inline(always)]
    fn stored<T: Number>(&self, state: State, position: &Local<T>) -> T {
        ask!(self, law => law.stored(state, position))
    }

    fn dissipation(&self, state: State) -> Power {
        ask!(self, law => law.dissipation(state))
    }

    #[inline(always)]
    fn dissipated_power<T: Number>(
        &self,
        state: State,
        position: &Local<T>,
        velocity: &Local<T>,
    ) -> T {
        ask!(self, law => law.dissipated_power(state, position, velocity))
    }

    fn switch_loss(&self, before: State, after: State, position: &Local<f64>) -> f64 {
        ask!(self, law => law.switch_loss(before, after, position))
    }

    #[inline(always)]
    fn distance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> (T, T) {
        ask!(self, law => law.distance(position, velocity))
    }

    fn in_contact(&self, state: State) -> bool {
        ask!(self, law => law.in_contact(state))
    }

    fn stiffest(&self) -> Piece {
        ask!(self, law => law.stiffest())
    }
}
