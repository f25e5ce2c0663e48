//! A problem: structure, laws, forcing, initial state and duration.

use crate::error::{Error, Result, check_finite, check_length};
use crate::forcing::{Forcing, Moved};
use crate::law::{Law, Local, State, project};
use crate::system::ModalSystem;

/// All that a method needs.
#[derive(Debug, Clone)]
pub struct Problem<L> {
    /// The linear structure.
    pub system: ModalSystem,
    /// Where it is not linear.
    pub laws: Vec<L>,
    /// Loads.
    pub forcing: Forcing,
    /// Modal displacements at t = 0.
    pub displacement: Vec<f64>,
    /// Modal velocities at t = 0.
    pub velocity: Vec<f64>,
    /// Length of the run, in s.
    pub duration: f64,
    /// The laws' states at t = 0, which the motion decides where there are none.
    pub(crate) states: Vec<State>,
}

impl<L: Law> Problem<L> {
    /// Puts the parts together.
    ///
    /// # Errors
    /// When lengths do not agree, a number is not finite or the duration not positive.
    pub fn new(
        system: ModalSystem,
        laws: Vec<L>,
        forcing: Forcing,
        displacement: Vec<f64>,
        velocity: Vec<f64>,
        duration: f64,
    ) -> Result<Self> {
        let modes = system.modes();
        check_length("force", forcing.forces(), modes)?;
        check_length("displacement", &displacement, modes)?;
        check_length("velocity", &velocity, modes)?;
        check_finite("displacement", &displacement)?;
        check_finite("velocity", &velocity)?;
        check_finite("duration", &[duration])?;
        if duration <= 0.0 {
            return Err(Error::NotPositive {
                what: "duration",
                value: duration,
            });
        }
        for row in laws.iter().flat_map(Law::rows) {
            check_length("a law's row", row, modes)?;
        }
        let can_move = |moved: &Moved| {
            let law = laws
                .get(moved.law)
                .filter(|law| law.restitution().is_none());
            law.is_some_and(|law| moved.coordinate < law.rows().len())
        };
        if let Some(Moved { law, .. }) = forcing.moved().find(|moved| !can_move(moved)) {
            return Err(Error::Immovable { law });
        }
        Ok(Self {
            system,
            laws,
            forcing,
            displacement,
            velocity,
            duration,
            states: Vec::new(),
        })
    }

    /// The same from given states of the laws on, such as those at the end of another run of these
    /// laws; rigid stops begin in those that the motion decides.
    ///
    /// # Errors
    /// When there is not one a law, or a memory is not finite.
    pub fn with_states(self, states: Vec<State>) -> Result<Self> {
        if states.len() != self.laws.len() {
            return Err(Error::Length {
                what: "the list of the laws' states",
                found: states.len(),
                expected: self.laws.len(),
            });
        }
        for state in &states {
            check_finite("the memory of a law's state", &state.memory)?;
        }
        Ok(Self { states, ..self })
    }

    /// Local position and velocity of a law at a time, measured from its obstacle.
    pub(crate) fn local(
        &self,
        law: usize,
        time: f64,
        displacement: &[f64],
        velocity: &[f64],
    ) -> [Local<f64>; 2] {
        let which = &self.laws[law];
        let local = [project(which, displacement), project(which, velocity)];
        self.seen_from_obstacle(law, time, local)
    }

    /// Local position and velocity of a law at a time less those of its obstacle.
    pub(crate) fn seen_from_obstacle(
        &self,
        law: usize,
        time: f64,
        local: [Local<f64>; 2],
    ) -> [Local<f64>; 2] {
        if self.forcing.varies() {
            return self.forcing.seen_from_obstacle(law, time, local);
        }
        local
    }
}
