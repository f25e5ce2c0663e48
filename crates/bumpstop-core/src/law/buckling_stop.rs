//! A stop that buckles: elastic up to a critical force, then crushed at a lower one.
//!
//! With the crushing s, the distance's other sign, the force is `k s` until it reaches the critical
//! one Fc at `s = Fc/k`. There the stop buckles. Crushed on, it pushes with Fc over a plateau, then
//! falls along a line to the post-buckling force Fp, and keeps that. Where the crushing turns back
//! at s_m, with the force F_m, it unloads along the line through that point and the residual
//! crushing p, and loads again along it; below p there is no contact. The residual crushing is
//! `p = s_m - Fp/k_u`, not less than zero, with the unloading stiffness k_u of the post-buckling
//! force, which may depend on p. Dampers act beside, one before buckling and one after; the force
//! never pulls. What is stored after buckling is what unloading would give back, `F (s - p)/2`.
//!
//! Source: the buckling contact of code_aster's manual R5.06.03; there what unloads from the
//! plateau or the fall begins at Fp, with a jump.

use super::{Affine, Guard, Law, Local, LocalMotion, Piece, Power, State, Stop};
use crate::error::{Error, Result, check_finite};
use crate::number::Number;
use std::borrow::Cow;

/// What a stop that buckles is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Buckling {
    /// Force at which it buckles, in N.
    pub critical_force: f64,
    /// Force at which it is crushed on, in N, not above the critical one.
    pub post_force: f64,
    /// Crushing at the critical force before it falls, in m.
    pub plateau: f64,
    /// Crushing over which it falls to the post-buckling force, in m.
    pub fall: f64,
    /// Damping constant after buckling, in N s/m.
    pub post_damping: f64,
    /// Unloading stiffness in N/m at residual crushings in m, in ascending order; between them it
    /// follows straight lines, beyond them it stays.
    pub unloading: Vec<[f64; 2]>,
}

/// A stop on a plane that buckles.
#[derive(Debug, Clone, PartialEq)]
pub struct BucklingStop {
    /// The stop that it is before.
    elastic: Stop,
    buckling: Buckling,
    /// A typical time of the contact on the structure, in s/rad; it makes lengths of velocities.
    pace: f64,
    /// Largest crushings at which what is stored bends.
    bends: Vec<f64>,
}

// Numbers of the states; the first three are those of a stop.
const CLOSED: u8 = 1;
const PLATEAU: u8 = 3;
const FALL: u8 = 4;
const POST: u8 = 5;
const UNLOADING: [u8; 3] = [6, 7, 8];
const CRUSHED: u8 = 9;
const LET_GO: u8 = 10;

/// The part of the crushing by which a residual one may be negative by rounding.
const SPARE: f64 = 1e-12;

/// The line along which a crushed stop unloads.
#[derive(Debug, Clone, Copy)]
struct Line {
    residual: f64,
    stiffness: f64,
}

/// The unloading stiffness between two points of its table, by the residual crushing.
#[derive(Debug, Clone, Copy)]
struct Section {
    constant: f64,
    slope: f64,
}

impl Section {
    /// Behind so many points.
    fn of(buckling: &Buckling, points: usize) -> Self {
        let table = &buckling.unloading;
        if points == 0 || points == table.len() {
            let [_, constant] = table[points.max(1) - 1];
            return Self {
                constant,
                slope: 0.0,
            };
        }
        let [[p, k], [q, l]] = [table[points - 1], table[points]];
        let slope = (l - k) / (q - p);
        Self {
            constant: k - slope * p,
            slope,
        }
    }

    fn at(&self, residual: f64) -> f64 {
        self.constant + self.slope * residual
    }
}

