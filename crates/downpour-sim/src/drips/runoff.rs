//! Ways of the water over the surfaces of a region: into hollows, out of them, over edges.
//!
//! Water follows the descent to one or two of eight cells. In hollows and on level ground it takes the way by which a flood from the
//! edges has come (Priority-Flood: R. Barnes et al., Computers & Geosciences 62, 2014). Hollows that are deeper than [`MAX_POOL_M`] have
//! a drain, as flat roofs and gutters do.
//!
//! An edge is where the next cell has no surface near the plane of this one, and nothing stands between. Water leaves over it where the
//! surface descends towards it, and where it is level.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::Vec3;
use rayon::prelude::*;

use super::surfaces::{CELL_M, Sheet, Surfaces};
use crate::shelter::{Obstacles, met};

/// The next cell belongs to the same surface if it is no farther from its plane, m.
const STEP_M: f32 = 0.05;

/// Maximum depth of water that runs over, m.
const MAX_POOL_M: f32 = 0.05;

/// Height above a surface at which what stands between two cells is searched, m.
const ABOVE_M: f32 = 0.02;

/// Slopes below this are level.
const LEVEL: f32 = 2.0e-3;

/// Slopes above this leave over an edge along their descent.
const STEEP: f32 = 0.8;

/// Minimum cosine between the descent and the outward normal of an edge for water to leave over it.
const OUTWARD: f32 = 0.35;

/// Distance in cells within which the normal of an edge is estimated.
const AROUND: i32 = 3;

/// Neighbors of a cell; the first four are beside it.
const WAYS: [[i32; 2]; 8] = [[1, 0], [0, 1], [-1, 0], [0, -1], [1, 1], [-1, 1], [-1, -1], [1, -1]];

/// No surface.
const NONE: u32 = u32::MAX;

/// Surfaces that water goes to, and the fraction of it that each gets.
type Descent = [(u32, f32); 2];

/// Water that leaves over an edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outflow {
    /// Surface that it leaves.
    pub(super) sheet: u32,
    /// Direction along X and Z, one of the four axes.
    pub(super) way: [i32; 2],
    /// Outward unit normal of the edge along X and Z.
    pub(super) normal: [f32; 2],
    /// Number of cells whose rain it is.
    pub(super) cells: f32,
    /// Length of the longest way that it has come, m.
    pub(super) length: f32,
}

/// Water of a region.
#[derive(Debug)]
pub(super) struct Runoff {
    /// Water over edges, in the order of the surfaces.
    pub(super) outflows: Vec<Outflow>,
    /// Number of cells that the rain falls on.
    pub(super) rained: u32,
}

/// State of the routing.
struct Routing<'a> {
    surfaces: &'a Surfaces,
    /// Open edges of each surface, a bit for each of the first four ways.
    edges: Vec<u8>,
    /// Height at which water gets away, m; infinite where none does.
    spill: Vec<f32>,
    /// Surface from which the flood came; the surface itself at an edge.
    next: Vec<u32>,
}

/// Finds the ways of the water.
pub(super) fn runoff(obstacles: &Obstacles<'_>, surfaces: &Surfaces) -> Runoff {
    let edges: Vec<u8> =
        surfaces.sheets.par_iter().map(|sheet| open_edges(obstacles, surfaces, sheet)).collect();
    let count = surfaces.sheets.len();
    let mut routing = Routing { surfaces, edges, spill: vec![f32::INFINITY; count], next: vec![NONE; count] };
    routing.flood();
    routing.gather()
}

/// The surface of a neighboring cell that goes on from a surface.
fn continued(surfaces: &Surfaces, sheet: &Sheet, cell: u32, way: [i32; 2]) -> Option<u32> {
    let [x, z] = way.map(|k| k as f32 * CELL_M as f32);
    let plane = sheet.height_at(x, z);
    let mut best = None;
    for index in surfaces.of(cell) {
        let other = surfaces.sheet(index);
        // Of a ridge or a bend, either plane may meet the middle of the other cell, or neither: the steps are small then.
        let off = (other.height - plane)
            .abs()
            .min((other.height_at(-x, -z) - sheet.height).abs())
            .min((other.height - sheet.height).abs());
        if off <= STEP_M && best.is_none_or(|(least, _)| off < least) {
            best = Some((off, index));
        }
    }
    best.map(|(_, index)| index)
}

/// Bits of the ways over which a surface has an edge with nothing in the way.
fn open_edges(obstacles: &Obstacles<'_>, surfaces: &Surfaces, sheet: &Sheet) -> u8 {
    let mut bits = 0;
    for (k, &way) in WAYS[..4].iter().enumerate() {
        let Some(beside) = surfaces.beside(sheet.cell, way) else { continue };
        if continued(surfaces, sheet, beside, way).is_some() || below(surfaces, sheet, beside).is_none() {
            continue;
        }
        let [x, z] = surfaces.middle(sheet.cell);
        let from = Vec3::new(x, sheet.height + ABOVE_M, z);
        let towards = Vec3::new(way[0] as f32, 0.0, way[1] as f32);
        if met(obstacles, from, towards, CELL_M as f32).is_none() {
            bits |= 1 << k;
        }
    }
    bits
}

