//! A stop with Coulomb friction along one direction.
//!
//! Normal to the obstacle it is a [`Stop`] with force F. Along the sliding direction x a spring
//! and a slider stand in a row: while the slider sticks at its anchor a, `T = -kt (x - a) - ct x'`;
//! it breaks loose when |T| exceeds `mu_static F`, and slides with `T = -s mu_dynamic F`, s the
//! sign of its own velocity. Where the spring holds the sliding force the slider stands at
//! `x - s mu_dynamic F / kt`, so its velocity is `x' - s mu_dynamic F' / kt`: under a constant
//! normal force that of the structure.
//!
//! A slider with a damper in parallel can be held by it: it goes on as long as a slider that
//! carried the damper would, `x' + (ct x'' - s mu_dynamic F') / kt`, which is the condition for
//! sticking to stay inside the cone. Sliding ends when neither moves on, so that at every switch
//! one state and one only can follow.
//!
//! Published results of fixed steps go by another rule ([`SlidingRule::VelocitySign`]): a contact
//! that slid slides on, against the velocity, while a step finds that with the sign of the step
//! before, and else sticks to where the last sliding force would be that of the spring. It is
//! defined from step to step alone.

use super::{Affine, Guard, Law, Local, LocalMotion, Piece, Power, State, Stop};
use crate::error::{Error, Result, check_finite};
use crate::number::Number;
use std::borrow::Cow;

/// Coulomb friction with an elastic stick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// Coefficient above which the slider breaks loose.
    pub static_coefficient: f64,
    /// Coefficient while it slides, at most the static one.
    pub dynamic_coefficient: f64,
    /// Stiffness of the stick, in N/m.
    pub stiffness: f64,
    /// Damping of the stick, in N s/m.
    pub damping: f64,
    /// What tells that it slides on.
    pub rule: SlidingRule,
}

/// What tells that a contact that slides slides on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SlidingRule {
    /// The slider moves on.
    #[default]
    Slider,
    /// The velocity of the structure has the sign that it had a step before. Source: the friction
    /// of code_aster's test SDND100A, whose values it repeats.
    VelocitySign,
}

impl Friction {
    pub(super) fn check(&self) -> Result<()> {
        let numbers = [
            (
                "the static coefficient of friction",
                self.static_coefficient,
            ),
            (
                "the dynamic coefficient of friction",
                self.dynamic_coefficient,
            ),
            ("the tangential stiffness", self.stiffness),
            ("the tangential damping", self.damping),
        ];
        for (what, value) in numbers {
            check_finite(what, &[value])?;
            if value < 0.0 {
                return Err(Error::Negative { what, value });
            }
        }
        if self.stiffness == 0.0 {
            return Err(Error::NotPositive {
                what: "the tangential stiffness",
                value: self.stiffness,
            });
        }
        if self.dynamic_coefficient > self.static_coefficient {
            return Err(Error::Negative {
                what: "the static less the dynamic coefficient of friction",
                value: self.static_coefficient - self.dynamic_coefficient,
            });
        }
        Ok(())
    }
}

/// A unilateral spring and damper on a plane that rubs along one direction.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionStop {
    rows: [Vec<f64>; 2],
    normal: Stop,
    friction: Friction,
    /// A typical time of the stick on the structure, in s/rad; it makes lengths of velocities.
    pace: f64,
}

/// Number of the normal and the sliding coordinate.
const NORMAL: usize = 0;
const SLIDING: usize = 1;

/// Part of a normal force by which it has jumped, and not been rounded.
const JUMP: f64 = 1e-9;

/// Speed in m/s up to which nothing slides by the sign of the velocity.
const STILL: f64 = 1e-6;

impl FrictionStop {
    /// No contact.
    pub const OPEN: State = State::plain(0);
    /// Inside the obstacle, but without force.
    pub const RELEASED: State = State::plain(1);
    /// Number of the state in which the slider sticks; its memory is the anchor.
    const STICK: u8 = 2;
    /// Numbers of the states in which it slides, ahead and back.
    const SLIP: [u8; 2] = [3, 4];
    /// The same, where only the damper keeps it from sticking.
    const HELD: [u8; 2] = [5, 6];