impl BucklingStop {
    /// A stop that is `elastic` before it buckles.
    ///
    /// # Errors
    /// When a number is not finite or out of its range, or the residual crushing would be negative.
    pub fn new(elastic: Stop, buckling: Buckling) -> Result<Self> {
        let Buckling {
            critical_force,
            post_force,
            plateau,
            fall,
            post_damping,
            ref unloading,
        } = buckling;
        check_finite("the unloading stiffness", unloading.as_flattened())?;
        for (what, value) in [
            ("the critical force", critical_force),
            ("the post-buckling force", post_force),
        ] {
            check_finite(what, &[value])?;
            if value <= 0.0 {
                return Err(Error::NotPositive { what, value });
            }
        }
        for (what, value) in [
            (
                "the critical less the post-buckling force",
                critical_force - post_force,
            ),
            ("the plateau of a stop that buckles", plateau),
            ("the fall of a stop that buckles", fall),
            ("the damping after buckling", post_damping),
        ] {
            check_finite(what, &[value])?;
            if value < 0.0 {
                return Err(Error::Negative { what, value });
            }
        }
        if unloading.is_empty() {
            return Err(Error::NotPositive {
                what: "the number of unloading stiffnesses",
                value: 0.0,
            });
        }
        for pair in unloading.windows(2) {
            // What is gained along a step of residual crushing must not be lost in elasticity.
            let [[p, k], [q, l]] = [pair[0], pair[1]];
            let step = (q - p) + post_force / l - post_force / k;
            if q <= p || step <= 0.0 {
                return Err(Error::NotPositive {
                    what: "a step of the crushing along the unloading stiffnesses",
                    value: if q <= p { q - p } else { step },
                });
            }
        }
        if let Some([_, value]) = unloading.iter().find(|[_, k]| *k <= 0.0) {
            return Err(Error::NotPositive {
                what: "the unloading stiffness",
                value: *value,
            });
        }
        let size2: f64 = elastic.rows()[0].iter().map(|r| r * r).sum();
        let stiffness = elastic.stiffest().stiffness[0][0];
        let stop = Self {
            pace: 1.0 / (stiffness * size2).sqrt(),
            bends: Self::bends_of(&buckling),
            elastic,
            buckling,
        };
        let [buckles, plateau_ends, fall_ends] = stop.stages();
        let spare = buckles + (fall_ends - plateau_ends) - stop.bends[0];
        if spare < -SPARE * buckles {
            return Err(Error::Negative {
                what: "the residual crushing of a stop that has just buckled",
                value: spare,
            });
        }
        Ok(stop)
    }

    fn stiffness(&self) -> f64 {
        self.elastic.stiffest().stiffness[0][0]
    }

    /// The crushing as a function of the local motion.
    fn crushing(&self) -> Affine {
        let mut crushing = Affine::coordinate(0).times(-1.0);
        crushing.constant = -self.elastic.gap();
        crushing
    }

    /// Crushings at which it buckles, at which it falls, and at which it has fallen.
    fn stages(&self) -> [f64; 3] {
        let first = self.buckling.critical_force / self.stiffness();
        let second = first + self.buckling.plateau;
        [first, second, second + self.buckling.fall]
    }

    /// The state that loads on at a crushing.
    fn loading_at(&self, crushing: f64) -> u8 {
        let [_, plateau_ends, fall_ends] = self.stages();
        if crushing < plateau_ends {
            PLATEAU
        } else if crushing < fall_ends {
            FALL
        } else {
            POST
        }
    }

    /// The spring's force on the way down of a first crushing, as a function of the crushing.
    fn loading(&self, number: u8) -> (f64, f64) {
        let Buckling {
            critical_force,
            post_force,
            fall,
            ..
        } = self.buckling;
        match number {
            PLATEAU => (critical_force, 0.0),
            FALL => {
                let slope = (post_force - critical_force) / fall;
                let [_, begins, _] = self.stages();
                (critical_force - slope * begins, slope)
            }
            _ => (post_force, 0.0),
        }
    }

    /// Where the residual crushing begins to grow with the largest one, and where the table of
    /// unloading stiffnesses bends, as largest crushings in ascending order.
    fn bends_of(buckling: &Buckling) -> Vec<f64> {
        let (table, force) = (&buckling.unloading, buckling.post_force);
        let above = table.partition_point(|[p, _]| *p <= 0.0);
        let at_none = force / Section::of(buckling, above).at(0.0);
        let knots = table[above..].iter().map(|[p, k]| p + force / k);
        std::iter::once(at_none).chain(knots).collect()
    }

    /// The number of bends that a largest crushing is beyond.
    fn bends_before(&self, crushing: f64) -> usize {
        self.bends.partition_point(|bend| *bend <= crushing)
    }

    /// The first bend after the crushing that a state began to load at.
    fn next_bend(&self, state: State) -> Option<f64> {
        if self.is_piecewise_linear() {
            return None;
        }
        self.bends.get(self.bends_before(state.memory[0])).copied()
    }

    /// What unloading gives back after a largest crushing, and how the residual crushing, which
    /// is the rest, changes with that: as between the bends before and after another crushing.
    fn given_back(&self, crushing: f64, near: f64) -> (f64, f64) {
        let Some(section) = self.bends_before(near).checked_sub(1) else {
            return (crushing, 0.0);
        };
        let knots = self.buckling.unloading.iter();
        let first = knots.take_while(|[p, _]| *p <= 0.0).count();
        let force = self.buckling.post_force;
        // With the stiffness `K = k + slope p` at the residual crushing `p = s - F/K`.
        let Section { constant, slope } = Section::of(&self.buckling, first + section);
        let sum = constant + slope * crushing;
        let stiffness = 0.5 * (sum + (sum * sum - 4.0 * slope * force).max(0.0).sqrt());
        let give = force / stiffness;
        (give, 1.0 / (1.0 - slope * give / stiffness))
    }

