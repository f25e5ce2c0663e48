//! Nested dissection: an order of elimination that fills in little for structures in space.
//!
//! A few vertices that separate a graph in two halves are eliminated last, and so on inside each
//! half. Separators are found on a coarse graph and improved on finer and finer ones.
//!
//! A. George, SIAM J. Numer. Anal. 10 (1973) 345-363; G. Karypis and V. Kumar, SIAM J. Sci.
//! Comput. 20 (1998) 359-392; C. M. Fiduccia and R. M. Mattheyses, Proc. 19th Design Automation
//! Conference (1982) 175-181.

use super::graph::Graph;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Graphs of up to this many vertices are ordered by minimum degree.
const LEAF: usize = 200;

/// Graphs of up to this many vertices are cut without a coarser one.
const COARSE: usize = 100;

/// Starting points of cuts that are tried on the coarsest graph.
const SEEDS: usize = 6;

/// No half is heavier than this part of the whole.
const HEAVIEST: f64 = 0.58;

/// Moves without success after which an improvement is given up.
const PATIENCE: usize = 150;

/// Most rounds of moves on one graph.
const ROUNDS: usize = 6;

/// Where a vertex is: in either half or between them.
const SEPARATOR: u8 = 2;

/// Vertices in the order of their elimination.
pub fn dissection(graph: Graph) -> Vec<usize> {
    let mut order = Vec::with_capacity(graph.size());
    let names = (0..graph.size()).collect();
    ordered(&graph, names, &mut order);
    order
}

fn ordered(graph: &Graph, names: Vec<usize>, order: &mut Vec<usize>) {
    if graph.size() > LEAF {
        let side = halves(graph);
        if side.contains(&0) && side.contains(&1) {
            for half in [0, 1] {
                let (part, vertices) = graph.part(|vertex| side[vertex] == half);
                let names = vertices.into_iter().map(|vertex| names[vertex]).collect();
                ordered(&part, names, order);
            }
            let between = (0..graph.size()).filter(|&vertex| side[vertex] == SEPARATOR);
            order.extend(between.map(|vertex| names[vertex]));
            return;
        }
    }
    order.extend(
        graph
            .minimum_degree()
            .into_iter()
            .map(|vertex| names[vertex]),
    );
}

/// Cuts a graph: for each vertex its half, or that it separates them.
fn halves(graph: &Graph) -> Vec<u8> {
    if graph.size() > COARSE {
        let (coarse, image) = graph.coarsened(3 * graph.total() / COARSE);
        if 20 * coarse.size() < 19 * graph.size() {
            let coarse_side = halves(&coarse);
            let side = image
                .into_iter()
                .map(|vertex| coarse_side[vertex])
                .collect();
            return Cut::new(graph, side).improved();
        }
    }
    let starts = (0..SEEDS).map(|seed| seed * graph.size() / SEEDS);
    let cuts = starts.map(|start| {
        let mut cut = Cut::new(graph, grown(graph, start));
        cut.improve();
        cut
    });
    let best = cuts.min_by_key(Cut::score);
    best.map_or_else(Vec::new, |cut| cut.side)
}

/// Half a graph around a vertex far from `start`, with the vertices at its border.
fn grown(graph: &Graph, start: usize) -> Vec<u8> {
    let farthest = |from| *graph.breadth_first(from).last().unwrap_or(&from);
    let mut side = vec![1; graph.size()];
    let mut weight = 0;
    for vertex in graph.breadth_first(farthest(farthest(start))) {
        if 2 * weight >= graph.total() {
            break;
        }
        side[vertex] = 0;
        weight += graph.weights[vertex];
    }
    for vertex in 0..graph.size() {
        if side[vertex] == 1 && graph.neighbours(vertex).any(|other| side[other] == 0) {
            side[vertex] = SEPARATOR;
        }
    }
    side
}

/// A graph in two halves with a separator between them.
struct Cut<'a> {
    graph: &'a Graph,
    side: Vec<u8>,
    weights: [usize; 3],
}

