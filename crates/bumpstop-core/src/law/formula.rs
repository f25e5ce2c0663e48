//! A formula in a position x and a velocity v, as a program for a machine with a stack.
//!
//! It is run with plain numbers, with numbers that carry their slopes, and with straight lines.
//! Where an absolute value, a sign, a step, a minimum or a maximum turns, the formula has a *side*:
//! a law that knows on which side it is follows a smooth force, and finds by the straight lines
//! where to change it.

use super::Affine;
use crate::error::{Error, Result, check_finite};

/// A step of the program: it takes its operands from the stack and leaves its result there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Operation {
    /// A number.
    Constant(f64),
    /// The position.
    Position,
    /// The velocity.
    Velocity,
    /// Of two.
    Binary(Binary),
    /// Of one.
    Smooth(Smooth),
    /// With two sides.
    Sided(Sided),
}

/// Smooth operations of two numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)] // they are called what they are
pub enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Atan2,
}

/// Smooth functions of one number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)] // they are called what they are
pub enum Smooth {
    Negate,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Log,
    Sqrt,
}

/// What turns where its argument, or the difference of its two, changes sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)] // they are called what they are
pub enum Sided {
    Abs,
    Sign,
    Step,
    Min,
    Max,
}

impl Operation {
    fn operands(&self) -> usize {
        match self {
            Self::Constant(_) | Self::Position | Self::Velocity => 0,
            Self::Smooth(_) | Self::Sided(Sided::Abs | Sided::Sign | Sided::Step) => 1,
            Self::Binary(_) | Self::Sided(Sided::Min | Sided::Max) => 2,
        }
    }
}

/// The deepest stack.
const DEPTH: usize = 32;
/// How many sides a law keeps in mind; those beyond are told by the motion at every instant.
pub(super) const SIDES: usize = 8;

/// A formula that can be run.
#[derive(Debug, Clone, PartialEq)]
pub struct Formula {
    program: Vec<Operation>,
    /// Whether anything in it has two sides.
    turns: bool,
}

/// What the machine works on.
trait Operand: Copy {
    fn constant(value: f64) -> Self;
    /// What cannot be told.
    fn unknown() -> Self;
    fn binary(self, which: Binary, other: Self) -> Self;
    fn smooth(self, which: Smooth) -> Self;
}

/// The sides that a formula is on: one bit each, set where the argument is not negative.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Sides {
    pub bits: u8,
    /// Which of the bits are held, whatever the values say.
    pub held: u8,
}

impl Sides {
    /// None is held.
    pub const FREE: Self = Self { bits: 0, held: 0 };

    fn is_held(self, number: usize) -> bool {
        number < SIDES && self.held >> number & 1 == 1
    }

    fn is_positive(self, number: usize) -> bool {
        self.bits >> number & 1 == 1
    }
}

impl Formula {
    /// A formula from the steps of its program.
    ///
    /// # Errors
    /// When a number is not finite, or the program leaves another than one result or needs a stack
    /// deeper than 32.
    pub fn new(program: Vec<Operation>) -> Result<Self> {
        let mut height = 0usize;
        for operation in &program {
            if let Operation::Constant(number) = operation {
                check_finite("the formula", &[*number])?;
            }
            let left = height.checked_sub(operation.operands());
            height = left.map_or(DEPTH + 1, |left| left + 1);
            if height > DEPTH {
                break;
            }
        }
        if height != 1 {
            return Err(Error::Length {
                what: "the stack of the formula",
                found: height,
                expected: 1,
            });
        }
        let is_sided = |operation: &Operation| matches!(operation, Operation::Sided(_));
        Ok(Self {
            turns: program.iter().any(is_sided),
            program,
        })
    }

    /// Its value, on given sides.
    pub(super) fn value(&self, sides: Sides, [x, v]: [f64; 2]) -> f64 {
        self.run([x, v], |number, argument| {
            Some(side(sides, number, argument >= 0.0))
        })
    }

    /// Its derivatives by position and velocity.
    pub(super) fn gradient(&self, sides: Sides, [x, v]: [f64; 2]) -> [f64; 2] {
        let graded = |value, slopes| Graded { value, slopes };
        let motion = [graded(x, [1.0, 0.0]), graded(v, [0.0, 1.0])];
        self.run(motion, |number, argument| {
            Some(side(sides, number, argument.value >= 0.0))
        })
        .slopes
    }