    /// The line along which it unloads from a largest crushing with its force.
    fn unloading(&self, [crushing, force]: [f64; 2]) -> Line {
        let (give, _) = self.given_back(crushing, crushing);
        Line {
            residual: crushing - give,
            stiffness: force / give,
        }
    }

    /// Which of the states that load goes on where one that unloads comes back.
    fn reloads(&self, state: State) -> u8 {
        PLATEAU + (state.number - UNLOADING[0])
    }

    /// The spring's force as a function of the local motion, of states that push after buckling.
    fn spring(&self, state: State) -> Option<Affine> {
        let crushing = self.crushing();
        match state.number {
            PLATEAU..=POST => {
                let (constant, slope) = self.loading(state.number);
                let mut force = crushing.times(slope);
                force.constant += constant;
                Some(force)
            }
            number if UNLOADING.contains(&number) => {
                let line = self.unloading(state.memory);
                let mut force = crushing.times(line.stiffness);
                force.constant -= line.stiffness * line.residual;
                Some(force)
            }
            _ => None,
        }
    }

    /// The same with the damper.
    fn push(&self, state: State) -> Option<Affine> {
        let damper = Affine::rate(0).times(-self.buckling.post_damping);
        self.spring(state).map(|spring| spring.plus(&damper))
    }

    /// The state before buckling, if it is one.
    fn before(state: State) -> Option<State> {
        (state.number < PLATEAU).then_some(State::plain(state.number))
    }

    /// Begins to load on at a crushing.
    fn load(&self, number: u8, crushing: f64) -> State {
        let (constant, slope) = self.loading(number);
        State::with_memory(number, [crushing, constant + slope * crushing])
    }

    /// Turns back from a crushing.
    fn unload(&self, number: u8, crushing: f64) -> State {
        let State { memory, .. } = self.load(number, crushing);
        State::with_memory(UNLOADING[(number - PLATEAU) as usize], memory)
    }

    /// The state that it unloads or loads again in.
    fn held(&self, state: State) -> State {
        let number = self.loading_at(state.memory[0]);
        State::with_memory(UNLOADING[(number - PLATEAU) as usize], state.memory)
    }

    /// Guards of a state that loads on, beside the bends of what is stored.
    fn own_guards(&self, state: State) -> usize {
        if state.number == POST { 1 } else { 2 }
    }

    fn is_damped(&self) -> bool {
        self.buckling.post_damping > 0.0
    }

    /// A guard as a length: a force over the stiffness.
    fn force_guard(&self, name: &'static str, force: &Affine, sign: f64) -> Guard {
        Guard {
            name,
            function: force.times(sign / self.stiffness()),
        }
    }

    fn crushing_guard(&self, name: &'static str, at: f64, sign: f64) -> Guard {
        let mut function = self.crushing().times(sign);
        function.constant -= sign * at;
        Guard { name, function }
    }

    /// The crushing from which it loads on, after buckling.
    fn sampled_after(&self, previous: State, crushing: f64, push: impl Fn(State) -> f64) -> State {
        let largest = previous.memory[0];
        if crushing > largest {
            return self.load(self.loading_at(crushing), crushing);
        }
        let held = self.held(previous);
        if crushing <= self.unloading(held.memory).residual {
            State::with_memory(CRUSHED, held.memory)
        } else if push(held) >= 0.0 {
            held
        } else {
            State::with_memory(LET_GO, held.memory)
        }
    }

    /// What is stored per crushing while it loads on: the slope of `F (s - p)/2`. It goes on
    /// smoothly beyond the bend that ends the state's stretch.
    fn storing(&self, state: State, crushing: f64) -> f64 {
        let (constant, slope) = self.loading(state.number);
        let (give, rate) = self.given_back(crushing, state.memory[0]);
        0.5 * (slope * give + (constant + slope * crushing) * (1.0 - rate))
    }
}

impl Law for BucklingStop {
    fn rows(&self) -> &[Vec<f64>] {
        self.elastic.rows()
    }

