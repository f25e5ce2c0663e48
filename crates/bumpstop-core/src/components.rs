//! Connected components of a graph.

use crate::error::{Error, Result};

/// For each vertex the lowest one that edges join it to.
///
/// # Errors
/// [`Error::Sizes`] where an edge has one end only, or leads outside.
pub fn labels(size: usize, from: &[usize], to: &[usize]) -> Result<Vec<usize>> {
    if from.len() != to.len() || from.iter().chain(to).any(|&vertex| vertex >= size) {
        return Err(Error::Sizes { what: "the edges" });
    }
    let mut parent: Vec<usize> = (0..size).collect();
    for (&a, &b) in from.iter().zip(to) {
        let (a, b) = (root(&mut parent, a), root(&mut parent, b));
        parent[a.max(b)] = a.min(b);
    }
    Ok((0..size).map(|vertex| root(&mut parent, vertex)).collect())
}

/// Follows a vertex to its root, and shortens the way for the next time.
fn root(parent: &mut [usize], mut vertex: usize) -> usize {
    while parent[vertex] != vertex {
        parent[vertex] = parent[parent[vertex]];
        vertex = parent[vertex];
    }
    vertex
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_are_labelled_by_the_lowest_they_hang_on() {
        assert_eq!(
            labels(6, &[5, 1, 4], &[3, 5, 2]).unwrap(),
            [0, 1, 2, 1, 2, 1]
        );
        assert_eq!(labels(0, &[], &[]).unwrap(), Vec::<usize>::new());
        assert!(labels(2, &[0], &[2]).is_err());
    }
}