    /// On which sides it is at a motion.
    pub(super) fn sides_at(&self, sides: Sides, [x, v]: [f64; 2]) -> u8 {
        let mut bits = 0;
        self.run([x, v], |number, argument: f64| {
            let positive = side(sides, number, argument >= 0.0);
            if number < SIDES && positive {
                bits |= 1 << number;
            }
            Some(positive)
        });
        bits
    }

    /// Shows the arguments that turn, with their numbers, where they are straight lines in the
    /// motion while the formula is on given sides.
    pub(super) fn turns(&self, bits: u8, mut see: impl FnMut(usize, &Affine)) {
        if !self.turns {
            return;
        }
        let motion = [Affine::coordinate(0), Affine::rate(0)].map(Some);
        self.run(motion.map(Line), |number, argument| {
            let line = argument.0?;
            if line.position[0] == 0.0 && line.velocity[0] == 0.0 {
                return Some(line.constant >= 0.0);
            }
            (number < SIDES).then(|| {
                see(number, &line);
                bits >> number & 1 == 1
            })
        });
    }

    /// Runs the program; `choose` tells the side of each argument that turns, by its number,
    /// if it can.
    fn run<A: Operand>(
        &self,
        [position, velocity]: [A; 2],
        mut choose: impl FnMut(usize, A) -> Option<bool>,
    ) -> A {
        let mut stack = [A::constant(0.0); DEPTH];
        let (mut height, mut turning) = (0, 0);
        for operation in &self.program {
            height -= operation.operands();
            let (a, b) = (stack[height], stack[(height + 1).min(DEPTH - 1)]);
            stack[height] = match *operation {
                Operation::Constant(number) => A::constant(number),
                Operation::Position => position,
                Operation::Velocity => velocity,
                Operation::Binary(which) => a.binary(which, b),
                Operation::Smooth(which) => a.smooth(which),
                Operation::Sided(which) => {
                    let argument = match which {
                        Sided::Min | Sided::Max => a.binary(Binary::Subtract, b),
                        _ => a,
                    };
                    let positive = choose(turning, argument);
                    turning += 1;
                    positive.map_or(A::unknown(), |positive| sided(which, positive, a, b))
                }
            };
            height += 1;
        }
        stack[0]
    }
}

fn side(sides: Sides, number: usize, told: bool) -> bool {
    if sides.is_held(number) {
        sides.is_positive(number)
    } else {
        told
    }
}

/// What an operation with two sides gives on one of them.
fn sided<A: Operand>(which: Sided, positive: bool, a: A, b: A) -> A {
    match (which, positive) {
        (Sided::Abs, true) => a,
        (Sided::Abs, false) => a.smooth(Smooth::Negate),
        (Sided::Sign | Sided::Step, true) => A::constant(1.0),
        (Sided::Sign, false) => A::constant(-1.0),
        (Sided::Step, false) => A::constant(0.0),
        (Sided::Max, true) | (Sided::Min, false) => a,
        (Sided::Max, false) | (Sided::Min, true) => b,
    }
}

// The functions are not the platform's, so that the bits are the same everywhere.
impl Operand for f64 {
    fn constant(value: f64) -> Self {
        value
    }

    fn unknown() -> Self {
        f64::NAN
    }

    fn binary(self, which: Binary, other: Self) -> Self {
        match which {
            Binary::Add => self + other,
            Binary::Subtract => self - other,
            Binary::Multiply => self * other,
            Binary::Divide => self / other,
            Binary::Power => libm::pow(self, other),
            Binary::Atan2 => libm::atan2(self, other),
        }
    }

    fn smooth(self, which: Smooth) -> Self {
        match which {
            Smooth::Negate => -self,
            Smooth::Sin => libm::sin(self),
            Smooth::Cos => libm::cos(self),
            Smooth::Tan => libm::tan(self),
            Smooth::Asin => libm::asin(self),
            Smooth::Acos => libm::acos(self),
            Smooth::Atan => libm::atan(self),
            Smooth::Sinh => libm::sinh(self),
            Smooth::Cosh => libm::cosh(self),
            Smooth::Tanh => libm::tanh(self),
            Smooth::Exp => libm::exp(self),
            Smooth::Log => libm::log(self),
            Smooth::Sqrt => self.sqrt(),
        }
    }
}

