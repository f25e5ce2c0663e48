//! The elimination tree: which unknown each unknown is first coupled to by the factorisation.

/// The same order of elimination, each subtree of it in one piece.
///
/// This changes nothing of the fill, and puts columns of the same pattern side by side, which is
/// what supernodes are made of (J. W. H. Liu, SIAM J. Matrix Anal. Appl. 11 (1990) 134-172).
pub fn postordered(starts: &[usize], rows: &[usize], order: &[usize]) -> Vec<usize> {
    let parent = tree(starts, rows, order);
    let size = order.len();
    // Children of each node, in a list from the first to the last.
    let mut first = vec![size; size + 1];
    let mut next = vec![size; size];
    for node in (0..size).rev() {
        next[node] = first[parent[node]];
        first[parent[node]] = node;
    }
    let mut sorted = Vec::with_capacity(size);
    let mut path = Vec::new();
    let mut node = first[size];
    while node < size || !path.is_empty() {
        while node < size {
            path.push(node);
            node = first[node];
        }
        if let Some(done) = path.pop() {
            sorted.push(order[done]);
            node = next[done];
        }
    }
    sorted
}

/// The parent of each place of an order; the number of places where there is none.
fn tree(starts: &[usize], rows: &[usize], order: &[usize]) -> Vec<usize> {
    let size = order.len();
    let mut place = vec![0; size];
    for (number, &unknown) in order.iter().enumerate() {
        place[unknown] = number;
    }
    let mut parent = vec![size; size];
    let mut ancestor = vec![size; size];
    for (number, &unknown) in order.iter().enumerate() {
        for &row in &rows[starts[unknown]..starts[unknown + 1]] {
            let mut below = place[row];
            while below < number {
                let up = ancestor[below];
                ancestor[below] = number;
                if up == size {
                    parent[below] = number;
                    break;
                }
                below = up;
            }
        }
    }
    parent
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subtrees_come_in_one_piece() {
        // A chain 0 - 1 - 2 - 3 - 4, its middle eliminated last and its ends first.
        let starts = [0, 2, 5, 8, 11, 13];
        let rows = [0, 1, 0, 1, 2, 1, 2, 3, 2, 3, 4, 3, 4];
        let order = [0, 4, 1, 3, 2];
        assert_eq!(tree(&starts, &rows, &order), [2, 3, 4, 4, 5]);
        assert_eq!(postordered(&starts, &rows, &order), [0, 1, 4, 3, 2]);
    }
}
