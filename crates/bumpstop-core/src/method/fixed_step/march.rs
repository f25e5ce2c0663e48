//! Marches through time, compiled anew for the usual sizes of problems and kinds of laws.

use super::many::MANY;
use super::setting::Setting;
use crate::error::Result;
use crate::law::{Law, Stop};
use crate::number::{Instructions, LANES, Lanes, Vectorised, blocks, dispatch};
use crate::problem::Problem;

/// How many things of a kind a march has, so that the same text serves a number known when
/// compiling, whose things live in registers, and any other.
pub(crate) trait Count {
    /// That many things.
    type Of<T>: AsRef<[T]> + AsMut<[T]>;

    /// Makes each of `count` things from its number.
    fn make<T>(count: usize, each: impl FnMut(usize) -> T) -> Self::Of<T>;
}

/// Just `N`.
pub(crate) struct Fixed<const N: usize>;

impl<const N: usize> Count for Fixed<N> {
    type Of<T> = [T; N];
    #[inline(always)]
    fn make<T>(count: usize, each: impl FnMut(usize) -> T) -> [T; N] {
        assert_eq!(count, N);
        std::array::from_fn(each)
    }
}

/// Any number.
pub(crate) struct Any;

impl Count for Any {
    type Of<T> = Vec<T>;
    #[inline(always)]
    fn make<T>(count: usize, each: impl FnMut(usize) -> T) -> Vec<T> {
        (0..count).map(each).collect()
    }
}

/// One number a mode, in whole lanes; `B` counts the blocks.
pub(crate) type Modal<I, B> = <B as Count>::Of<Lanes<I>>;

/// Eight numbers a block; the last block is filled with zeros.
#[inline(always)]
pub(crate) fn modal<I: Instructions, B: Count>(numbers: &[f64]) -> Modal<I, B> {
    let blocks = blocks(numbers);
    B::make(blocks.len(), |b| Lanes::of_block(&blocks[b]))
}

/// A march through time.
pub(crate) trait March: Sized {
    /// [`in_lanes`] among plain stops: no code of a generic function, so that it is compiled once,
    /// with this library, and not wherever a problem is run.
    fn among_stops(self, setting: &Setting<'_, Stop>) -> Result<()>;

    /// The march for `B` blocks of modes and `A` laws, under loads that change in time or not.
    fn march<P: Law, I: Instructions, B: Count, A: Count, const CHANGING: bool>(
        self,
        setting: &Setting<'_, P>,
    ) -> Result<()>;

    /// The march among [`MANY`] laws or more, which agrees with the other to rounding.
    fn among_many<P: Law, I: Instructions>(self, setting: &Setting<'_, P>) -> Result<()>;
}

/// Carries a march through a problem. Plain stops, which most problems have alone, have a loop of
/// their own: in registers, which laws of any kind would crowd.
pub(crate) fn run<L: Law, M: March>(march: M, problem: &Problem<L>) -> Result<()> {
    let stops: Option<Vec<&Stop>> = problem.laws.iter().map(Law::as_stop).collect();
    match stops {
        Some(stops) => march.among_stops(&Setting::new(problem, stops)),
        None => in_lanes(march, &Setting::new(problem, problem.laws.iter().collect())),
    }
}

/// Marches by the best instructions of the machine.
pub(crate) fn in_lanes<P: Law, M: March>(march: M, setting: &Setting<'_, P>) -> Result<()> {
    dispatch(Counted { setting, march })
}

/// Chooses the counts of a march.
struct Counted<'a, P, M> {
    setting: &'a Setting<'a, P>,
    march: M,
}

impl<P: Law, M: March> Vectorised for Counted<'_, P, M> {
    type Output = Result<()>;
    #[inline(always)]
    fn run<I: Instructions>(self) -> Result<()> {
        let Self { setting, march } = self;
        if setting.laws.len() >= MANY || setting.is_special() {
            return march.among_many::<P, I>(setting);
        }
        if setting.forcing.varies() {
            return march.march::<P, I, Any, Any, true>(setting);
        }
        let blocks = setting.system.modes().div_ceil(LANES);
        match (blocks, setting.laws.len()) {
            (1, 1) => march.march::<P, I, Fixed<1>, Fixed<1>, false>(setting),
            (2, 1) => march.march::<P, I, Fixed<2>, Fixed<1>, false>(setting),
            _ => march.march::<P, I, Any, Any, false>(setting),
        }
    }
}