    fn state_name(&self, state: State) -> Cow<'static, str> {
        [
            "open",
            "closed",
            "released",
            "buckling",
            "falling",
            "crushing",
            "unloading",
            "unloading",
            "unloading",
            "open, crushed",
            "released, crushed",
        ][state.number as usize]
            .into()
    }

    fn initial_state(&self, motion: &LocalMotion, acting: impl Fn(State) -> LocalMotion) -> State {
        let crushing = -self.elastic.gap() - motion.position()[0];
        if crushing < self.stages()[0] {
            return self.elastic.initial_state(motion, acting);
        }
        let number = self.loading_at(crushing);
        let series = Affine::rate(0).series(motion);
        let decisive = series.iter().find(|(value, zero)| value.abs() > *zero);
        match decisive {
            Some((value, _)) if *value < 0.0 => self.load(number, crushing),
            _ => self.unload(number, crushing),
        }
    }

    fn sampled_state(
        &self,
        previous: State,
        position: &Local<f64>,
        velocity: &Local<f64>,
    ) -> State {
        let crushing = -self.elastic.gap() - position[0];
        match Self::before(previous) {
            Some(_) if crushing >= self.stages()[0] => {
                self.load(self.loading_at(crushing), crushing)
            }
            Some(before) => self.elastic.sampled_state(before, position, velocity),
            None => self.sampled_after(previous, crushing, |state| {
                self.push(state)
                    .map_or(0.0, |push| push.at(position, velocity))
            }),
        }
    }

    fn force<T: Number>(&self, state: State, position: &Local<T>, velocity: &Local<T>) -> Local<T> {
        if let Some(before) = Self::before(state) {
            return self.elastic.force(before, position, velocity);
        }
        let zero = T::of(0.0);
        let push = (self.push(state)).map_or(zero, |push| push.at(position, velocity).max(zero));
        [push, zero, zero]
    }

    /// The stiffness of unloading hangs on the memory where there is a fall or a table.
    fn is_piecewise_linear(&self) -> bool {
        self.buckling.fall == 0.0 && self.buckling.unloading.len() == 1
    }

    fn piece(&self, state: State) -> Option<Piece> {
        if let Some(before) = Self::before(state) {
            return self.elastic.piece(before);
        }
        let mut piece = Piece::FREE;
        if let Some(push) = self.push(state) {
            piece.constant[0] = push.constant;
            piece.stiffness[0][0] = -push.position[0];
            piece.damping[0][0] = -push.velocity[0];
        }
        Some(piece)
    }

    /// The largest crushing since it buckled, and what would be left of it without force.
    fn internal_variables(
        &self,
        state: State,
        position: &Local<f64>,
        velocity: &Local<f64>,
    ) -> [f64; 2] {
        let memory = match state.number {
            PLATEAU..=POST => {
                let crushing = -self.distance(position, velocity).0;
                self.load(state.number, crushing.max(state.memory[0]))
                    .memory
            }
            _ if Self::before(state).is_some() => return [0.0; 2],
            _ => state.memory,
        };
        [memory[0], self.unloading(memory).residual]
    }

    fn guard_count(&self, state: State) -> usize {
        match state.number {
            CLOSED => 2,
            PLATEAU..=POST => self.own_guards(state) + usize::from(self.next_bend(state).is_some()),
            LET_GO => 2,
            CRUSHED => 1,
            number if UNLOADING.contains(&number) => 2,
            _ => Self::before(state).map_or(0, |before| self.elastic.guard_count(before)),
        }
    }

    fn guard(&self, state: State, index: usize) -> Guard {
        let [buckles, plateau_ends, fall_ends] = self.stages();
        let line = || self.unloading(state.memory);
        match (state.number, index) {
            (CLOSED, 1) => self.crushing_guard("buckling", buckles, -1.0),
            (PLATEAU..=POST, index) if index == self.own_guards(state) => {
                let bend = self.next_bend(state).unwrap_or(f64::INFINITY);
                self.crushing_guard("bend of the residual crushing", bend, -1.0)
            }
            (PLATEAU, 1) => self.crushing_guard("falling", plateau_ends, -1.0),
            (FALL, 1) => self.crushing_guard("crushing", fall_ends, -1.0),
            (PLATEAU..=POST, _) => Guard {
                name: "turn back",
                function: Affine::rate(0).times(-self.pace),
            },
            (LET_GO, 0) => self.crushing_guard("opening", line().residual, 1.0),
            (LET_GO, _) => {
                let held = self.push(self.held(state)).unwrap_or(Affine::ZERO);
                self.force_guard("hold", &held, -1.0)
            }
            (CRUSHED, _) => self.crushing_guard("closing", line().residual, -1.0),
            (number, 1) if UNLOADING.contains(&number) => {
                self.crushing_guard("crushing on", state.memory[0], -1.0)
            }
            (number, _) if UNLOADING.contains(&number) => {
                if self.is_damped() {
                    let push = self.push(state).unwrap_or(Affine::ZERO);
                    self.force_guard("release", &push, 1.0)
                } else {
                    self.crushing_guard("opening", line().residual, 1.0)
                }
            }
            _ => self.elastic.guard(State::plain(state.number), index),
        }
    }

    fn next_state(
        &self,
        state: State,
        guard: usize,
        acting: impl Fn(State) -> LocalMotion,
    ) -> State {
        let [buckles, plateau_ends, fall_ends] = self.stages();
        let with = |number| State::with_memory(number, state.memory);
        match (state.number, guard) {
            (CLOSED, 1) => self.load(self.loading_at(buckles), buckles),
            (PLATEAU..=POST, guard) if guard == self.own_guards(state) => {
                let bend = self.next_bend(state).unwrap_or(state.memory[0]);
                self.load(state.number, bend)
            }
            (PLATEAU, 1) => self.load(self.loading_at(plateau_ends), plateau_ends),
            (FALL, 1) => self.load(POST, fall_ends),
            (PLATEAU..=POST, _) => {
                let crushing = -self.elastic.gap() - acting(state).position()[0];
                self.unload(state.number, crushing)
            }
            (LET_GO, 0) => with(CRUSHED),
            (LET_GO, _) | (CRUSHED, _) => self.held(state),
            (number, 1) if UNLOADING.contains(&number) => {
                self.load(self.reloads(state), state.memory[0])
            }
            (number, _) if UNLOADING.contains(&number) => {
                with(if self.is_damped() { LET_GO } else { CRUSHED })
            }
            _ => (self.elastic).next_state(State::plain(state.number), guard, acting),
        }
    }

    fn stored<T: Number>(&self, state: State, position: &Local<T>) -> T {
        if let Some(before) = Self::before(state) {
            return self.elastic.stored(before, position);
        }
        let Some(spring) = self.spring(state) else {
            return T::of(0.0);
        };
        let still = [T::of(0.0); super::COORDINATES];
        let crushing = self.crushing().at(position, &still);
        let give = if UNLOADING.contains(&state.number) {
            crushing - T::of(self.unloading(state.memory).residual)
        } else {
            let near = state.memory[0];
            let slope = |[s]: [f64; 1]| [1.0 - self.given_back(s, near).1];
            T::function([crushing], |[s]| self.given_back(s, near).0, slope)
        };
        T::of(0.5) * spring.at(position, &still) * give
    }

    fn dissipation(&self, state: State) -> Power {
        if let Some(before) = Self::before(state) {
            return self.elastic.dissipation(before);
        }
        let damper = Power::of_damper(0, self.buckling.post_damping);
        match (state.number, self.spring(state)) {
            (PLATEAU..=POST, Some(force)) => {
                damper.plus(&Power::of(&[(force, Affine::rate(0).times(-1.0))]))
            }
            (_, Some(_)) => damper,
            _ => Power::NONE,
        }
    }

    fn dissipated_power<T: Number>(
        &self,
        state: State,
        position: &Local<T>,
        velocity: &Local<T>,
    ) -> T {
        let power = self.dissipation(state).at(position, velocity);
        if self.is_piecewise_linear() || !(PLATEAU..=POST).contains(&state.number) {
            return power;
        }
        let crushing = self.crushing().at(position, velocity);
        let storing = T::function([crushing], |[s]| self.storing(state, s), |_| [f64::NAN]);
        power + storing * velocity[0]
    }

    fn switch_loss(&self, before: State, after: State, position: &Local<f64>) -> f64 {
        let stored = |state| self.stored(state, position);
        match (Self::before(before), Self::before(after)) {
            (Some(before), Some(after)) => self.elastic.switch_loss(before, after, position),
            _ => stored(before) - stored(after),
        }
    }

    fn distance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> (T, T) {
        self.elastic.distance(position, velocity)
    }

    fn in_contact(&self, state: State) -> bool {
        state.number != Stop::OPEN.number && state.number != CRUSHED
    }

    fn stiffest(&self) -> Piece {
        let mut piece = self.elastic.stiffest();
        let share = self.buckling.critical_force / self.buckling.post_force;
        for [_, stiffness] in &self.buckling.unloading {
            piece.stiffness[0][0] = piece.stiffness[0][0].max(share * stiffness);
        }
        piece.damping[0][0] = piece.damping[0][0].max(self.buckling.post_damping);
        piece
    }
}
