//! Sparse eigenvalues against closed forms and against the dense solver.

use bumpstop_core::error::Error;
use bumpstop_core::modes::dense::symmetric_modes;
use bumpstop_core::modes::pencil::Pencil;
use bumpstop_core::modes::selection::{Selected, Selection, selected_modes};
use bumpstop_core::modes::sturm;
use bumpstop_core::sparse::SparseMatrix;
use faer::Mat;
use proptest::prelude::*;

fn sparse(size: usize, entry: impl Fn(usize, usize) -> f64, reach: usize) -> SparseMatrix {
    let (mut rows, mut columns, mut values) = (vec![], vec![], vec![]);
    for c in 0..size {
        for r in c.saturating_sub(reach)..(c + reach + 1).min(size) {
            if entry(r, c) != 0.0 {
                rows.push(r);
                columns.push(c);
                values.push(entry(r, c));
            }
        }
    }
    SparseMatrix::from_triplets((size, size), &rows, &columns, &values).unwrap()
}

/// A chain of equal masses and springs, its first mass held by a spring or free.
fn chain(size: usize, held: bool) -> Pencil {
    let stiffness = |r: usize, c: usize| match r.abs_diff(c) {
        0 if r == size - 1 || (r == 0 && !held) => 1.0,
        0 => 2.0,
        1 => -1.0,
        _ => 0.0,
    };
    let mass = |r: usize, c: usize| f64::from(u8::from(r == c));
    Pencil::new(&sparse(size, stiffness, 1), &sparse(size, mass, 0)).unwrap()
}

fn chain_omega2(size: usize, mode: usize) -> f64 {
    let angle = (2 * mode + 1) as f64 * std::f64::consts::PI / (4 * size + 2) as f64;
    (2.0 * angle.sin()).powi(2)
}

fn none(size: usize) -> Mat<f64> {
    Mat::zeros(size, 0)
}

fn check_modes(found: &Selected, expected: &[f64]) {
    let omega2 = &found.modes.omega2;
    assert!(omega2.len() >= expected.len());
    for (found, expected) in omega2.iter().zip(expected) {
        assert!(
            (found - expected).abs() <= 2e-12 * expected.abs(),
            "{found:e} {expected:e}"
        );
    }
}

#[test]
fn the_lowest_of_a_chain() {
    let size = 2000;
    let pencil = chain(size, true);
    let found = selected_modes(&pencil, none(size).as_ref(), Selection::Lowest(20)).unwrap();
    let expected: Vec<f64> = (0..20).map(|j| chain_omega2(size, j)).collect();
    check_modes(&found, &expected);
    assert_eq!(found.high.below, found.modes.omega2.len());
    assert!(found.high.at > expected[19]);
    let weighted = pencil.weighted(found.modes.shapes.as_ref());
    let unit = found.modes.shapes.transpose() * weighted;
    for r in 0..20 {
        for c in 0..20 {
            assert!((unit[(r, c)] - f64::from(u8::from(r == c))).abs() < 1e-13);
        }
    }
}

/// A chain with springs of `2^exponent`, in the units of bars of steel, say, or of atoms.
fn scaled_chain(size: usize, exponent: i32) -> Pencil {
    let scale = 2.0f64.powi(exponent);
    let stiffness = move |r: usize, c: usize| match r.abs_diff(c) {
        0 if r == size - 1 => scale,
        0 => 2.0 * scale,
        1 => -scale,
        _ => 0.0,
    };
    let mass = |r: usize, c: usize| f64::from(u8::from(r == c));
    Pencil::new(&sparse(size, stiffness, 1), &sparse(size, mass, 0)).unwrap()
}

#[test]
fn all_modes_of_many_dofs_in_any_units() {
    for (size, exponent) in [(130, 40), (200, -60), (600, 36), (130, 60)] {
        let scale = 2.0f64.powi(exponent);
        let stiffness = Mat::from_fn(size, size, |r, c| match r.abs_diff(c) {
            0 if r == size - 1 => scale,
            0 => 2.0 * scale,
            1 => -scale,
            _ => 0.0,
        });
        let mass = Mat::<f64>::identity(size, size);
        let found = symmetric_modes(stiffness.as_ref(), mass.as_ref(), size).unwrap();
        let condition = 4.0 / chain_omega2(size, 0);
        for (j, omega2) in found.omega2.iter().enumerate() {
            let ratio = omega2 / scale / chain_omega2(size, j);
            assert!(
                (ratio - 1.0).abs() < 1e-15 * condition,
                "{size} {j} {ratio}"
            );
        }
        let unit = found.shapes.transpose() * &found.shapes;
        let skew = (unit - Mat::<f64>::identity(size, size)).norm_max();
        assert!(skew < 1e-15 * condition, "{size} {skew}");
    }
}

