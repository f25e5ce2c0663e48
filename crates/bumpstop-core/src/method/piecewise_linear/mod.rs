//! stub
use crate::energy::Ledger;
use crate::error::Result;
use crate::history::History;
use crate::impacts::Impact;
use crate::law::{Law, State};
use crate::method::Observer;
use crate::problem::Problem;
#[derive(Debug, Clone)]
pub struct PhaseRecord;
pub fn simulate<L: Law>(_p: &Problem<L>, _o: Observer<'_>) -> Result<History<L>> { Err(crate::error::Error::Eigenvalues) }
impl PhaseRecord {
    pub fn cells(&self) -> usize { 0 }
    pub fn missed_penetration(&self) -> f64 { 0.0 }
    pub fn phase_at(&self, _t: f64) -> usize { 0 }
    pub fn motion(&self, _p: usize, _t: f64, _q: &mut [f64], _v: &mut [f64]) {}
    pub fn states(&self, _p: usize) -> &[State] { &[] }
    pub fn ledger<L: Law>(&self, _p: &Problem<L>, _t: f64) -> Ledger { Ledger::default() }
    pub fn energy_residual<L: Law>(&self, _p: &Problem<L>) -> f64 { 0.0 }
    pub fn impacts<L: Law>(&self, _p: &Problem<L>, _l: usize) -> Vec<Impact> { vec![] }
}
