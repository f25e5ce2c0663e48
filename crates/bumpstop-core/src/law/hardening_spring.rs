//! An elastic-plastic spring that hardens along a curve of straight segments.
//!
//! With the elongation U and its plastic part Up the tension is `F = K (U - Up)`. It yields where
//! |F| reaches R(p) and p, the plastic elongation summed up, grows (isotropic hardening), or where
//! |F - H Up| reaches R(0) (kinematic hardening, one segment). While it yields along a segment the
//! tension has the slope T of that segment, `T = K H / (K + H)`, and Up grows by `1 - T/K` of the
//! elongation: every state is linear. The memory is Up and p where a state begins.
//!
//! Source: J. C. Simo, T. J. R. Hughes, Computational Inelasticity, Springer, 1998, chapter 1.

use super::{Affine, Guard, Law, Local, LocalMotion, Piece, Power, State};
use crate::error::{Error, Result, check_finite, check_length};
use crate::number::Number;
use std::borrow::Cow;

/// How a spring hardens.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hardening {
    /// What it resists grows both ways.
    Isotropic,
    /// What it resists is shifted.
    Kinematic,
}

/// A straight piece of the curve beyond the elastic limit.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Segment {
    /// Plastic elongation summed up, and force, where it begins.
    plastic: f64,
    force: f64,
    /// Slope of the force with the elongation.
    slope: f64,
    /// Slope of the force with the plastic elongation.
    modulus: f64,
}

/// An elastic-plastic spring along one coordinate.
#[derive(Debug, Clone, PartialEq)]
pub struct HardeningSpring {
    rows: [Vec<f64>; 1],
    stiffness: f64,
    segments: Vec<Segment>,
    hardening: Hardening,
    /// A typical time of the spring on the structure, in s/rad; it makes lengths of velocities.
    pace: f64,
}

/// The most segments: states are told apart by a byte, two for each beside the elastic one.
pub const MOST_SEGMENTS: usize = 127;

/// Yielding along a segment from where it began.
#[derive(Debug, Clone, Copy)]
struct Flow {
    segment: Segment,
    /// 1 in tension, -1 in compression.
    sign: f64,
    /// Elongation and force where it began.
    elongation: f64,
    force: f64,
}

impl HardeningSpring {
    /// Elastic.
    pub const ELASTIC: u8 = 0;

    /// A spring of the elongation `row . q` whose tension follows the points (elongation, force)
    /// when it is pulled for the first time: the elastic limit first, and one at least beyond it.
    ///
    /// # Errors
    /// When a number is not finite, the points do not rise or grow steeper than the elastic part,
    /// or there are too many.
    pub fn new(row: Vec<f64>, points: &[[f64; 2]], hardening: Hardening) -> Result<Self> {
        check_finite("the spring's row", &row)?;
        check_finite("the spring's curve", points.as_flattened())?;
        let most = match hardening {
            Hardening::Isotropic => MOST_SEGMENTS,
            Hardening::Kinematic => 1,
        };
        if points.len() < 2 || points.len() > most + 1 {
            let found = vec![0.0; points.len()];
            check_length("the points of the spring's curve", &found, most + 1)?;
        }
        let [limit, force] = points[0];
        for (what, value) in [
            ("the spring's elastic limit", limit),
            ("the spring's force at the elastic limit", force),
        ] {
            if value <= 0.0 {
                return Err(Error::NotPositive { what, value });
            }
        }
        let stiffness = force / limit;
        let size2: f64 = row.iter().map(|r| r * r).sum();
        let segments: Result<_> = (points.windows(2))
            .map(|pair| segment(stiffness, pair[0], pair[1]))
            .collect();
        Ok(Self {
            rows: [row],
            stiffness,
            segments: segments?,
            hardening,
            pace: 1.0 / (stiffness * size2).sqrt(),
        })
    }

    /// The number of the state that yields along a segment with a sign.
    fn number(segment: usize, sign: f64) -> u8 {
        (1 + 2 * segment + usize::from(sign < 0.0)) as u8
    }

    /// The segment and the sign of a state that yields.
    fn yielding(state: State) -> Option<(usize, f64)> {
        let number = (state.number as usize).checked_sub(1)?;
        Some((number / 2, if number % 2 == 0 { 1.0 } else { -1.0 }))
    }

    /// The segment that the plastic elongation summed up has come to.
    fn segment_at(&self, plastic: f64) -> usize {
        let begun = self.segments.partition_point(|s| s.plastic <= plastic);
        begun.max(1) - 1
    }

    /// The tension at which a spring that remembers this yields.
    fn limit(&self, sign: f64, [part, sum]: [f64; 2]) -> f64 {
        match self.hardening {
            Hardening::Isotropic => {
                let segment = self.segments[self.segment_at(sum)];
                sign * (segment.force + segment.modulus * (sum - segment.plastic))
            }
            Hardening::Kinematic => {
                let Segment { force, modulus, .. } = self.segments[0];
                modulus * part + sign * force
            }
        }
    }