    /// A stop that rubs along the coordinate of a second row.
    ///
    /// # Errors
    /// When a number is not finite or out of its range.
    pub fn new(normal: Stop, tangent: Vec<f64>, friction: Friction) -> Result<Self> {
        check_finite("the stop's sliding direction", &tangent)?;
        friction.check()?;
        let size2: f64 = tangent.iter().map(|x| x * x).sum();
        if size2 == 0.0 {
            return Err(Error::NotPositive {
                what: "the motion along the stop's sliding direction",
                value: 0.0,
            });
        }
        Ok(Self {
            rows: [normal.rows()[0].clone(), tangent],
            pace: 1.0 / (friction.stiffness * size2).sqrt(),
            normal,
            friction,
        })
    }

    #[inline(always)]
    fn stick(anchor: f64) -> State {
        State::with_memory(Self::STICK, [anchor, 0.0])
    }

    /// Sliding with the sign `sign`, the slider being where it is when that begins or, in schemes
    /// of fixed steps, at the latest step.
    #[inline(always)]
    fn slip(sign: f64, slider: f64) -> State {
        State::with_memory(Self::SLIP[usize::from(sign < 0.0)], [slider, 0.0])
    }

    fn held(sign: f64, slider: f64) -> State {
        State::with_memory(Self::HELD[usize::from(sign < 0.0)], [slider, 0.0])
    }

    /// The sign of sliding, for states that slide.
    #[inline(always)]
    fn sliding(state: State) -> Option<f64> {
        match state.number {
            3 | 5 => Some(1.0),
            4 | 6 => Some(-1.0),
            _ => None,
        }
    }

    /// The normal stop's own state.
    #[inline(always)]
    fn normal_state(state: State) -> State {
        match state.number {
            0 => Stop::OPEN,
            1 => Stop::RELEASED,
            _ => Stop::CLOSED,
        }
    }

    /// The normal force, as a function of the local motion while the stop is closed.
    fn push(&self) -> Affine {
        let mut push = Affine::ZERO;
        let piece = self.normal.stiffest();
        push.constant = -piece.stiffness[0][0] * self.normal.gap();
        push.position[NORMAL] = -piece.stiffness[0][0];
        push.velocity[NORMAL] = -piece.damping[0][0];
        push
    }

    /// The force of the stick.
    fn stick_force(&self, anchor: f64) -> Affine {
        let mut force = Affine::ZERO;
        force.constant = self.friction.stiffness * anchor;
        force.position[SLIDING] = -self.friction.stiffness;
        force.velocity[SLIDING] = -self.friction.damping;
        force
    }

    /// The force of the slider.
    fn slip_force(&self, sign: f64) -> Affine {
        self.push().times(-sign * self.friction.dynamic_coefficient)
    }

    /// How fast the slider moves on, with or without the stick's damper: positive while it
    /// slides.
    fn progress(&self, sign: f64, with_damper: bool) -> Affine {
        let mut progress = self.slip_force(sign).derivative();
        if with_damper {
            progress.acceleration[SLIDING] += self.friction.damping;
        }
        let mut progress = progress.times(1.0 / self.friction.stiffness);
        progress.velocity[SLIDING] += 1.0;
        progress.times(sign)
    }

    /// What keeps the slider from breaking loose with a sign, as a length.
    fn hold(&self, sign: f64, anchor: f64) -> Affine {
        let cone = self.push().times(self.friction.static_coefficient);
        let force = self.stick_force(anchor).times(sign);
        cone.plus(&force).times(1.0 / self.friction.stiffness)
    }

    /// Stick or slip where contact begins, with the anchor set where the structure is: decided by
    /// the first derivatives of both forces that do not vanish.
    fn begin(&self, acting: impl Fn(State) -> LocalMotion) -> State {
        let anchor = acting(Self::stick(0.0)).position()[SLIDING];
        let motion = acting(Self::stick(anchor));
        let sticking = self.stick_force(anchor).series(&motion);
        let cone = self
            .push()
            .times(self.friction.static_coefficient)
            .series(&motion);
        let Some((first, _)) = sticking.iter().find(|(force, zero)| force.abs() > *zero) else {
            return Self::stick(anchor);
        };
        let sign = -first.signum();
        let room = cone
            .iter()
            .zip(&sticking)
            .map(|(cone, force)| (cone.0 + sign * force.0, cone.1 + force.1));
        match room.into_iter().find(|(room, zero)| room.abs() > *zero) {
            Some((room, _)) if room < 0.0 => self.break_loose(sign, acting),
            _ => Self::stick(anchor),
        }
    }

