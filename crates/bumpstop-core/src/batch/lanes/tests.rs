//! Lanes against single runs, and every set of instructions against the others.

use super::*;
use crate::batch::{Batch, OfRun, Pick, Start, StopNumber, StopValues};
use crate::batch::{ImpactColumn, LawMotion};
use crate::forcing::Forcing;
use crate::history::Derivative;
use crate::number::by_each;
use crate::system::ModalSystem;

const RUNS: usize = 200;

/// By what part the start of a nearby run is larger.
const NEARBY: f64 = 1e-10;

/// Impacts make small differences grow, the rounding of either side among them: against fifty
/// digits both are wrong by up to 12 times what one rounding of their numbers makes of the problems
/// that were looked at so, and the worst of all differences here is 33 times that.
const ROUNDINGS: f64 = 48.0;

/// Equally spread numbers.
fn spread(n: usize, step: f64, [low, high]: [f64; 2]) -> f64 {
    low + (high - low) * (n as f64 * step).fract()
}

/// A structure of some modes on a stop; what is odd in its number tells what it has.
fn problem(number: usize) -> Problem<AnyLaw> {
    let modes = [1, 2, 3, 5, 10, 12][number % 6];
    let is_rigid = number % 2 == 1;
    let ratio = [0.0, 0.01, 0.05][number % 3];
    let omega = |i: usize| match (i, is_rigid) {
        (0, true) => 0.0,
        _ => 40.0 * (i as f64 + 0.7).powf(1.7) + spread(i * 7 + number, 0.618, [0.0, 9.0]),
    };
    let omega2 = (0..modes).map(|i| omega(i) * omega(i)).collect();
    let damping = (0..modes).map(|i| 2.0 * ratio * omega(i)).collect();
    let row: Vec<f64> = (0..modes)
        .map(|i| spread(i + number, 0.754, [0.5, 1.5]))
        .collect();
    let force = |i: usize| {
        if number % 4 < 2 {
            0.0
        } else {
            spread(i + number, 0.33, [-2.0, 2.0])
        }
    };
    let stop = Stop::new(row, 0.0, 1.0, 0.0).unwrap();
    let velocity = (0..modes)
        .map(|i| spread(i + number, 0.41, [-0.3, 0.1]))
        .collect();
    let displacement = (0..modes)
        .map(|i| spread(i + number, 0.87, [-1e-3, 1e-3]))
        .collect();
    Problem::new(
        ModalSystem::new(omega2, damping).unwrap(),
        vec![stop.into()],
        Forcing::constant((0..modes).map(force).collect()).unwrap(),
        displacement,
        velocity,
        0.25,
    )
    .unwrap()
}

fn quantities(problem: &Problem<AnyLaw>) -> Vec<Quantity> {
    let times: Vec<f64> = (1..=12u8).map(|n| f64::from(n) * 0.25 / 12.0).collect();
    let row: Vec<f64> = (0..problem.system.modes())
        .map(|i| 1.0 - 0.2 * i as f64)
        .collect();
    let motion = |derivative| Quantity::Motion {
        row: row.clone(),
        derivative,
        times: times.clone(),
    };
    let law = |motion| Quantity::Law {
        law: 0,
        motion,
        times: times.clone(),
    };
    let impact = |column, pick| Quantity::Impacts {
        law: 0,
        column,
        pick,
    };
    vec![
        motion(Derivative::Displacement),
        motion(Derivative::Velocity),
        law(LawMotion::Distance),
        law(LawMotion::Rate),
        law(LawMotion::Force),
        impact(ImpactColumn::Start, Pick::Number(0)),
        impact(ImpactColumn::End, Pick::Last),
        impact(ImpactColumn::Duration, Pick::Largest),
        impact(ImpactColumn::ClosingSpeed, Pick::Largest),
        impact(ImpactColumn::OpeningSpeed, Pick::Smallest),
        impact(ImpactColumn::PeakForce, Pick::Number(0)),
        impact(ImpactColumn::PeakTime, Pick::Number(0)),
        Quantity::LargestForce { law: 0 },
        Quantity::ImpactCount { law: None },
        Quantity::OfRun(OfRun::Events),
    ]
}

/// What varies from run to run.
struct Columns([Vec<f64>; 4]);

impl Columns {
    fn new(number: usize) -> Self {
        let column = |step: f64, range: [f64; 2]| {
            (0..RUNS)
                .map(|n| spread(n + 31 * number, step, range))
                .collect()
        };
        Self([
            (0..RUNS)
                .map(|n| 10f64.powf(spread(n + 17 * number, 0.618_033_988_749, [3.0, 6.0])))
                .collect(),
            column(0.754_877_666_2, [-5e-4, 2e-3]),
            column(0.569_840_290_9, [-1.0, 1.0]),
            column(0.438_579_021_4, [0.5, 2.0]),
        ])
    }

    /// The same with numbers of one kind that are a little larger.
    fn nearby(&self) -> [Self; 4] {
        [0, 1, 2, 3].map(|kind| {
            let mut columns = self.0.clone();
            columns[kind].iter_mut().for_each(|x| *x *= 1.0 + NEARBY);
            Self(columns)
        })
    }