    fn flow(&self, state: State) -> Option<Flow> {
        let (segment, sign) = Self::yielding(state)?;
        let force = self.limit(sign, state.memory);
        Some(Flow {
            segment: self.segments[segment],
            sign,
            elongation: state.memory[0] + force / self.stiffness,
            force,
        })
    }

    /// What part of an elongation is plastic along a segment.
    fn share(&self, segment: &Segment) -> f64 {
        1.0 - segment.slope / self.stiffness
    }

    /// The tension as a function of the elongation.
    fn tension(&self, state: State) -> Affine {
        let mut tension = Affine::coordinate(0);
        if let Some(flow) = self.flow(state) {
            tension = tension.times(flow.segment.slope);
            tension.constant = flow.force - flow.segment.slope * flow.elongation;
        } else {
            tension = tension.times(self.stiffness);
            tension.constant = -self.stiffness * state.memory[0];
        }
        tension
    }

    /// The memory after yielding up to an elongation.
    fn memory_at(&self, state: State, elongation: f64) -> [f64; 2] {
        let [part, sum] = state.memory;
        let Some(flow) = self.flow(state) else {
            return state.memory;
        };
        let way = flow.sign * (elongation - flow.elongation);
        let growth = self.share(&flow.segment) * way.max(0.0);
        [part + flow.sign * growth, sum + growth]
    }

    /// How far along the segment the plastic elongation may grow.
    fn room(&self, segment: usize, sum: f64) -> Option<f64> {
        let next = self.segments.get(segment + 1)?;
        Some((next.plastic - sum).max(0.0))
    }

    /// The state in which the next segment begins.
    fn next_segment(&self, state: State) -> State {
        let Some((segment, sign)) = Self::yielding(state) else {
            return state;
        };
        let [part, sum] = state.memory;
        let room = self.room(segment, sum).unwrap_or(0.0);
        let plastic = self.segments[(segment + 1).min(self.segments.len() - 1)].plastic;
        State::with_memory(
            Self::number(segment + 1, sign),
            [part + sign * room, plastic],
        )
    }

    /// Where a spring that remembers this is at an elongation: the return to the yield surface,
    /// segment by segment.
    fn returned(&self, memory: [f64; 2], elongation: f64) -> State {
        let trial = self.stiffness * (elongation - memory[0]);
        let Some(sign) = [1.0, -1.0]
            .into_iter()
            .find(|sign| sign * (trial - self.limit(*sign, memory)) > 0.0)
        else {
            return State::with_memory(Self::ELASTIC, memory);
        };
        let sum = if self.hardening == Hardening::Kinematic {
            0.0
        } else {
            memory[1]
        };
        let mut state = State::with_memory(Self::number(self.segment_at(sum), sign), memory);
        loop {
            let after = self.memory_at(state, elongation);
            let (segment, _) = Self::yielding(state).unwrap_or((0, sign));
            match self.room(segment, state.memory[1]) {
                Some(room) if after[1] - state.memory[1] > room => {
                    state = self.next_segment(state);
                }
                _ => return State::with_memory(state.number, after),
            }
        }
    }

    /// Begins to yield with a sign.
    fn begin(&self, state: State, sign: f64) -> State {
        let segment = match self.hardening {
            Hardening::Isotropic => self.segment_at(state.memory[1]),
            Hardening::Kinematic => 0,
        };
        State::with_memory(Self::number(segment, sign), state.memory)
    }

    /// The plastic part of the elongation as a function of the whole.
    fn plastic_part(&self, state: State) -> Affine {
        let mut part =
            Affine::coordinate(0).plus(&self.tension(state).times(-1.0 / self.stiffness));
        if Self::yielding(state).is_none() {
            part = Affine::ZERO;
            part.constant = state.memory[0];
        }
        part
    }
}

/// The segment between two points of a curve, plastic elongation counted from the elastic limit.
fn segment(stiffness: f64, [from, low]: [f64; 2], [to, high]: [f64; 2]) -> Result<Segment> {
    let slope = (high - low) / (to - from);
    if to <= from {
        return Err(Error::NotPositive {
            what: "the distance between points of the spring's curve",
            value: to - from,
        });
    }
    if slope < 0.0 || slope >= stiffness {
        return Err(Error::Parameter {
            what: "the slope of the spring's curve beyond the elastic limit",
            value: slope,
            low: 0.0,
            high: stiffness,
        });
    }
    Ok(Segment {
        plastic: from - low / stiffness,
        force: low,
        slope,
        modulus: stiffness * slope / (stiffness - slope),
    })
}