/// A value with its derivatives by position and velocity.
#[derive(Debug, Clone, Copy)]
struct Graded {
    value: f64,
    slopes: [f64; 2],
}

impl Graded {
    /// The chain rule: a value and what each operand's slopes are multiplied by.
    fn of(value: f64, parts: [(f64, Self); 2]) -> Self {
        let slope = |i: usize| {
            let each = parts.iter().filter(|(_, operand)| operand.slopes[i] != 0.0);
            each.map(|(factor, operand)| factor * operand.slopes[i])
                .sum()
        };
        Self {
            value,
            slopes: [slope(0), slope(1)],
        }
    }
}

impl Operand for Graded {
    fn constant(value: f64) -> Self {
        Self {
            value,
            slopes: [0.0; 2],
        }
    }

    fn unknown() -> Self {
        Self::constant(f64::NAN)
    }

    fn binary(self, which: Binary, other: Self) -> Self {
        let (a, b) = (self.value, other.value);
        let value = a.binary(which, b);
        let [by_a, by_b] = match which {
            Binary::Add => [1.0, 1.0],
            Binary::Subtract => [1.0, -1.0],
            Binary::Multiply => [b, a],
            Binary::Divide => [1.0 / b, -value / b],
            Binary::Power => [b * libm::pow(a, b - 1.0), value * libm::log(a)],
            Binary::Atan2 => {
                let square = a * a + b * b;
                [b / square, -a / square]
            }
        };
        Self::of(value, [(by_a, self), (by_b, other)])
    }

    fn smooth(self, which: Smooth) -> Self {
        let a = self.value;
        let value = a.smooth(which);
        let slope = match which {
            Smooth::Negate => -1.0,
            Smooth::Sin => libm::cos(a),
            Smooth::Cos => -libm::sin(a),
            Smooth::Tan => 1.0 + value * value,
            Smooth::Asin => 1.0 / (1.0 - a * a).sqrt(),
            Smooth::Acos => -1.0 / (1.0 - a * a).sqrt(),
            Smooth::Atan => 1.0 / (1.0 + a * a),
            Smooth::Sinh => libm::cosh(a),
            Smooth::Cosh => libm::sinh(a),
            Smooth::Tanh => 1.0 - value * value,
            Smooth::Exp => value,
            Smooth::Log => 1.0 / a,
            Smooth::Sqrt => 0.5 / value,
        };
        Self::of(value, [(slope, self), (0.0, Self::constant(0.0))])
    }
}

/// A straight line in position and velocity; nothing where the operand is curved.
#[derive(Debug, Clone, Copy)]
struct Line(Option<Affine>);

impl Line {
    fn constant_value(self) -> Option<f64> {
        let line = self.0?;
        (line.position[0] == 0.0 && line.velocity[0] == 0.0).then_some(line.constant)
    }
}

impl Operand for Line {
    fn constant(value: f64) -> Self {
        Self(Some(Affine {
            constant: value,
            ..Affine::ZERO
        }))
    }

    fn unknown() -> Self {
        Self(None)
    }

    fn binary(self, which: Binary, other: Self) -> Self {
        let (Some(a), Some(b)) = (self.0, other.0) else {
            return Self(None);
        };
        Self(
            match (which, self.constant_value(), other.constant_value()) {
                (Binary::Add, ..) => Some(a.plus(&b)),
                (Binary::Subtract, ..) => Some(a.plus(&b.times(-1.0))),
                (Binary::Multiply, Some(factor), _) => Some(b.times(factor)),
                (Binary::Multiply, _, Some(factor)) => Some(a.times(factor)),
                (Binary::Divide, _, Some(divisor)) => Some(a.times(1.0 / divisor)),
                (_, Some(a), Some(b)) => Self::constant(a.binary(which, b)).0,
                _ => None,
            },
        )
    }

