//! Linear motion by the exponential of the state matrix, which shares nothing with the core.

/// `q'' + C q' + K q = p`.
pub struct Equations {
    pub stiffness: Vec<Vec<f64>>,
    pub damping: Vec<Vec<f64>>,
    pub force: Vec<f64>,
}

impl Equations {
    /// Displacement and velocity `time` after a state, which come one behind the other.
    pub fn after(&self, state: &[f64], time: f64) -> Vec<f64> {
        let n = self.force.len();
        let mut generator = vec![vec![0.0; 2 * n + 1]; 2 * n + 1];
        for i in 0..n {
            generator[i][n + i] = time;
            for j in 0..n {
                generator[n + i][j] = -self.stiffness[i][j] * time;
                generator[n + i][n + j] = -self.damping[i][j] * time;
            }
            generator[n + i][2 * n] = self.force[i] * time;
        }
        let mut start = state.to_vec();
        start.push(1.0);
        let flow = exponential(generator);
        (flow.iter().take(2 * n))
            .map(|row| row.iter().zip(&start).map(|(a, b)| a * b).sum())
            .collect()
    }
}

/// Taylor's series of a matrix scaled down, squared up again.
fn exponential(mut matrix: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let n = matrix.len();
    let norm = (matrix.iter())
        .map(|row| row.iter().map(|x| x.abs()).sum())
        .fold(0.0, f64::max);
    let squarings = (norm.log2().ceil() as i32 + 3).max(0);
    matrix
        .iter_mut()
        .flatten()
        .for_each(|x| *x *= 0.5f64.powi(squarings));
    let unit = |r: usize, c: usize| f64::from(u8::from(r == c));
    let mut sum: Vec<Vec<f64>> = (0..n)
        .map(|r| (0..n).map(|c| unit(r, c)).collect())
        .collect();
    let mut term = sum.clone();
    for order in 1..20 {
        term = product(&term, &matrix);
        for (sum, term) in sum.iter_mut().flatten().zip(term.iter_mut().flatten()) {
            *term /= f64::from(order);
            *sum += *term;
        }
    }
    for _ in 0..squarings {
        sum = product(&sum, &sum);
    }
    sum
}

fn product(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n = b[0].len();
    (a.iter())
        .map(|row| {
            (0..n)
                .map(|c| row.iter().zip(b).map(|(x, other)| x * other[c]).sum())
                .collect()
        })
        .collect()
}