#[test]
fn a_hundred_modes_in_any_units() {
    let size = 1000;
    for exponent in [-60, 40, 80] {
        let pencil = scaled_chain(size, exponent);
        let found = selected_modes(&pencil, none(size).as_ref(), Selection::Lowest(100)).unwrap();
        let scale = 2.0f64.powi(exponent);
        let expected: Vec<f64> = (0..100).map(|j| scale * chain_omega2(size, j)).collect();
        check_modes(&found, &expected);
    }
}

#[test]
fn a_band_and_the_neighbours_of_a_shift() {
    let size = 1500;
    let pencil = chain(size, true);
    let omega2 = |j| chain_omega2(size, j);
    let band = Selection::Band {
        low: omega2(300),
        high: omega2(330),
    };
    let found = selected_modes(&pencil, none(size).as_ref(), band).unwrap();
    let expected: Vec<f64> = (300..331).map(omega2).collect();
    assert_eq!(found.modes.omega2.len(), 31);
    check_modes(&found, &expected);
    let around = Selection::Around {
        shift: omega2(700),
        count: 9,
    };
    let found = selected_modes(&pencil, none(size).as_ref(), around).unwrap();
    let expected: Vec<f64> = (696..705).map(omega2).collect();
    assert_eq!(found.modes.omega2.len(), 9);
    check_modes(&found, &expected);
}

#[test]
fn an_empty_band() {
    let size = 1000;
    let gap = Selection::Band {
        low: 1.001 * chain_omega2(size, 3),
        high: 0.999 * chain_omega2(size, 4),
    };
    let found = selected_modes(&chain(size, true), none(size).as_ref(), gap).unwrap();
    assert!(found.modes.omega2.is_empty());
    assert_eq!(found.low.unwrap().below, 4);
    assert_eq!(found.high.below, 4);
}

#[test]
fn the_rigid_motion_of_a_free_chain() {
    let size = 1200;
    let rigid = Mat::from_fn(size, 1, |_, _| 1.0 / (size as f64).sqrt());
    let selection = Selection::Lowest(6);
    let found = selected_modes(&chain(size, false), rigid.as_ref(), selection).unwrap();
    let expected: Vec<f64> = (1..6)
        .map(|j| (2.0 * (j as f64 * std::f64::consts::PI / (2 * size) as f64).sin()).powi(2))
        .collect();
    check_modes(&found, &expected);
    assert_eq!(found.high.below, found.modes.omega2.len() + 1);
}

/// Forty equal oscillators, alone and on a common base: eigenvalues of multiplicity 40 and 39.
#[test]
fn many_equal_eigenvalues() {
    let size = 400;
    let stiffness = |r: usize, c: usize| {
        if r != c {
            0.0
        } else if r < 40 {
            1.0
        } else {
            2.0 + r as f64
        }
    };
    let mass = |r: usize, c: usize| f64::from(u8::from(r == c));
    let pencil = Pencil::new(&sparse(size, stiffness, 0), &sparse(size, mass, 0)).unwrap();
    let found = selected_modes(&pencil, none(size).as_ref(), Selection::Lowest(12)).unwrap();
    check_modes(&found, &[1.0; 40]);
    assert_eq!(found.high.below, 40);

    let on_base = |r: usize, c: usize| match (r, c) {
        (0, 0) => 1000.0 + 40.0,
        _ if r == c && r <= 40 => 1.0,
        _ if r == c => 2.0 + r as f64,
        (0, i) | (i, 0) if i <= 40 => -1.0,
        _ => 0.0,
    };
    let pencil = Pencil::new(&sparse(size, on_base, size), &sparse(size, mass, 0)).unwrap();
    let found = selected_modes(&pencil, none(size).as_ref(), Selection::Lowest(12)).unwrap();
    check_modes(&found, &[found.modes.omega2[0]]);
    assert!(found.modes.omega2[0] < 1.0);
    check_modes(
        &Selected {
            modes: rest(&found),
            ..found
        },
        &[1.0; 39],
    );
}