    /// After the slider has broken loose: its force may have jumped, and accelerations with it.
    fn break_loose(&self, sign: f64, acting: impl Fn(State) -> LocalMotion) -> State {
        let motion = acting(Self::slip(sign, 0.0));
        let (progress, zero) = self.progress(sign, false).value(&motion);
        let slider = self.slider_in(sign, &motion);
        if progress >= -zero {
            Self::slip(sign, slider)
        } else if self.progress(sign, true).value(&motion).0 > 0.0 {
            Self::held(sign, slider)
        } else {
            self.stick_again(sign, &motion)
        }
    }

    /// Sticking after sliding, with the force that the slider has at that instant.
    fn stick_again(&self, sign: f64, motion: &LocalMotion) -> State {
        let (force, _) = self.slip_force(sign).value(motion);
        let carried = force + self.friction.damping * motion.velocity()[SLIDING];
        Self::stick(motion.position()[SLIDING] + carried / self.friction.stiffness)
    }

    /// Where the slider stands while it slides, as far as the stick's spring tells.
    #[inline(always)]
    fn slider(&self, sign: f64, force: f64, position: f64) -> f64 {
        position - sign * self.friction.dynamic_coefficient * force / self.friction.stiffness
    }

    fn slider_in(&self, sign: f64, motion: &LocalMotion) -> f64 {
        let (force, _) = self.push().value(motion);
        self.slider(sign, force, motion.position()[SLIDING])
    }

    /// The sampled state in contact by the sign of the velocity, which states of this rule remember
    /// beside the anchor; a contact that begins slides on as one that slid at no speed.
    #[inline(always)]
    fn sampled_by_velocity(&self, previous: State, x: f64, v: f64, force: f64) -> State {
        let Friction {
            stiffness, damping, ..
        } = self.friction;
        let [anchor, speed] = match previous.number {
            0 | 1 => [x, 0.0],
            _ => previous.memory,
        };
        let remembering = |mut state: State| {
            state.memory[1] = v;
            state
        };
        let slides_on = previous.number != Self::STICK && v * speed >= 0.0 && v.abs() > STILL;
        if !slides_on {
            let trial = -stiffness * (x - anchor) - damping * v;
            if trial.abs() <= self.friction.static_coefficient * force {
                return remembering(Self::stick(anchor));
            }
        }
        let sign = 1f64.copysign(v);
        remembering(Self::slip(sign, self.slider(sign, force, x)))
    }

    /// The sampled state in contact, after one that slid with a sign, or stuck where that is zero;
    /// where the slider stood then.
    #[inline(always)]
    fn sampled_contact(&self, sliding: f64, before: f64, x: f64, v: f64, force: f64) -> State {
        let Friction {
            stiffness, damping, ..
        } = self.friction;
        let mut anchor = before;
        if sliding != 0.0 {
            let slider = self.slider(sliding, force, x);
            if sliding * (slider - before) > 0.0 {
                return Self::slip(sliding, slider);
            }
            // The damper takes its share from here on, without a jump.
            anchor += damping * v / stiffness;
        }
        let trial = -stiffness * (x - anchor) - damping * v;
        if trial.abs() <= self.friction.static_coefficient * force {
            return Self::stick(anchor);
        }
        let sign = -trial.signum();
        Self::slip(sign, self.slider(sign, force, x))
    }

    /// Energy in the stick.
    #[inline(always)]
    fn stored_in_stick<T: Number>(&self, state: State, position: &Local<T>) -> T {
        let Friction {
            stiffness,
            dynamic_coefficient,
            ..
        } = self.friction;
        if state.number == Self::STICK {
            let stretch = position[SLIDING] - T::of(state.memory[0]);
            T::of(0.5 * stiffness) * stretch * stretch
        } else if Self::sliding(state).is_some() {
            let normal = self.normal.stiffest().stiffness[0][0];
            let distance = T::of(self.normal.gap()) + position[NORMAL];
            let force = T::of(dynamic_coefficient * normal) * distance;
            T::of(0.5 / stiffness) * force * force
        } else {
            T::of(0.0)
        }
    }
}