/// The highest surface of a cell that is lower than a surface by more than a step.
fn below(surfaces: &Surfaces, sheet: &Sheet, cell: u32) -> Option<u32> {
    surfaces.of(cell).find(|&index| surfaces.sheet(index).height < sheet.height - STEP_M)
}

impl Routing<'_> {
    /// Floods all surfaces from their edges inwards, lowest first.
    fn flood(&mut self) {
        let surfaces = self.surfaces;
        let mut ahead = BinaryHeap::new();
        let mut number = 0u32;
        for (index, sheet) in (0u32..).zip(&surfaces.sheets) {
            if self.edges[index as usize] != 0 {
                self.spill[index as usize] = sheet.height;
                self.next[index as usize] = index;
                ahead.push(Reverse((ordered(sheet.height), number, index)));
                number += 1;
            }
        }
        while let Some(Reverse((_, _, index))) = ahead.pop() {
            let spill = self.spill[index as usize];
            let cell = surfaces.sheet(index).cell;
            for way in WAYS {
                let Some(beside) = surfaces.beside(cell, way) else { continue };
                for other in surfaces.of(beside) {
                    if self.next[other as usize] != NONE {
                        continue;
                    }
                    let sheet = surfaces.sheet(other);
                    let back = way.map(|k| -k);
                    if spill - sheet.height > MAX_POOL_M
                        || continued(surfaces, sheet, cell, back) != Some(index)
                    {
                        continue;
                    }
                    let level = spill.max(sheet.height);
                    self.spill[other as usize] = level;
                    self.next[other as usize] = index;
                    ahead.push(Reverse((ordered(level), number, other)));
                    number += 1;
                }
            }
        }
    }

    /// Outward normal of the edge near a surface: away from the cells around in which it goes on.
    fn normal(&self, sheet: &Sheet) -> [f32; 2] {
        let mut sum = [0.0f32; 2];
        for z in -AROUND..=AROUND {
            for x in -AROUND..=AROUND {
                let [dx, dz] = [x, z].map(|k| k as f32 * CELL_M as f32);
                let plane = sheet.height_at(dx, dz);
                let goes_on = self.surfaces.beside(sheet.cell, [x, z]).is_some_and(|cell| {
                    self.surfaces.of(cell).any(|k| (self.surfaces.sheet(k).height - plane).abs() <= STEP_M)
                });
                if !goes_on {
                    sum = [sum[0] + dx, sum[1] + dz];
                }
            }
        }
        let length = (sum[0] * sum[0] + sum[1] * sum[1]).sqrt();
        if length > 0.0 { sum.map(|x| x / length) } else { sum }
    }

    /// The way over an edge by which the water of a surface leaves, and the normal of the edge; `None` if it stays on the surface.
    fn leaves(&self, index: u32, stays: bool) -> Option<(usize, [f32; 2])> {
        let bits = self.edges[index as usize];
        if bits == 0 {
            return None;
        }
        let sheet = self.surfaces.sheet(index);
        let steepness = (sheet.slope[0] * sheet.slope[0] + sheet.slope[1] * sheet.slope[1]).sqrt();
        // Around steep surfaces the cells near an edge do not tell where it is.
        let normal =
            if steepness > STEEP { sheet.slope.map(|slope| -slope / steepness) } else { self.normal(sheet) };
        let outward = -(sheet.slope[0] * normal[0] + sheet.slope[1] * normal[1]);
        if stays && steepness > LEVEL && outward < OUTWARD * steepness {
            return None;
        }
        let dot = |k: usize, v: [f32; 2]| WAYS[k][0] as f32 * v[0] + WAYS[k][1] as f32 * v[1];
        let along = |k: usize| if steepness > LEVEL { -dot(k, sheet.slope) } else { dot(k, normal) };
        // What can stay on the surface does so where it would not descend over the edge.
        let descends =
            |k: &usize| !stays || steepness <= LEVEL || -dot(*k, sheet.slope) >= OUTWARD * steepness;
        let open = (0..4).filter(|k| bits & (1 << k) != 0).filter(descends);
        let best = open.fold(None, |best: Option<usize>, k| match best {
            Some(known) if along(known) >= along(k) => best,
            _ => Some(k),
        });
        best.map(|k| (k, normal))
    }

    /// Surfaces that the water of a surface descends to, and the fraction that each gets; none in hollows and on level ground.
    ///
    /// The two neighbors next to the direction of the descent share it so that its mean has that direction (as the D-infinity of D. G.
    /// Tarboton, Water Resources Research 33, 1997). Where they are not there or not lower, the steepest way has all.
    fn descent(&self, index: u32) -> Descent {
        let sheet = self.surfaces.sheet(index);
        let [x, z] = sheet.slope.map(|slope| -slope);
        let signs = [x, z].map(|k| if k < 0.0 { -1 } else { 1 });
        let (axis, aside) = if x.abs() >= z.abs() { ([signs[0], 0], z / x) } else { ([0, signs[1]], x / z) };
        let fraction = aside.abs();
        if x.abs().max(z.abs()) > LEVEL {
            let straight = self.lower(index, axis).filter(|_| fraction < 1.0);
            let diagonal = self.lower(index, signs).filter(|_| fraction > 0.0);
            match (straight, diagonal) {
                (Some((_, a)), Some((_, b))) => return [(a, 1.0 - fraction), (b, fraction)],
                (Some((_, a)), None) => return [(a, 1.0), (NONE, 0.0)],
                (None, Some((_, b))) => return [(b, 1.0), (NONE, 0.0)],
                (None, None) => {}
            }
        }
        let all = WAYS.iter().filter_map(|&way| self.lower(index, way));
        let steepest = all.fold(None, |best: Option<(f32, u32)>, found| match best {
            Some(known) if known.0 >= found.0 => best,
            _ => Some(found),
        });
        [(steepest.map_or(NONE, |(_, other)| other), 1.0), (NONE, 0.0)]
    }

    /// The surface that goes on a way, if it is lower, and the slope to it.
    fn lower(&self, index: u32, way: [i32; 2]) -> Option<(f32, u32)> {
        let surfaces = self.surfaces;
        let sheet = surfaces.sheet(index);
        let beside = surfaces.beside(sheet.cell, way)?;
        let other = continued(surfaces, sheet, beside, way)?;
        let distance = ((way[0] * way[0] + way[1] * way[1]) as f32).sqrt() * CELL_M as f32;
        let slope = (sheet.height - surfaces.sheet(other).height) / distance;
        // What the flood has not come to has a drain. Else the way out is lower: no water goes in circles.
        let is_lower =
            self.next[other as usize] == NONE || self.spill[other as usize] < self.spill[index as usize];
        (slope > LEVEL && is_lower).then_some((slope, other))
    }

    /// Adds the rain up along its ways.
    fn gather(&self) -> Runoff {
        let surfaces = self.surfaces;
        let count = surfaces.sheets.len();
        let way_of = |index: u32| -> (Descent, Option<(usize, [f32; 2])>) {
            let alone = |to: u32| [(to, 1.0), (NONE, 0.0)];
            let next = self.next[index as usize];
            if next == NONE {
                return (alone(NONE), None);
            }
            let sheet = surfaces.sheet(index);
            let floods = self.spill[index as usize] > sheet.height;
            let descent = if floods { alone(NONE) } else { self.descent(index) };
            let stays = descent[0].0 != NONE;
            if let Some((way, normal)) = self.leaves(index, stays) {
                let landed = surfaces.beside(sheet.cell, WAYS[way]).and_then(|c| below(surfaces, sheet, c));
                return (alone(landed.unwrap_or(NONE)), Some((way, normal)));
            }
            (if stays || next == index { descent } else { alone(next) }, None)
        };
        let ways: Vec<_> = (0..count as u32).into_par_iter().map(way_of).collect();
        let mut cells = vec![0.0f32; count];
        let mut rained = 0;
        for cell in 0..surfaces.region.cells[0] * surfaces.region.cells[1] {
            if let Some(top) = surfaces.of(cell).next() {
                cells[top as usize] = 1.0;
                rained += 1;
            }
        }
        // Each surface after all those whose water it gets.
        let mut waits = vec![0u32; count];
        for &(to, _) in ways.iter().flat_map(|way| &way.0).filter(|part| part.0 != NONE) {
            waits[to as usize] += 1;
        }
        let mut lengths = vec![0.0f32; count];
        let mut ready: Vec<u32> = (0..count as u32).filter(|&k| waits[k as usize] == 0).collect();
        while let Some(index) = ready.pop() {
            let (parts, over) = &ways[index as usize];
            for &(to, fraction) in parts.iter().filter(|part| part.0 != NONE) {
                let step = match over {
                    None => apart(surfaces.sheet(index), surfaces.sheet(to), surfaces),
                    Some(_) => 0.0,
                };
                let length = lengths[index as usize] + step;
                let of_next = &mut lengths[to as usize];
                *of_next = of_next.max(length);
                cells[to as usize] += cells[index as usize] * fraction;
                waits[to as usize] -= 1;
                if waits[to as usize] == 0 {
                    ready.push(to);
                }
            }
        }
        let mut outflows = Vec::new();
        for (sheet, &(_, over)) in (0u32..).zip(&ways) {
            let (number, length) = (cells[sheet as usize], lengths[sheet as usize]);
            if let Some((way, normal)) = over.filter(|_| number > 0.0) {
                outflows.push(Outflow { sheet, way: WAYS[way], normal, cells: number, length });
            }
        }
        Runoff { outflows, rained }
    }
}

/// Distance between the middles of the cells of two surfaces, m.
fn apart(a: &Sheet, b: &Sheet, surfaces: &Surfaces) -> f32 {
    let ([ax, az], [bx, bz]) = (surfaces.middle(a.cell), surfaces.middle(b.cell));
    Vec3::new(ax - bx, a.height - b.height, az - bz).length()
}

/// A number whose order is that of a finite height.
fn ordered(height: f32) -> i32 {
    let bits = height.to_bits() as i32;
    bits ^ (((bits >> 31) as u32) >> 1) as i32
}