    fn smooth(self, which: Smooth) -> Self {
        match (which, self.0) {
            (Smooth::Negate, Some(line)) => Self(Some(line.times(-1.0))),
            _ => self
                .constant_value()
                .map_or(Self(None), |a| Self::constant(a.smooth(which))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn program(operations: &[Operation]) -> Formula {
        Formula::new(operations.to_vec()).unwrap()
    }

    /// `x^3 - 2 abs(v - 1) tanh(x)`.
    fn example() -> Formula {
        use Operation::*;
        program(&[
            Position,
            Constant(3.0),
            Binary(super::Binary::Power),
            Constant(2.0),
            Velocity,
            Constant(1.0),
            Binary(super::Binary::Subtract),
            Sided(super::Sided::Abs),
            Binary(super::Binary::Multiply),
            Position,
            Smooth(super::Smooth::Tanh),
            Binary(super::Binary::Multiply),
            Binary(super::Binary::Subtract),
        ])
    }

    #[test]
    fn it_computes_what_it_says() {
        for [x, v] in [[0.3f64, 2.5f64], [-1.2, 0.4], [0.0, -3.0]] {
            let expected = x.powi(3) - 2.0 * (v - 1.0).abs() * x.tanh();
            let found = example().value(Sides::FREE, [x, v]);
            assert!((found - expected).abs() < 1e-14);
        }
    }

    #[test]
    fn slopes_are_those_of_calculus() {
        for [x, v] in [[0.3f64, 2.5f64], [-1.2, 0.4]] {
            let sign = (v - 1.0).signum();
            let turned = 2.0 * (v - 1.0).abs() * (1.0 - x.tanh().powi(2));
            let expected = [3.0 * x * x - turned, -2.0 * sign * x.tanh()];
            let found = example().gradient(Sides::FREE, [x, v]);
            assert!((found[0] - expected[0]).abs() < 1e-13);
            assert!((found[1] - expected[1]).abs() < 1e-13);
        }
    }

    #[test]
    fn each_function_has_its_own_slope() {
        use super::Smooth::*;
        for which in [
            Negate, Sin, Cos, Tan, Asin, Acos, Atan, Sinh, Cosh, Tanh, Exp, Log, Sqrt,
        ] {
            let formula = program(&[Operation::Position, Operation::Smooth(which)]);
            let (at, h) = (0.37, 1e-5);
            let values = [at - h, at + h].map(|x| formula.value(Sides::FREE, [x, 0.0]));
            let difference = (values[1] - values[0]) / (2.0 * h);
            let [slope, _] = formula.gradient(Sides::FREE, [at, 0.0]);
            assert!((slope - difference).abs() < 1e-8, "{which:?}");
        }
    }

    #[test]
    fn a_held_side_goes_on_beyond_its_turn() {
        let formula = program(&[Operation::Position, Operation::Sided(Sided::Abs)]);
        let held = |bits| Sides { bits, held: 1 };
        assert_eq!(formula.value(held(1), [-0.5, 0.0]), -0.5);
        assert_eq!(formula.value(held(0), [-0.5, 0.0]), 0.5);
        assert_eq!(formula.sides_at(Sides::FREE, [-0.5, 0.0]), 0);
        assert_eq!(formula.sides_at(Sides::FREE, [0.5, 0.0]), 1);
    }

    #[test]
    fn turns_are_straight_lines_on_their_side() {
        // step(abs(x) - 0.2): on the negative side of x its argument is -x - 0.2.
        let formula = program(&[
            Operation::Position,
            Operation::Sided(Sided::Abs),
            Operation::Constant(0.2),
            Operation::Binary(Binary::Subtract),
            Operation::Sided(Sided::Step),
        ]);
        let mut seen = Vec::new();
        formula.turns(0b10, |number, line| {
            seen.push((number, line.constant, line.position[0]));
        });
        assert_eq!(seen, [(0, 0.0, 1.0), (1, -0.2, -1.0)]);
    }

    #[test]
    fn programs_that_leave_no_result_are_refused() {
        assert!(Formula::new(vec![]).is_err());
        assert!(Formula::new(vec![Operation::Binary(Binary::Add)]).is_err());
        assert!(Formula::new(vec![Operation::Position; 40]).is_err());
        assert!(Formula::new(vec![Operation::Constant(f64::NAN)]).is_err());
    }
}