impl Law for FrictionStop {
    fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }

    fn state_name(&self, state: State) -> Cow<'static, str> {
        let names = [
            "open",
            "released",
            "stick",
            "slip forward",
            "slip back",
            "slip forward, held by the damper",
            "slip back, held by the damper",
        ];
        names[state.number as usize].into()
    }

    fn initial_state(&self, motion: &LocalMotion, acting: impl Fn(State) -> LocalMotion) -> State {
        match self.normal.initial_state(motion, &acting) {
            Stop::OPEN => Self::OPEN,
            Stop::RELEASED => Self::RELEASED,
            _ if self.is_stepped() => {
                self.sampled_state(Self::RELEASED, motion.position(), motion.velocity())
            }
            _ => self.begin(acting),
        }
    }

    #[inline(always)]
    fn sampled_state(
        &self,
        previous: State,
        position: &Local<f64>,
        velocity: &Local<f64>,
    ) -> State {
        let closed = match self.normal.sampled_state(previous, position, velocity) {
            Stop::OPEN => return Self::OPEN,
            Stop::RELEASED => return Self::RELEASED,
            closed => closed,
        };
        let (x, v) = (position[SLIDING], velocity[SLIDING]);
        let [force, ..] = self.normal.force(closed, position, velocity);
        if self.is_stepped() {
            return self.sampled_by_velocity(previous, x, v, force);
        }
        let sliding = Self::sliding(previous).unwrap_or(0.0);
        let before = match previous.number {
            0 => {
                // The anchor is where the gap has closed, since the sample before.
                let (distance, rate) = self.normal.distance(position, velocity);
                let since = if rate < 0.0 { distance / rate } else { 0.0 };
                x - v * since
            }
            1 => x,
            _ => previous.memory[0],
        };
        self.sampled_contact(sliding, before, x, v, force)
    }

    #[inline(always)]
    fn force<T: Number>(&self, state: State, position: &Local<T>, velocity: &Local<T>) -> Local<T> {
        let mut force = (self.normal).force(Self::normal_state(state), position, velocity);
        if state.number == Self::STICK {
            let stretch = position[SLIDING] - T::of(state.memory[0]);
            force[SLIDING] = -(T::of(self.friction.stiffness) * stretch
                + T::of(self.friction.damping) * velocity[SLIDING]);
        } else if let Some(sign) = Self::sliding(state) {
            force[SLIDING] = T::of(-sign * self.friction.dynamic_coefficient) * force[NORMAL];
        }
        force
    }

    /// Where the slider stands: the anchor of the stick, while there is contact.
    fn internal_variables(
        &self,
        state: State,
        position: &Local<f64>,
        velocity: &Local<f64>,
    ) -> [f64; 2] {
        let slider = match Self::sliding(state) {
            Some(sign) => {
                let normal = Self::normal_state(state);
                let [push, ..] = self.normal.force(normal, position, velocity);
                self.slider(sign, push, position[SLIDING])
            }
            None if state.number == Self::STICK => state.memory[0],
            None => f64::NAN,
        };
        [slider, f64::NAN]
    }

    /// Where the normal force jumps up the slider stays, and with it the force of the spring: it is
    /// inside the cone now. Where that jumps down the slider goes ahead at once, and slides on.
    fn after_jump(
        &self,
        state: State,
        position: &Local<f64>,
        [before, after]: [&Local<f64>; 2],
    ) -> State {
        let Some(sign) = Self::sliding(state) else {
            return state;
        };
        let push = |velocity| self.normal.force(Stop::CLOSED, position, velocity)[NORMAL];
        let (was, is) = (push(before), push(after));
        if is - was <= JUMP * is.abs().max(was.abs()) {
            return state;
        }
        let carried =
            self.friction.damping * after[SLIDING] - sign * self.friction.dynamic_coefficient * was;
        Self::stick(position[SLIDING] + carried / self.friction.stiffness)
    }

    fn is_stepped(&self) -> bool {
        self.friction.rule == SlidingRule::VelocitySign
    }

    fn is_piecewise_linear(&self) -> bool {
        !self.is_stepped()
    }

    fn piece(&self, state: State) -> Option<Piece> {
        let mut piece = self.normal.piece(Self::normal_state(state))?;
        if state.number == Self::STICK {
            piece.constant[SLIDING] = self.friction.stiffness * state.memory[0];
            piece.stiffness[SLIDING][SLIDING] = self.friction.stiffness;
            piece.damping[SLIDING][SLIDING] = self.friction.damping;
        } else if let Some(sign) = Self::sliding(state) {
            let share = -sign * self.friction.dynamic_coefficient;
            piece.constant[SLIDING] = share * piece.constant[NORMAL];
            piece.stiffness[SLIDING][NORMAL] = share * piece.stiffness[NORMAL][NORMAL];
            piece.damping[SLIDING][NORMAL] = share * piece.damping[NORMAL][NORMAL];
        }
        Some(piece)
    }

    fn guard_count(&self, state: State) -> usize {
        let normal = self.normal.guard_count(Self::normal_state(state));
        match state.number {
            Self::STICK => normal + 2,
            _ => normal + usize::from(Self::sliding(state).is_some()),
        }
    }

    fn guard(&self, state: State, index: usize) -> Guard {
        let normal = Self::normal_state(state);
        if index < self.normal.guard_count(normal) {
            return self.normal.guard(normal, index);
        }
        if let Some(sign) = Self::sliding(state) {
            let held = Self::HELD.contains(&state.number);
            return Guard {
                name: "stick",
                function: self.progress(sign, held).times(self.pace),
            };
        }
        let (name, sign) = match index {
            1 => ("slip forward", 1.0),
            _ => ("slip back", -1.0),
        };
        Guard {
            name,
            function: self.hold(sign, state.memory[0]),
        }
    }

    fn next_state(
        &self,
        state: State,
        guard: usize,
        acting: impl Fn(State) -> LocalMotion,
    ) -> State {
        let normal = Self::normal_state(state);
        if guard < self.normal.guard_count(normal) {
            return match self.normal.next_state(normal, guard, &acting) {
                Stop::OPEN => Self::OPEN,
                Stop::RELEASED => Self::RELEASED,
                _ => self.begin(acting),
            };
        }
        let Some(sign) = Self::sliding(state) else {
            return self.break_loose(if guard == 1 { 1.0 } else { -1.0 }, acting);
        };
        let motion = acting(state);
        let held = Self::HELD.contains(&state.number);
        let (other, zero) = self.progress(sign, !held).value(&motion);
        // Without a damper both are the same function, which has just come to zero.
        if self.friction.damping == 0.0 || other <= zero {
            self.stick_again(sign, &motion)
        } else if held {
            Self::slip(sign, self.slider_in(sign, &motion))
        } else {
            Self::held(sign, self.slider_in(sign, &motion))
        }
    }

    #[inline(always)]
    fn stored<T: Number>(&self, state: State, position: &Local<T>) -> T {
        self.normal.stored(Self::normal_state(state), position)
            + self.stored_in_stick(state, position)
    }

    fn dissipation(&self, state: State) -> Power {
        let normal = self.normal.dissipation(Self::normal_state(state));
        if state.number == Self::STICK {
            return normal.plus(&Power::of_damper(SLIDING, self.friction.damping));
        }
        let Some(sign) = Self::sliding(state) else {
            return normal;
        };
        // The work on the slider, less what goes to the spring that carries it.
        let mut elastic = self.push();
        elastic.velocity = [0.0; 3];
        let elastic = elastic.times(self.friction.dynamic_coefficient);
        normal.plus(&Power::of(&[
            (self.slip_force(sign).times(-1.0), Affine::rate(SLIDING)),
            (
                elastic,
                elastic.derivative().times(-1.0 / self.friction.stiffness),
            ),
        ]))
    }

    fn switch_loss(&self, before: State, after: State, position: &Local<f64>) -> f64 {
        let (from, to) = (Self::normal_state(before), Self::normal_state(after));
        let stick = |state| self.stored_in_stick(state, position);
        self.normal.switch_loss(from, to, position) + stick(before) - stick(after)
    }

    #[inline(always)]
    fn distance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> (T, T) {
        self.normal.distance(position, velocity)
    }

    fn in_contact(&self, state: State) -> bool {
        state != Self::OPEN
    }

    /// Half of the force that sliding couples in counts along each coordinate, by the inequality
    /// of the means.
    fn stiffest(&self) -> Piece {
        let mut piece = self.normal.stiffest();
        let half = 0.5 * self.friction.dynamic_coefficient;
        for (matrix, stick) in [
            (&mut piece.stiffness, self.friction.stiffness),
            (&mut piece.damping, self.friction.damping),
        ] {
            let coupled = half * matrix[NORMAL][NORMAL];
            matrix[NORMAL][NORMAL] += coupled;
            matrix[SLIDING][SLIDING] = stick.max(coupled);
        }
        piece
    }
}