    fn parameters(&self) -> Parameters<'_> {
        let [stiffness, gap, displacement, velocity] = &self.0;
        let stop = |number, values| StopValues {
            law: 0,
            number,
            values,
        };
        Parameters {
            runs: RUNS,
            stops: vec![
                stop(StopNumber::Stiffness, stiffness),
                stop(StopNumber::Gap, gap),
            ],
            displacement: Start::Scaled(displacement),
            velocity: Start::Scaled(velocity),
            loads: None,
            pace: None,
            chain: 1,
        }
    }
}

/// Makes runs in lanes; returns their numbers and the runs that are left.
struct Whole<'a> {
    common: &'a Common,
    problem: &'a Problem<AnyLaw>,
    parameters: &'a Parameters<'a>,
}

impl Vectorised for Whole<'_> {
    type Output = (Vec<u64>, Vec<usize>);
    #[inline(always)]
    fn run<I: Instructions>(self) -> Self::Output {
        let mut values = vec![0.0; self.parameters.runs * self.common.plan.width];
        let mut left = Vec::new();
        let part = Part {
            common: self.common,
            problem: self.problem,
            parameters: self.parameters,
            first: 0,
            values: &mut values,
            bench: &mut self.common.bench(),
            left: &mut left,
        };
        part.run::<I>();
        (values.iter().map(|x| x.to_bits()).collect(), left)
    }
}

#[test]
fn all_instructions_give_the_same_bits() {
    for number in 0..12 {
        let problem = problem(number);
        let common = Common::of(&problem, &quantities(&problem)).expect("of the common shape");
        let columns = Columns::new(number);
        let parameters = columns.parameters();
        let found = by_each(|| Whole {
            common: &common,
            problem: &problem,
            parameters: &parameters,
        });
        for other in &found {
            assert_eq!(*other, found[0], "problem {number}");
        }
        let (_, left) = &found[0];
        assert!(
            left.len() < RUNS / 20,
            "{} of problem {number} are left",
            left.len()
        );
    }
}

#[test]
fn lanes_agree_with_single_runs_and_no_event_differs() {
    for number in 0..24 {
        let problem = problem(number);
        let quantities = quantities(&problem);
        let columns = Columns::new(number);
        let parameters = columns.parameters();
        let batch = Batch::new(problem, quantities.clone()).unwrap();
        let width = batch.width();
        let made = |batch: &Batch, parameters: &Parameters<'_>| {
            let mut values = vec![0.0; RUNS * width];
            let failures = batch.run(parameters, 1, &mut values, &mut |_| true);
            assert_eq!(failures.unwrap(), []);
            values
        };
        let single = made(&batch, &parameters);
        let lanes = made(&batch.clone().in_lanes(), &parameters);
        let nearby = columns
            .nearby()
            .map(|columns| made(&batch, &columns.parameters()));
        let mut place = 0;
        for quantity in &quantities {
            let own = place..place + quantity.width();
            place = own.end;
            let size = single.chunks(width).flat_map(|row| &row[own.clone()]);
            let size = size.fold(
                0.0f64,
                |size, x| if x.abs() > size { x.abs() } else { size },
            );
            let is_count = matches!(quantity, Quantity::ImpactCount { .. } | Quantity::OfRun(_));
            for (run, (a, b)) in single.chunks(width).zip(lanes.chunks(width)).enumerate() {
                for column in own.clone() {
                    let (x, y) = (a[column], b[column]);
                    let grown = nearby
                        .iter()
                        .map(|near| (near[run * width + column] - x).abs());
                    let grown = grown.fold(0.0, f64::max) / NEARBY;
                    let tolerance = if is_count {
                        0.0
                    } else {
                        1e-13 * size + ROUNDINGS * f64::EPSILON * grown
                    };
                    let same = (x - y).abs() <= tolerance || x.is_nan() && y.is_nan();
                    assert!(
                        same,
                        "{quantity:?} of run {run} of problem {number}: {x:e} {y:e}, {tolerance:e} allowed"
                    );
                }
            }
        }
    }
}

#[test]
fn a_touch_is_left_to_single_runs() {
    // An oscillator that starts at rest from 1 mm reaches -1 mm: a stop there is touched.
    let problem = Problem::new(
        ModalSystem::new(vec![100.0], vec![0.0]).unwrap(),
        vec![Stop::new(vec![1.0], 1e-3, 1e4, 0.0).unwrap().into()],
        Forcing::constant(vec![0.0]).unwrap(),
        vec![1e-3],
        vec![0.0],
        1.0,
    )
    .unwrap();
    let quantities = [Quantity::OfRun(OfRun::Events)];
    let common = Common::of(&problem, &quantities).expect("of the common shape");
    let gap = [
        1e-3,
        1e-3 * (1.0 - 1e-15),
        1e-3 * (1.0 + 1e-15),
        0.9e-3,
        1.1e-3,
    ];
    let parameters = Parameters {
        runs: gap.len(),
        stops: vec![StopValues {
            law: 0,
            number: StopNumber::Gap,
            values: &gap,
        }],
        displacement: Start::Same,
        velocity: Start::Same,
        loads: None,
        pace: None,
        chain: 1,
    };
    let (values, mut left) = crate::number::dispatch(Whole {
        common: &common,
        problem: &problem,
        parameters: &parameters,
    });
    left.sort_unstable();
    assert_eq!(left, [0, 1, 2]);
    // It comes and goes three times in a second of 1.6 periods at most, here twice.
    assert_eq!(f64::from_bits(values[3]), 4.0);
    assert_eq!(f64::from_bits(values[4]), 0.0);
}
