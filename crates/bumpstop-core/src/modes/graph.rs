//! Which unknowns a sparse symmetric matrix couples.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

/// An undirected graph with weights, without edges from a vertex to itself.
#[derive(Debug, Clone)]
pub struct Graph {
    starts: Vec<usize>,
    ends: Vec<usize>,
    /// How many edges of the finest graph each edge stands for.
    strengths: Vec<usize>,
    /// How many vertices of the finest graph each vertex stands for.
    pub weights: Vec<usize>,
}

impl Graph {
    /// The graph of a symmetric pattern in compressed columns, a vertex for each group of
    /// consecutive unknowns; `bounds` tells where groups start, and the number of unknowns.
    pub fn of(starts: &[usize], rows: &[usize], bounds: &[usize]) -> Self {
        let mut group = vec![0; starts.len() - 1];
        for (number, ends) in bounds.windows(2).enumerate() {
            group[ends[0]..ends[1]].fill(number);
        }
        let mut graph = Self::empty(0);
        let mut place = vec![usize::MAX; bounds.len() - 1];
        for (number, ends) in bounds.windows(2).enumerate() {
            let begin = graph.ends.len();
            for &row in &rows[starts[ends[0]]..starts[ends[1]]] {
                let end = group[row];
                if end == number {
                    continue;
                }
                if place[end] == usize::MAX || place[end] < begin {
                    place[end] = graph.ends.len();
                    graph.ends.push(end);
                    graph.strengths.push(0);
                }
                graph.strengths[place[end]] += 1;
            }
            graph.starts.push(graph.ends.len());
            graph.weights.push(ends[1] - ends[0]);
        }
        graph
    }

    /// Number of vertices.
    pub fn size(&self) -> usize {
        self.weights.len()
    }

    /// Sum of all weights.
    pub fn total(&self) -> usize {
        self.weights.iter().sum()
    }

    /// The vertices that edges join a vertex to.
    pub fn neighbours(&self, vertex: usize) -> impl Iterator<Item = usize> + '_ {
        self.ends[self.starts[vertex]..self.starts[vertex + 1]]
            .iter()
            .copied()
    }

    /// All vertices, those nearest to `start` first; pieces apart follow.
    pub fn breadth_first(&self, start: usize) -> Vec<usize> {
        let mut seen = vec![false; self.size()];
        let mut order = Vec::with_capacity(self.size());
        let mut done = 0;
        for first in std::iter::once(start).chain(0..self.size()) {
            if seen[first] {
                continue;
            }
            seen[first] = true;
            order.push(first);
            while done < order.len() {
                for other in self.neighbours(order[done]) {
                    if !seen[other] {
                        seen[other] = true;
                        order.push(other);
                    }
                }
                done += 1;
            }
        }
        order
    }

    /// The graph of some vertices, and which these are.
    pub fn part(&self, belongs: impl Fn(usize) -> bool) -> (Self, Vec<usize>) {
        let vertices: Vec<usize> = (0..self.size()).filter(|&v| belongs(v)).collect();
        let mut place = vec![usize::MAX; self.size()];
        for (new, &old) in vertices.iter().enumerate() {
            place[old] = new;
        }
        let mut part = Self::empty(0);
        for &vertex in &vertices {
            for i in self.starts[vertex]..self.starts[vertex + 1] {
                if place[self.ends[i]] != usize::MAX {
                    part.ends.push(place[self.ends[i]]);
                    part.strengths.push(self.strengths[i]);
                }
            }
            part.starts.push(part.ends.len());
        }
        part.weights = vertices
            .iter()
            .map(|&vertex| self.weights[vertex])
            .collect();
        (part, vertices)
    }

    /// A graph of pairs of strongly joined vertices, none heavier than `heaviest`, and the
    /// vertex of it that each vertex goes to.
    pub fn coarsened(&self, heaviest: usize) -> (Self, Vec<usize>) {
        let partner = self.matched(heaviest);
        let mut image = vec![usize::MAX; self.size()];
        let mut firsts = Vec::new();
        for vertex in 0..self.size() {
            if image[vertex] == usize::MAX {
                image[vertex] = firsts.len();
                image[partner[vertex]] = firsts.len();
                firsts.push(vertex);
            }
        }
        let mut coarse = Self::empty(0);
        let mut place = vec![usize::MAX; firsts.len()];
        for (new, &first) in firsts.iter().enumerate() {
            let begin = coarse.ends.len();
            let both = [first, partner[first]];
            let members = if first == partner[first] {
                &both[..1]
            } else {
                &both[..]
            };
            for &member in members {
                for i in self.starts[member]..self.starts[member + 1] {
                    let end = image[self.ends[i]];
                    if end == new {
                        continue;
                    }
                    if place[end] == usize::MAX || place[end] < begin {
                        place[end] = coarse.ends.len();
                        coarse.ends.push(end);
                        coarse.strengths.push(0);
                    }
                    coarse.strengths[place[end]] += self.strengths[i];
                }
            }
            coarse.starts.push(coarse.ends.len());
            let weight = members.iter().map(|&member| self.weights[member]).sum();
            coarse.weights.push(weight);
        }
        (coarse, image)
    }

    /// An order of elimination that joins the fewest at each step (P. R. Amestoy, T. A. Davis,
    /// I. S. Duff, SIAM J. Matrix Anal. Appl. 17 (1996) 886-905).
    pub fn minimum_degree(&self) -> Vec<usize> {
        let (size, edges) = (self.size(), self.ends.len());
        let (mut forward, mut inverse) = (vec![0; size], vec![0; size]);
        let mut scratch = MemBuffer::new(amd::order_maybe_unsorted_scratch::<usize>(size, edges));
        let pattern = SymbolicSparseColMatRef::new_unsorted_checked(
            size,
            size,
            &self.starts,
            None,
            &self.ends,
        );
        let ordered = amd::order_maybe_unsorted(
            &mut forward,
            &mut inverse,
            pattern,
            amd::Control::default(),
            MemStack::new(&mut scratch),
        );
        match ordered {
            Ok(_) => forward,
            Err(_) => (0..size).collect(),
        }
    }

    /// For each vertex the one that it is paired with, or itself.
    fn matched(&self, heaviest: usize) -> Vec<usize> {
        let mut partner = vec![usize::MAX; self.size()];
        for vertex in 0..self.size() {
            if partner[vertex] != usize::MAX {
                continue;
            }
            let free = (self.starts[vertex]..self.starts[vertex + 1]).filter(|&i| {
                let end = self.ends[i];
                partner[end] == usize::MAX && self.weights[end] + self.weights[vertex] <= heaviest
            });
            let strongest = free.max_by_key(|&i| {
                let end = self.ends[i];
                (
                    self.strengths[i],
                    std::cmp::Reverse((self.weights[end], end)),
                )
            });
            let other = strongest.map_or(vertex, |i| self.ends[i]);
            partner[vertex] = other;
            partner[other] = vertex;
        }
        partner
    }

    fn empty(capacity: usize) -> Self {
        Self {
            starts: vec![0],
            ends: Vec::with_capacity(capacity),
            strengths: Vec::new(),
            weights: Vec::new(),
        }
    }
}
