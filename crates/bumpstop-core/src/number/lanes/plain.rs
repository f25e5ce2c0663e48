//! Eight numbers in an array, for machines without wider instructions.
//!
//! Arithmetic stays in functions of its own: written out eight times at every place it would
//! take minutes to compile, for machines that hardly anyone has.

use super::{Instructions, LANES};

/// Plain arithmetic.
#[derive(Debug, Clone, Copy)]
pub struct Plain;

/// An expression for each lane.
macro_rules! each {
    ($i:ident => $value:expr) => {{
        let mut lanes = [0.0; LANES];
        for ($i, lane) in lanes.iter_mut().enumerate() {
            *lane = $value;
        }
        lanes
    }};
}

impl Instructions for Plain {
    type Vector = [f64; LANES];

    #[inline(always)]
    fn splat(x: f64) -> Self::Vector {
        [x; LANES]
    }
    #[inline(always)]
    fn load(from: &[f64; LANES]) -> Self::Vector {
        *from
    }
    #[inline(always)]
    fn store(x: Self::Vector, to: &mut [f64; LANES]) {
        *to = x;
    }
    #[inline(never)]
    fn add(a: Self::Vector, b: Self::Vector) -> Self::Vector {
        each!(i => a[i] + b[i])
    }
    #[inline(never)]
    fn sub(a: Self::Vector, b: Self::Vector) -> Self::Vector {
        each!(i => a[i] - b[i])
    }
    #[inline(never)]
    fn mul(a: Self::Vector, b: Self::Vector) -> Self::Vector {
        each!(i => a[i] * b[i])
    }
    #[inline(never)]
    fn div(a: Self::Vector, b: Self::Vector) -> Self::Vector {
        each!(i => a[i] / b[i])
    }
    #[inline(never)]
    fn mul_add(a: Self::Vector, b: Self::Vector, c: Self::Vector) -> Self::Vector {
        fused(a, b, c)
    }
    #[inline(never)]
    fn sub_mul(c: Self::Vector, a: Self::Vector, b: Self::Vector) -> Self::Vector {
        fused(a.map(|a| -a), b, c)
    }
    #[inline(never)]
    fn sqrt(a: Self::Vector) -> Self::Vector {
        each!(i => a[i].sqrt())
    }
    #[inline(never)]
    fn and(a: Self::Vector, b: Self::Vector) -> Self::Vector {
        each!(i => f64::from_bits(a[i].to_bits() & b[i].to_bits()))
    }
    #[inline(never)]
    fn xor(a: Self::Vector, b: Self::Vector) -> Self::Vector {
        each!(i => f64::from_bits(a[i].to_bits() ^ b[i].to_bits()))
    }
    #[inline(never)]
    fn sub_bits(a: Self::Vector, b: Self::Vector) -> Self::Vector {
        each!(i => f64::from_bits(a[i].to_bits().wrapping_sub(b[i].to_bits())))
    }
    #[inline(never)]
    fn shift_left<const N: u32>(a: Self::Vector) -> Self::Vector {
        each!(i => f64::from_bits(a[i].to_bits() << N))
    }
    #[inline(never)]
    fn select_less(
        a: Self::Vector,
        b: Self::Vector,
        yes: Self::Vector,
        no: Self::Vector,
    ) -> Self::Vector {
        each!(i => if a[i] < b[i] { yes[i] } else { no[i] })
    }
    #[inline(never)]
    fn less(a: Self::Vector, b: Self::Vector) -> u8 {
        let bit = |i: usize| u8::from(a[i] < b[i]) << i;
        (0..LANES).fold(0, |bits, i| bits | bit(i))
    }
    #[inline(never)]
    fn totals(x: [Self::Vector; LANES]) -> Self::Vector {
        each!(i => total(&x[i]))
    }
}

/// Sum of eight numbers, pairwise.
#[inline(always)]
pub(super) fn total(a: &[f64; LANES]) -> f64 {
    ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]))
}

/// `a b + c`, rounded once: by the machine's own instruction where there is one, for the
/// library's function takes many times as long.
fn fused(a: [f64; LANES], b: [f64; LANES], c: [f64; LANES]) -> [f64; LANES] {
    #[cfg(target_arch = "x86_64")]
    if let Some(sum) = super::x86::fused(a, b, c) {
        return sum;
    }
    each!(i => a[i].mul_add(b[i], c[i]))
}