impl Law for HardeningSpring {
    fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }

    fn state_name(&self, state: State) -> Cow<'static, str> {
        match Self::yielding(state) {
            None => "elastic".into(),
            Some((segment, sign)) => {
                let way = if sign > 0.0 { "tension" } else { "compression" };
                format!("yields in {way}, segment {}", segment + 1).into()
            }
        }
    }

    /// A spring that begins beyond its limit has been brought there without turning back.
    fn initial_state(&self, motion: &LocalMotion, _: impl Fn(State) -> LocalMotion) -> State {
        let state = self.returned([0.0; 2], motion.position()[0]);
        let Some((_, sign)) = Self::yielding(state) else {
            return state;
        };
        let series = Affine::rate(0).series(motion);
        let decisive = series.iter().find(|(value, zero)| value.abs() > *zero);
        match decisive {
            Some((value, _)) if sign * value > 0.0 => state,
            _ => State::with_memory(Self::ELASTIC, state.memory),
        }
    }

    fn sampled_state(
        &self,
        previous: State,
        position: &Local<f64>,
        _velocity: &Local<f64>,
    ) -> State {
        self.returned(previous.memory, position[0])
    }

    fn force<T: Number>(&self, state: State, position: &Local<T>, velocity: &Local<T>) -> Local<T> {
        let zero = T::of(0.0);
        [-self.tension(state).at(position, velocity), zero, zero]
    }

    /// The plastic elongation, and the same summed up.
    fn internal_variables(
        &self,
        state: State,
        position: &Local<f64>,
        _velocity: &Local<f64>,
    ) -> [f64; 2] {
        self.memory_at(state, position[0])
    }

    fn piece(&self, state: State) -> Option<Piece> {
        let tension = self.tension(state);
        let mut piece = Piece::FREE;
        piece.constant[0] = -tension.constant;
        piece.stiffness[0][0] = tension.position[0];
        Some(piece)
    }

    fn guard_count(&self, state: State) -> usize {
        match Self::yielding(state) {
            Some((segment, _)) if segment + 1 == self.segments.len() => 1,
            _ => 2,
        }
    }

    fn guard(&self, state: State, index: usize) -> Guard {
        let Some(flow) = self.flow(state) else {
            let sign = if index == 0 { 1.0 } else { -1.0 };
            let limit = self.limit(sign, state.memory) / self.stiffness + state.memory[0];
            let mut function = Affine::coordinate(0).times(-sign);
            function.constant = sign * limit;
            let name = if index == 0 {
                "yield in tension"
            } else {
                "yield in compression"
            };
            return Guard { name, function };
        };
        if index == 0 {
            return Guard {
                name: "turn back",
                function: Affine::rate(0).times(flow.sign * self.pace),
            };
        }
        let (segment, sign) = Self::yielding(state).unwrap_or((0, flow.sign));
        let room = self.room(segment, state.memory[1]).unwrap_or(0.0);
        let mut function = Affine::coordinate(0).times(-sign);
        function.constant = sign * flow.elongation + room / self.share(&flow.segment);
        Guard {
            name: "next segment",
            function,
        }
    }

    fn next_state(
        &self,
        state: State,
        guard: usize,
        acting: impl Fn(State) -> LocalMotion,
    ) -> State {
        match (Self::yielding(state), guard) {
            (None, 0) => self.begin(state, 1.0),
            (None, _) => self.begin(state, -1.0),
            (Some(_), 0) => {
                let elongation = acting(state).position()[0];
                State::with_memory(Self::ELASTIC, self.memory_at(state, elongation))
            }
            _ => self.next_segment(state),
        }
    }

    fn stored<T: Number>(&self, state: State, position: &Local<T>) -> T {
        let still = [T::of(0.0); super::COORDINATES];
        let tension = self.tension(state).at(position, &still);
        let elastic = T::of(0.5 / self.stiffness) * tension * tension;
        match self.hardening {
            Hardening::Isotropic => elastic,
            Hardening::Kinematic => {
                let part = self.plastic_part(state).at(position, &still);
                elastic + T::of(0.5 * self.segments[0].modulus) * part * part
            }
        }
    }

    fn dissipation(&self, state: State) -> Power {
        let Some(flow) = self.flow(state) else {
            return Power::NONE;
        };
        let rate = Affine::rate(0).times(self.share(&flow.segment));
        let force = match self.hardening {
            Hardening::Isotropic => self.tension(state),
            Hardening::Kinematic => Affine {
                constant: flow.sign * self.segments[0].force,
                ..Affine::ZERO
            },
        };
        Power::of(&[(force, rate)])
    }

    fn distance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> (T, T) {
        (position[0], velocity[0])
    }

    fn stiffest(&self) -> Piece {
        let mut piece = Piece::FREE;
        piece.stiffness[0][0] = self.stiffness;
        piece
    }
}
