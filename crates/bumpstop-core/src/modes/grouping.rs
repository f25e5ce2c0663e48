//! Which consecutive unknowns belong together, as the dofs of one node do.

/// Most dofs of a node: a node in space has six.
pub const NODE: usize = 6;

/// Where groups of up to `largest` consecutive unknowns start, and the number of unknowns last.
///
/// The groups are those whose columns, each the union of the columns of its unknowns, have the
/// fewest entries in all: dofs of one node are coupled to the dofs of the same nodes.
pub fn grouped(starts: &[usize], rows: &[usize], largest: usize) -> Vec<usize> {
    let size = starts.len() - 1;
    // The fewest entries of groups from each unknown on, and the length of the first of them.
    let mut fewest = vec![0; size + 1];
    let mut length = vec![1; size];
    let mut seen = vec![usize::MAX; size];
    for first in (0..size).rev() {
        let (mut entries, mut best) = (0, usize::MAX);
        for last in first..size.min(first + largest) {
            for &row in &rows[starts[last]..starts[last + 1]] {
                if seen[row] != first {
                    seen[row] = first;
                    entries += 1;
                }
            }
            if entries + fewest[last + 1] < best {
                best = entries + fewest[last + 1];
                length[first] = last + 1 - first;
            }
        }
        fewest[first] = best;
    }
    let mut bounds = vec![0];
    let mut next = 0;
    while next < size {
        next += length[next];
        bounds.push(next);
    }
    bounds
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dofs_of_a_node_come_together_also_where_some_are_held() {
        // A chain of nodes with so many free dofs, each coupled to all of the next node.
        let nodes = [4usize, 6, 6, 5, 6, 6, 6];
        let bounds: Vec<usize> = (0..=nodes.len()).map(|n| nodes[..n].iter().sum()).collect();
        let (mut starts, mut rows) = (vec![0], Vec::new());
        for (node, &dofs) in nodes.iter().enumerate() {
            for _ in 0..dofs {
                let (low, high) = (node.saturating_sub(1), (node + 2).min(nodes.len()));
                rows.extend(bounds[low]..bounds[high]);
                starts.push(rows.len());
            }
        }
        assert_eq!(grouped(&starts, &rows, NODE), bounds);
    }

    #[test]
    fn a_matrix_may_be_empty_or_diagonal() {
        assert_eq!(grouped(&[0], &[], NODE), [0]);
        assert_eq!(grouped(&[0, 1, 2], &[0, 1], NODE), [0, 1, 2]);
    }
}