impl<'a> Cut<'a> {
    fn new(graph: &'a Graph, side: Vec<u8>) -> Self {
        let mut weights = [0; 3];
        for (vertex, &side) in side.iter().enumerate() {
            weights[usize::from(side)] += graph.weights[vertex];
        }
        Self {
            graph,
            side,
            weights,
        }
    }

    fn improved(mut self) -> Vec<u8> {
        self.improve();
        self.side
    }

    /// The better, the smaller: a light separator first, and then halves alike.
    fn score(&self) -> (usize, usize) {
        let [left, right, separator] = self.weights;
        let excess = left.max(right).saturating_sub(self.heaviest());
        (separator + excess, left.abs_diff(right))
    }

    fn heaviest(&self) -> usize {
        (HEAVIEST * self.graph.total() as f64) as usize
    }

    fn improve(&mut self) {
        for _ in 0..ROUNDS {
            if !self.improve_once() {
                break;
            }
        }
    }

    /// Moves vertices out of the separator, each once, the best first, and takes back what was
    /// moved after the best cut.
    fn improve_once(&mut self) -> bool {
        let before = self.score();
        let mut best = (before, 0);
        let mut moved = vec![false; self.side.len()];
        let mut undo: Vec<(usize, u8)> = Vec::new();
        let mut queue = BinaryHeap::new();
        for vertex in 0..self.side.len() {
            self.offer(vertex, &mut queue);
        }
        let mut idle = 0;
        while let Some((gain, Reverse(vertex), to)) = queue.pop() {
            if self.side[vertex] != SEPARATOR || moved[vertex] {
                continue;
            }
            let now = self.gain(vertex, to);
            if now != gain {
                queue.push((now, Reverse(vertex), to));
                continue;
            }
            let weight = self.weights[usize::from(to)] + self.graph.weights[vertex];
            if weight > self.heaviest() && to == self.heavier() {
                continue;
            }
            moved[vertex] = true;
            self.shift(vertex, to, &mut undo, &mut queue);
            if self.score() < best.0 {
                best = (self.score(), undo.len());
                idle = 0;
            } else {
                idle += 1;
                if idle > PATIENCE {
                    break;
                }
            }
        }
        for (vertex, side) in undo.drain(best.1..).rev() {
            self.put(vertex, side);
        }
        best.0 < before
    }

    /// Moves a vertex into a half; its neighbours in the other become separators.
    fn shift(
        &mut self,
        vertex: usize,
        to: u8,
        undo: &mut Vec<(usize, u8)>,
        queue: &mut BinaryHeap<(i64, Reverse<usize>, u8)>,
    ) {
        undo.push((vertex, SEPARATOR));
        self.put(vertex, to);
        let graph = self.graph;
        for other in graph.neighbours(vertex) {
            if self.side[other] == 1 - to {
                undo.push((other, 1 - to));
                self.put(other, SEPARATOR);
                self.offer(other, queue);
                for beside in graph.neighbours(other) {
                    self.offer(beside, queue);
                }
            }
        }
    }

    fn offer(&self, vertex: usize, queue: &mut BinaryHeap<(i64, Reverse<usize>, u8)>) {
        if self.side[vertex] == SEPARATOR {
            for to in [0, 1] {
                queue.push((self.gain(vertex, to), Reverse(vertex), to));
            }
        }
    }

    /// How much lighter the separator becomes when a vertex of it moves into a half.
    fn gain(&self, vertex: usize, to: u8) -> i64 {
        let pulled = self
            .graph
            .neighbours(vertex)
            .filter(|&other| self.side[other] == 1 - to);
        let weight: usize = pulled.map(|other| self.graph.weights[other]).sum();
        self.graph.weights[vertex] as i64 - weight as i64
    }

    fn heavier(&self) -> u8 {
        u8::from(self.weights[1] > self.weights[0])
    }

    fn put(&mut self, vertex: usize, side: u8) {
        let weight = self.graph.weights[vertex];
        self.weights[usize::from(self.side[vertex])] -= weight;
        self.weights[usize::from(side)] += weight;
        self.side[vertex] = side;
    }
}
