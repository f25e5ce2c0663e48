//! The dense output: a polynomial in time across each step.
//!
//! In the part theta of a step gone by, `y = F_0 + theta (F_1 + (1 - theta) (F_2 + theta (F_3 +
//! (1 - theta) (F_4 + ...))))`. F_0 is the start, F_1 to F_3 make the cubic that has the values and
//! slopes of both ends, the others are corrections that some methods have. This is the form of
//! E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 1993, section
//! II.6.

/// Coefficients of the numbers of a step: `degree + 1` rows, each of one entry a number.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Dense<'a> {
    /// All rows, one after the other.
    pub rows: &'a [f64],
    /// Entries of a row.
    pub size: usize,
}

impl<'a> Dense<'a> {
    /// The rows from a degree on down.
    fn row(&self, number: usize) -> &'a [f64] {
        &self.rows[number * self.size..][..self.size]
    }

    /// All rows, in order.
    pub(crate) fn each(&self) -> impl DoubleEndedIterator<Item = &'a [f64]> + use<'a> {
        self.rows.chunks_exact(self.size)
    }

    /// The numbers in the part theta of the step, as far as there is room for them.
    pub(crate) fn at(&self, theta: f64, to: &mut [f64]) {
        to.fill(0.0);
        let degree = self.rows.len() / self.size - 1;
        for number in (1..=degree).rev() {
            let factor = factor(number, theta);
            for (value, part) in to.iter_mut().zip(self.row(number)) {
                *value = (*value + part) * factor;
            }
        }
        for (value, start) in to.iter_mut().zip(self.row(0)) {
            *value += start;
        }
    }
}

/// What stands before the bracket of a coefficient.
fn factor(number: usize, theta: f64) -> f64 {
    if number % 2 == 1 { theta } else { 1.0 - theta }
}

/// Writes the cubic of a step of width h from the values and the slopes at both its ends.
pub(crate) fn write_cubic(
    h: f64,
    [start, end]: [&[f64]; 2],
    [first, last]: [&[f64]; 2],
    to: &mut Vec<f64>,
) {
    to.clear();
    to.extend_from_slice(start);
    let across = start.iter().zip(end).map(|(a, b)| b - a);
    to.extend(across.clone());
    to.extend(across.clone().zip(first).map(|(d, f)| h * f - d));
    let slopes = first.iter().zip(last).map(|(f, g)| h * (f + g));
    to.extend(across.zip(slopes).map(|(d, s)| 2.0 * d - s));
}

/// The rates of a cubic of width h in the part theta of it, as far as there is room for them.
pub(crate) fn cubic_rates(cubic: Dense<'_>, theta: f64, h: f64, to: &mut [f64]) {
    let [first, second, third] = [1, 2, 3].map(|number| cubic.row(number));
    let (of_second, of_third) = (1.0 - 2.0 * theta, theta * (2.0 - 3.0 * theta));
    for (i, to) in to.iter_mut().enumerate() {
        *to = (first[i] + of_second * second[i] + of_third * third[i]) / h;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_has_the_values_and_rates_it_was_made_of() {
        let cubic = |t: f64| 2.0 - t + 3.0 * t * t - 0.5 * t.powi(3);
        let rate = |t: f64| -1.0 + 6.0 * t - 1.5 * t * t;
        let (from, h) = (0.3, 1.7);
        let mut rows = Vec::new();
        let ends = [[cubic(from)], [cubic(from + h)]];
        let rates = [[rate(from)], [rate(from + h)]];
        write_cubic(h, [&ends[0], &ends[1]], [&rates[0], &rates[1]], &mut rows);
        let dense = Dense {
            rows: &rows,
            size: 1,
        };
        for theta in [0.0, 0.2, 0.7, 1.0] {
            let (mut value, mut slope) = ([0.0], [0.0]);
            dense.at(theta, &mut value);
            cubic_rates(dense, theta, h, &mut slope);
            assert!((value[0] - cubic(from + theta * h)).abs() < 1e-13);
            assert!((slope[0] - rate(from + theta * h)).abs() < 1e-13);
        }
    }
}