fn rest(found: &Selected) -> bumpstop_core::modes::Modes {
    let mut modes = found.modes.clone();
    modes.omega2.remove(0);
    modes
}

#[test]
fn a_buckled_structure_has_negative_eigenvalues() {
    let size = 600;
    let chained = |r: usize, c: usize| match r.abs_diff(c) {
        0 if r == size - 1 => 1.0,
        0 if r == 250 => -1.0,
        0 => 2.0,
        1 => -1.0,
        _ => 0.0,
    };
    let mass = |r: usize, c: usize| f64::from(u8::from(r == c));
    let (stiffness, mass) = (sparse(size, chained, 1), sparse(size, mass, 0));
    let pencil = Pencil::new(&stiffness, &mass).unwrap();
    let found = selected_modes(&pencil, none(size).as_ref(), Selection::Lowest(5)).unwrap();
    let dense = |m: &SparseMatrix| {
        let mut dense = Mat::zeros(size, size);
        for c in 0..size {
            m.column(c).for_each(|(r, v)| dense[(r, c)] = v);
        }
        dense
    };
    let (stiffness, mass) = (dense(&stiffness), dense(&mass));
    let expected = symmetric_modes(stiffness.as_ref(), mass.as_ref(), 5).unwrap();
    assert!(expected.omega2[0] < -1.0);
    for (found, expected) in found.modes.omega2.iter().zip(&expected.omega2) {
        assert!((found - expected).abs() < 1e-12 * expected.abs().max(1.0));
    }
}

#[test]
fn matrices_that_cannot_be() {
    let identity = |r: usize, c: usize| f64::from(u8::from(r == c));
    let skew = |r: usize, c: usize| if r > c { 1.0 } else { 2.0 };
    let (good, bad) = (sparse(5, identity, 0), sparse(5, skew, 1));
    assert!(matches!(
        Pencil::new(&bad, &good).unwrap_err(),
        Error::NotSymmetric {
            what: "the stiffness matrix",
            ..
        }
    ));
    let negative = sparse(5, |r, c| if r == 3 { -1.0 } else { identity(r, c) }, 0);
    assert_eq!(
        Pencil::new(&good, &negative).unwrap_err(),
        Error::NegativeMass { unknown: 3 }
    );
    let flipped = |r: usize, c: usize| if r == c { 1.0 } else { 2.0 };
    let pencil = Pencil::new(&good, &sparse(5, flipped, 1)).unwrap();
    let refused = selected_modes(&pencil, none(5).as_ref(), Selection::Lowest(2));
    assert_eq!(refused.unwrap_err(), Error::IndefiniteMass);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..Default::default() })]

    /// The inertia tells what all eigenvalues together tell.
    #[test]
    fn counts_agree_with_all_eigenvalues(
        springs in prop::collection::vec(-1.0..10.0f64, 40),
        masses in prop::collection::vec(0.1..3.0f64, 20),
        part in 0.0..1.0f64,
    ) {
        let stiffness = |r: usize, c: usize| match r.abs_diff(c) {
            0 => springs[r] + 3.0 * springs[r + 20].abs(),
            d if d < 4 => springs[r.min(c) + d * 5] - 2.0,
            _ => 0.0,
        };
        let mass = |r: usize, c: usize| if r == c { masses[r] } else { 0.0 };
        let pencil = Pencil::new(&sparse(20, stiffness, 4), &sparse(20, mass, 0)).unwrap();
        let all = symmetric_modes(
            Mat::from_fn(20, 20, stiffness).as_ref(),
            Mat::from_fn(20, 20, mass).as_ref(),
            20,
        ).unwrap();
        let at = all.omega2[0] - 1.0 + part * (all.omega2[19] - all.omega2[0] + 2.0);
        let count = sturm::count(&pencil, [at]).unwrap();
        let below = all.omega2.iter().filter(|&&w| w < at).count();
        prop_assert_eq!(count.below, below);
    }
}
