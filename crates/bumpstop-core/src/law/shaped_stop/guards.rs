//! What the guards of a shaped stop are made of.

use super::{CLOSED, NEAR, OPEN, RELEASED, STICK, ShapedStop};
use crate::law::{Local, State, rubbing};
use crate::number::Number;

/// Parts of a polygon's inner circle at which a sector is looked for, and no longer.
pub(super) const NEARING: f64 = 0.95;
const LEAVING: f64 = 0.9;

/// What a guard is made of.
#[derive(Clone, Copy)]
pub(super) enum Watched {
    /// The distance, times a sign.
    Clearance(f64),
    /// The normal force as a length, times a sign.
    Push(f64),
    /// What is left of the cone of friction, or is beyond it.
    Margin,
    /// The two rays of a polygon's sector.
    Ray(usize),
    /// A part of a polygon's inner circle, and a sign.
    Within(f64, f64),
}

impl Watched {
    /// Its name in a state, for the list of events.
    pub(super) fn name(self, state: State) -> &'static str {
        match (self, state.number) {
            (Self::Clearance(_), OPEN | NEAR) => "closing",
            (Self::Clearance(_), _) => "opening",
            (Self::Push(_), RELEASED) => "hold",
            (Self::Push(_), _) => "release",
            (Self::Margin, STICK) => "slip",
            (Self::Margin, _) => "stick",
            (Self::Within(..), OPEN) => "near",
            (Self::Within(..), _) => "away",
            (Self::Ray(_), _) => "corner",
        }
    }
}

impl ShapedStop {
    /// How many guards a state has.
    pub(super) fn watched_count(&self, state: State) -> usize {
        let own = match state.number {
            OPEN | CLOSED => 1,
            _ => 2,
        };
        let rays = self.shape.polygon().is_some() && state.number != OPEN;
        own + if rays { 2 } else { 0 }
    }

    /// What the guards of a state are, those of a polygon's sector last.
    pub(super) fn watched(&self, state: State, index: usize) -> Watched {
        let firm = if self.damping == 0.0 {
            Watched::Clearance(-1.0)
        } else {
            Watched::Push(1.0)
        };
        let in_polygon = self.shape.polygon().is_some();
        let own: &[Watched] = match state.number {
            OPEN if in_polygon => &[Watched::Within(NEARING, 1.0)],
            OPEN => &[Watched::Clearance(1.0)],
            NEAR => &[Watched::Clearance(1.0), Watched::Within(LEAVING, -1.0)],
            RELEASED => &[Watched::Clearance(-1.0), Watched::Push(-1.0)],
            CLOSED => &[firm],
            _ => &[firm, Watched::Margin],
        };
        match own.get(index) {
            Some(watched) => *watched,
            None => Watched::Ray(index - own.len()),
        }
    }

    /// The value of what is watched in a state, from position and velocity.
    #[inline(always)]
    pub(super) fn value_of<T: Number>(
        &self,
        watched: Watched,
        state: State,
        [position, velocity]: [&Local<T>; 2],
        memory: &[T; 2],
    ) -> T {
        match (watched, self.shape.polygon(), &self.friction) {
            (Watched::Clearance(sign), ..) => T::of(sign) * self.clearance(state, position),
            (Watched::Push(sign), ..) => {
                let touch = self.touch(state, position, velocity);
                T::of(sign / self.stiffness) * self.push(&touch)
            }
            (Watched::Margin, _, Some(friction)) => {
                let touch = self.touch(state, position, velocity);
                let push = self.push(&touch);
                rubbing::margin(friction, state.number == STICK, *memory, touch.along, push)
            }
            (Watched::Ray(which), Some(polygon), _) => {
                polygon.rays(usize::from(state.part), self.place(position))[which]
            }
            (Watched::Within(part, sign), Some(polygon), _) => {
                T::of(sign) * polygon.within(part, self.place(position))
            }
            // Nothing else is watched: a stop that does not rub has no margin, a circle no rays.
            _ => T::of(1.0),
        }
    }
}
