//! A hatchback of 4.2 x 1.76 x 1.46 m: a body drawn over stations from nose to tail, wheels, lamps, and what is seen through its windows.
//!
//! The car stands on y = 0 and looks along +z.

mod interior;

use glam::{Vec2, Vec3};

use crate::error::StreetError;
use crate::material::Material;
use crate::mesh::{BELOW, Mesh, circle, plain, tinted};
use crate::model::{Lamp, Piece, Placement};
use crate::noise::{hash, mix, smooth};

/// Axles, front and rear, and radius of the wheels.
const AXLES_M: [f32; 2] = [1.30, -1.25];
const WHEEL_M: f32 = 0.315;
/// Radius of the arches over them.
const ARCH_M: f32 = 0.385;
/// Ends of the body.
const NOSE_M: f32 = 2.10;
const TAIL_M: f32 = -2.08;

/// Radius of the corners at both ends, seen from above.
const CORNER_M: f32 = 0.12;

/// Half the length and half the width of the body.
pub(crate) const HALF_LENGTH_M: f32 = 2.14;
pub(crate) const HALF_WIDTH_M: f32 = 0.88;

/// Colors of the paint, linear.
pub(crate) const PAINTS: [[f32; 3]; 6] = [
    [0.19, 0.20, 0.21],
    [0.035, 0.052, 0.085],
    [0.17, 0.016, 0.014],
    [0.58, 0.575, 0.55],
    [0.028, 0.029, 0.031],
    [0.10, 0.135, 0.12],
];

/// A dipped beam: luminous intensity on its axis, and half angles of its cone, degrees. Its axis falls by 10 degrees, so that the cone
/// ends one degree above level, as the cutoff of a real one does: it lights the road and not who comes along it.
const BEAM_CD: f32 = 3500.0;
const BEAM_DEG: [f32; 2] = [7.0, 11.0];
const BEAM_FALL: f32 = 0.176;
/// Distance of the lamps from the middle of the car.
const BEAM_ASIDE_M: f32 = 0.66;
/// A pair of them lights the road so far.
const BEAM_RANGE_M: f32 = 80.0;

/// Smooth function through points with rising arguments: cubic, with slopes of central differences.
fn through(points: &[[f32; 2]], x: f32) -> f32 {
    let after = points.iter().position(|p| p[0] >= x).unwrap_or(points.len() - 1).max(1);
    let at = |k: usize| points[k.min(points.len() - 1)];
    let (a, b, c, d) = (at(after.saturating_sub(2)), at(after - 1), at(after), at(after + 1));
    let t = ((x - b[0]) / (c[0] - b[0])).clamp(0.0, 1.0);
    let wide = c[0] - b[0];
    let slope = |p: [f32; 2], q: [f32; 2]| if q[0] > p[0] { (q[1] - p[1]) / (q[0] - p[0]) } else { 0.0 };
    // Limited, so that the curve does not swing beyond its points.
    let own = slope(b, c);
    let limit = |s: f32| if s * own <= 0.0 { 0.0 } else { s.clamp(-3.0 * own.abs(), 3.0 * own.abs()) };
    let (m0, m1) = (limit(slope(a, c)) * wide, limit(slope(b, d)) * wide);
    let (t2, t3) = (t * t, t * t * t);
    (2.0 * t3 - 3.0 * t2 + 1.0) * b[1]
        + (t3 - 2.0 * t2 + t) * m0
        + (3.0 * t2 - 2.0 * t3) * c[1]
        + (t3 - t2) * m1
}

/// Height of the outline in the middle of the car.
fn top(z: f32) -> f32 {
    through(
        &[
            [-2.08, 0.90],
            [-2.02, 1.02],
            [-1.92, 1.08],
            [-1.62, 1.30],
            [-1.45, 1.385],
            [-1.1, 1.43],
            [-0.6, 1.455],
            [-0.1, 1.455],
            [0.22, 1.42],
            [0.45, 1.32],
            [0.8, 1.11],
            [1.02, 0.975],
            [1.15, 0.945],
            [1.5, 0.885],
            [1.85, 0.80],
            [2.0, 0.73],
            [2.10, 0.60],
        ],
        z,
    )
}

/// Height of the lower edge of the windows.
fn belt(z: f32) -> f32 {
    through(&[[-2.08, 0.88], [-1.5, 0.985], [0.0, 0.935], [1.0, 0.90], [1.6, 0.82], [2.1, 0.56]], z)
}

/// Half the width at the widest line.
fn half_width(z: f32) -> f32 {
    let nose = smooth(1.25, 2.25, z);
    let tail = smooth(-1.4, -2.3, z);
    let into = (CORNER_M - (NOSE_M - z).min(z - TAIL_M)).clamp(0.0, CORNER_M);
    let corner = CORNER_M - (CORNER_M * CORNER_M - into * into).sqrt();
    HALF_WIDTH_M * (1.0 - 0.20 * nose * nose * nose - 0.11 * tail * tail * tail) - corner
}

/// Lower edge of the body: sills, bumpers and arches.
fn low(z: f32) -> f32 {
    let sill = mix(0.21, 0.27, smooth(1.7, 2.1, z).max(smooth(-1.7, -2.05, z)));
    AXLES_M
        .iter()
        .map(|axle| {
            let d = z - axle;
            if d.abs() < ARCH_M { WHEEL_M - 0.01 + (ARCH_M * ARCH_M - d * d).sqrt() } else { sill }
        })
        .fold(sill, f32::max)
}

/// Points of a cross-section from the lower edge to the middle of the roof.
const POINTS: usize = 14;
/// First point of the seal below the side window, which ends at the first of the window; and the window's last point.
const SEAL: usize = GLASS_FROM - 1;
const GLASS_FROM: usize = 7;
const GLASS_TO: usize = 9;

fn section(z: f32, k: usize) -> Vec3 {
    let (w, y0, belt, top) = (half_width(z), low(z), belt(z).min(top(z) - 0.01), top(z));
    let shoulder = mix(y0, belt, 0.80);
    // The cabin narrows upwards.
    let cabin = (top - belt).max(0.0);
    let lean = 0.42 * cabin;
    let roof = (w - 0.085 - lean).max(w * 0.55);
    let point = match k {
        0 => [w - 0.045, y0],
        1 => [w - 0.012, y0 + 0.05 * smooth(0.0, 0.3, belt - y0)],
        2 => [w, mix(y0, belt, 0.42)],
        3 => [w + 0.006, mix(y0, belt, 0.62)],
        4 => [w, shoulder],
        5 => [w - 0.022, mix(shoulder, belt, 0.6)],
        6 => [w - 0.055, belt],
        7 => [w - 0.062 - 0.03 * lean, belt + 0.05 * cabin],
        8 => [mix(w - 0.075, roof, 0.55), belt + 0.55 * cabin],
        9 => [roof + 0.012, belt + 0.86 * cabin],
        10 => [roof - 0.03, belt + 0.945 * cabin],
        11 => [roof * 0.86, belt + 0.975 * cabin + 0.004],
        12 => [roof * 0.5, top - 0.006 * smooth(0.0, 0.1, cabin)],
        _ => [0.0, top],
    };
    Vec3::new(point[0], point[1], z)
}

/// Positions of door edges: dark gaps.
const GAPS_M: [f32; 3] = [0.93, -0.16, -1.02];
/// Pillars between the windows: middle and half-width.
const PILLARS_M: [[f32; 2]; 2] = [[-0.16, 0.05], [-1.12, 0.06]];

fn stations() -> Vec<f32> {
    let mut all = Vec::new();
    for gap in GAPS_M {
        all.extend([gap - 0.004, gap + 0.004]);
    }
    for [middle, half] in PILLARS_M {
        all.extend([middle - half, middle + half]);
    }
    for axle in AXLES_M {
        all.extend([-1.0, -0.92, -0.7, -0.4, 0.4, 0.7, 0.92, 1.0].map(|t| axle + t * ARCH_M));
        all.extend([axle - ARCH_M - 0.003, axle + ARCH_M + 0.003]);
    }
    all.extend([0.25, 0.96, 1.02, -1.45, -1.93, -1.66, 1.70, 2.03, 2.075, -1.80, TAIL_M, NOSE_M]);
    // Around the corners.
    all.extend([0.006, 0.025, 0.05, 0.09].map(|d| TAIL_M + d));
    all.extend([0.006, 0.05].map(|d| NOSE_M - d));
    // Others where none of these is close by.
    let between = (1..30).map(|k| mix(TAIL_M, NOSE_M, k as f32 / 30.0));
    let far: Vec<f32> = between.filter(|z| all.iter().all(|other| (z - other).abs() > 0.065)).collect();
    all.extend(far);
    all.sort_by(f32::total_cmp);
    all.dedup_by(|a, b| (*a - *b).abs() < 2.5e-3);
    all
}

/// Material of a cell of the body.
fn skin(z: f32, k: usize) -> Material {
    let is_windscreen = (0.25..0.97).contains(&z);
    let is_hatch = (-1.93..-1.45).contains(&z);
    let is_gap = GAPS_M.iter().any(|gap| (z - gap).abs() < 0.004);
    let is_pillar = PILLARS_M.iter().any(|[middle, half]| (z - middle).abs() < *half);
    match k {
        3..=5 if (1.70..2.03).contains(&z) => Material::Headlight,
        4..=5 if z < -1.93 => Material::TailLight,
        0 => Material::Trim,
        1..=5 if is_gap => Material::Trim,
        GLASS_FROM..GLASS_TO if (-1.55..0.62).contains(&z) => {
            if is_pillar {
                Material::Trim
            } else {
                Material::CarGlass
            }
        }
        // The seal below the side windows.
        SEAL if (-1.62..0.70).contains(&z) => Material::Trim,
        11.. if is_windscreen || is_hatch => Material::CarGlass,
        _ => Material::CarPaint,
    }
}

fn body(mesh: &mut Mesh) {
    let stations = stations();
    let rows = stations.len() - 1;
    for side in [1.0, -1.0] {
        let flip = Vec3::new(side, 1.0, 1.0);
        mesh.grid(
            [POINTS - 1, rows],
            |i, j| {
                // On the right the rows run the other way, so that the front stays outside.
                let z = if side > 0.0 { stations[j] } else { stations[rows - j] };
                let p = section(z, i);
                (p * flip, Vec2::new(z, p.y), Vec3::ONE)
            },
            |i, j| {
                let (a, b) = if side > 0.0 { (j, j + 1) } else { (rows - j, rows - j - 1) };
                Some(skin((stations[a] + stations[b]) * 0.5, i))
            },
        );
    }
    for (z, front) in [(NOSE_M, true), (TAIL_M, false)] {
        for k in 0..POINTS - 1 {
            let (a, b) = (section(z, k), section(z, k + 1));
            let m = |p: Vec3| Vec3::new(-p.x, p.y, p.z);
            let paint = plain(if k < 2 { Material::Trim } else { Material::CarPaint });
            let corners = [m(a), a, b, m(b)];
            let [p, q, r, s] = corners;
            mesh.quad(paint, if front { corners } else { [q, p, s, r] });
        }
    }
    // Nothing is seen through the arches: engine, boot, wheel houses beside the rear seats, and the floor between.
    let dark = plain(Material::Trim);
    mesh.block(dark, [-0.72, 0.22, 0.66], [1.44, 0.45, 0.99]);
    mesh.block(dark, [-0.72, 0.22, -1.75], [1.44, 0.45, 0.30]);
    for x in [-0.72, 0.54] {
        mesh.block(dark, [x, 0.22, -1.45], [0.18, 0.42, 0.61]);
    }
    mesh.block(dark, [-0.72, 0.22, -1.45], [1.44, 0.03, 2.11]);
}

/// A wheel around its hub, its outer side toward +x, or -x.
fn wheel(out: f32) -> Mesh {
    let mut wheel = Mesh::default();
    // Turned about the vertical, then laid on its side.
    let (r, half) = (WHEEL_M, 0.10);
    let tire = [[0.20, half - 0.012], [0.235, half], [r - 0.03, half], [r, half - 0.035], [r, -half]];
    let mut up: Vec<[f32; 2]> = tire.to_vec();
    up.reverse();
    wheel.lathe(plain(Material::Rubber), Vec3::ZERO, &up, 15);
    wheel.lathe(
        plain(Material::Alloy),
        Vec3::ZERO,
        &[[0.205, half - 0.014], [0.19, half - 0.04], [0.165, half - 0.055]],
        16,
    );
    wheel.lathe(
        tinted(Material::Trim, [0.5; 3]),
        Vec3::ZERO,
        &[[0.166, half - 0.075], [0.0, half - 0.08]],
        16,
    );
    wheel.lathe(
        plain(Material::Alloy),
        Vec3::ZERO,
        &[[0.05, half - 0.08], [0.045, half - 0.03], [0.0, half - 0.025]],
        12,
    );
    for spoke in 0..5 {
        let mut one = Mesh::default();
        one.cuboid(
            plain(Material::Alloy),
            Vec3::new(0.03, half - 0.08, -0.022),
            Vec3::new(0.18, half - 0.038, 0.022),
            BELOW,
        );
        wheel.add(&one, [0.0; 3], 72.0 * spoke as f32);
    }
    for part in wheel.parts.values_mut() {
        for vertex in &mut part.vertices {
            let lay = |v: Vec3| Vec3::new(v.y * out, -v.x * out, v.z);
            vertex.position = lay(vertex.position);
            vertex.normal = lay(vertex.normal);
        }
    }
    wheel
}

/// The housing of a mirror, rounded, its glass to the rear.
fn mirror(mesh: &mut Mesh, center: Vec3) {
    let mut one = Mesh::default();
    let housing =
        [[0.071, -0.035], [0.078, -0.015], [0.076, 0.012], [0.063, 0.042], [0.036, 0.062], [0.0, 0.068]];
    one.lathe(plain(Material::CarPaint), Vec3::ZERO, &housing, 10);
    one.lathe(plain(Material::Trim), Vec3::ZERO, &[[0.062, -0.032], [0.071, -0.035]], 10);
    one.lathe(plain(Material::Alloy), Vec3::ZERO, &[[0.0, -0.031], [0.062, -0.032]], 10);
    // Turned to look ahead, and made wider.
    let wide = Vec3::new(1.38, 0.82, 1.0);
    for part in one.parts.values_mut() {
        for vertex in &mut part.vertices {
            let lay = |v: Vec3| Vec3::new(v.x, -v.z, v.y);
            vertex.position = lay(vertex.position) * wide + center;
            vertex.normal = (lay(vertex.normal) / wide).normalize_or_zero();
        }
    }
    mesh.add(&one, [0.0; 3], 0.0);
}

/// Strokes of characters as on a plate, by seven segments: from x, y to x, y, in units of half a width and half a height.
const STROKES: [[f32; 4]; 7] = [
    [-1.0, 1.0, 1.0, 1.0],
    [1.0, 0.0, 1.0, 1.0],
    [1.0, -1.0, 1.0, 0.0],
    [-1.0, -1.0, 1.0, -1.0],
    [-1.0, -1.0, -1.0, 0.0],
    [-1.0, 0.0, -1.0, 1.0],
    [-1.0, 0.0, 1.0, 0.0],
];
/// Segments of the digits, of A, C, E, F, H, L, P and U.
const CHARACTERS: [u8; 18] = [
    0x3F, 0x06, 0x5B, 0x4F, 0x66, 0x6D, 0x7D, 0x07, 0x7F, 0x6F, 0x77, 0x39, 0x79, 0x71, 0x76, 0x38, 0x73,
    0x3E,
];

/// Characters and the blue field of a number plate that looks along `facing` in z.
fn plate(mesh: &mut Mesh, center: Vec3, facing: f32, number: u32) {
    let mut stroke = |material, tint, x: [f32; 2], y: [f32; 2]| {
        let p = |x: f32, y: f32| center + Vec3::new(x * facing, y, 0.0);
        mesh.quad(tinted(material, tint), [p(x[0], y[0]), p(x[1], y[0]), p(x[1], y[1]), p(x[0], y[1])]);
    };
    stroke(Material::Goods, [0.012, 0.04, 0.22], [-0.26, -0.22], [-0.055, 0.055]);
    for place in 0..7 {
        let random = hash(place, number as i32, 441);
        // Two letters, three digits, two letters.
        let is_letter = !(2..5).contains(&place);
        let k = if is_letter { 10 + (random * 8.0) as usize } else { (random * 10.0) as usize };
        let x = -0.185
            + 0.058 * place as f32
            + if is_letter { 0.0 } else { 0.01 }
            + if place > 4 { 0.02 } else { 0.0 };
        for (bit, [x0, y0, x1, y1]) in STROKES.into_iter().enumerate() {
            if CHARACTERS[k] >> bit & 1 == 1 {
                let (w, h, t) = (0.017, 0.033, 0.005);
                let (xs, ys) = ([x + x0 * w - t, x + x1 * w + t], [y0 * h - t, y1 * h + t]);
                stroke(Material::Trim, [1.0; 3], xs, ys);
            }
        }
    }
}

/// Distance of the hubs from the middle of the car.
const HUB_M: f32 = 0.765;

fn fittings(mesh: &mut Mesh, number: u32, has_wheels: bool) {
    for side in [-1.0f32, 1.0] {
        let x = side;
        for z in AXLES_M.into_iter().filter(|_| has_wheels) {
            mesh.add(&wheel(side), [x * HUB_M, WHEEL_M, z], 0.0);
        }
        // The lamps extend around the corners onto nose and tail.
        let mut cluster = |material: Material, y: [f32; 2], x: [f32; 2], z: f32| {
            let (a, b) = (x[0] * side, x[1] * side);
            let (low, high) = (Vec3::new(a.min(b), y[0], z - 0.012), Vec3::new(a.max(b), y[1], z + 0.012));
            mesh.cuboid(plain(material), low, high, 0);
        };
        cluster(Material::TailLight, [0.735, 0.875], [0.40, 0.69], TAIL_M);
        cluster(Material::Headlight, [0.465, 0.565], [0.30, 0.57], NOSE_M);
        // Reflectors behind the glass of the headlamps.
        for at in [0.375, 0.495] {
            let center = Vec3::new(x * at, 0.515, NOSE_M + 0.0135);
            mesh.polygon(plain(Material::Alloy), &circle(center, 0.038, 8));
        }
        // Mirrors.
        mirror(mesh, Vec3::new(x * 0.935, 0.995, 0.64));
        mesh.bar(
            plain(Material::Trim),
            Vec3::new(x * 0.79, 0.925, 0.68),
            Vec3::new(x * 0.88, 0.965, 0.67),
            0.035,
        );
        // A strip along the doors.
        mesh.block(plain(Material::Trim), [x * 0.874 - 0.016, 0.50, -0.84], [0.032, 0.045, 1.72]);
        // Tail lamps: a reversing lamp, a direction indicator, bars between.
        let mut lamp = |paint, x: [f32; 2], y: [f32; 2], out: f32| {
            let (a, b, z) = (x[0] * side, x[1] * side, TAIL_M - 0.012);
            let (low, high) = (Vec3::new(a.min(b), y[0], z - out), Vec3::new(a.max(b), y[1], z + 0.01));
            mesh.cuboid(paint, low, high, 0);
        };
        lamp(tinted(Material::Goods, [0.30, 0.31, 0.31]), [0.42, 0.50], [0.745, 0.795], 0.004);
        lamp(tinted(Material::Goods, [0.32, 0.10, 0.012]), [0.52, 0.675], [0.745, 0.795], 0.004);
        lamp(plain(Material::Trim), [0.40, 0.69], [0.798, 0.806], 0.006);
        lamp(plain(Material::Trim), [0.508, 0.513], [0.735, 0.875], 0.006);
        for k in 0..4 {
            let y = 0.816 + 0.014 * k as f32;
            lamp(plain(Material::TailLight), [0.42, 0.675], [y, y + 0.008], 0.008);
        }
        // Door handles, in the paint, before dark hollows.
        for z in [0.02, -0.86] {
            mesh.block(plain(Material::Trim), [x * 0.866 - 0.012, 0.775, z - 0.075], [0.024, 0.034, 0.15]);
            mesh.block(
                plain(Material::CarPaint),
                [x * 0.880 - 0.013, 0.792, z - 0.095],
                [0.026, 0.024, 0.19],
            );
        }
    }
    // Grille and lower intake, plates, wipers' cowl.
    mesh.block(plain(Material::Trim), [-0.30, 0.485, 2.02], [0.60, 0.06, 0.09]);
    mesh.block(plain(Material::Trim), [-0.50, 0.30, 2.00], [1.00, 0.13, 0.105]);
    mesh.block(plain(Material::Plate), [-0.26, 0.385, 2.10], [0.52, 0.11, 0.02]);
    mesh.block(plain(Material::Plate), [-0.26, 0.60, -2.10], [0.52, 0.11, 0.02]);
    plate(mesh, Vec3::new(0.0, 0.44, 2.1215), 1.0, number);
    plate(mesh, Vec3::new(0.0, 0.655, -2.1015), -1.0, number);
    mesh.block(plain(Material::Trim), [-0.62, 0.30, -2.095], [1.24, 0.12, 0.05]);
}

/// The car in one of [`PAINTS`].
pub(crate) fn car(paint: usize) -> Mesh {
    painted(paint, true)
}

fn painted(paint: usize, has_wheels: bool) -> Mesh {
    let mut mesh = Mesh::default();
    body(&mut mesh);
    interior::interior(&mut mesh, paint as u32);
    fittings(&mut mesh, paint as u32, has_wheels);
    if let Some(part) = mesh.parts.get_mut(&Material::CarPaint) {
        for vertex in &mut part.vertices {
            // Dust of the road on the lower parts.
            let dust = 1.0 - smooth(0.2, 0.55, vertex.position.y);
            let color = Vec3::from(PAINTS[paint % PAINTS.len()]);
            vertex.tint = color.lerp(Vec3::new(0.16, 0.145, 0.12), 0.45 * dust);
        }
    }
    mesh
}

/// A car that drives: its lamps burn at night, and its wheels roll.
///
/// It stands on y = 0 and looks along +z. In glTF its wheels turn in the animation `roll` as at 1 m/s, so that the speed of that
/// animation is the speed of the car in m/s.
#[derive(Clone, Debug)]
pub struct Car {
    pieces: Vec<Piece>,
    lamps: Vec<Lamp>,
}

impl Car {
    /// Number of paints.
    pub const PAINTS: usize = PAINTS.len();

    /// The car in one of its paints: gray, blue, red, white, black, green.
    ///
    /// # Errors
    /// [`StreetError::Setting`] for a paint from [`Car::PAINTS`] on.
    pub fn new(paint: usize) -> Result<Self, StreetError> {
        if paint >= PAINTS.len() {
            return Err(StreetError::Setting {
                file: "car".to_owned(),
                key: "paint".to_owned(),
                found: paint.to_string(),
                allowed: format!("0 to {}", PAINTS.len() - 1),
            });
        }
        let mut body = painted(paint, false);
        for (off, lit) in
            [(Material::Headlight, Material::HeadlightLit), (Material::TailLight, Material::TailLightLit)]
        {
            if let Some(part) = body.parts.remove(&off) {
                body.parts.insert(lit, part);
            }
        }
        body.clean();
        let mut wheel = wheel(1.0);
        wheel.clean();
        let hub = |side: f32, z: f32| {
            Placement::new(side * HUB_M, WHEEL_M, z, if side < 0.0 { 180.0 } else { 0.0 })
        };
        let hubs = [-1.0, 1.0].into_iter().flat_map(|side| AXLES_M.map(|z| hub(side, z))).collect();
        let wheels = Piece { name: "wheel".to_owned(), mesh: wheel, copies: hubs, rolls_on_m: Some(WHEEL_M) };
        let beam = |side: f32| Lamp {
            name: "dipped beam",
            position: [side * BEAM_ASIDE_M, 0.66, NOSE_M - 0.08],
            direction: Some([0.0, -BEAM_FALL, 1.0]),
            cone_deg: BEAM_DEG,
            color: [1.0, 0.93, 0.82],
            intensity_cd: BEAM_CD,
            range_m: BEAM_RANGE_M,
        };
        Ok(Self { pieces: vec![Piece::single("car", body), wheels], lamps: vec![beam(-1.0), beam(1.0)] })
    }

    /// Body and wheels.
    #[must_use]
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// Dipped beams, which burn at night.
    #[must_use]
    pub fn lamps(&self) -> &[Lamp] {
        &self.lamps
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_car_has_the_size_of_one() {
        let mesh = car(0);
        let mut low = Vec3::MAX;
        let mut high = Vec3::MIN;
        for part in mesh.parts.values() {
            for vertex in &part.vertices {
                low = low.min(vertex.position);
                high = high.max(vertex.position);
            }
        }
        let size = high - low;
        assert!((4.1..4.3).contains(&size.z) && (1.7..2.1).contains(&size.x), "{size}");
        assert!((1.4..1.5).contains(&size.y) && low.y.abs() < 0.01, "{low} {size}");
        assert!(mesh.triangle_count() < 8000, "{}", mesh.triangle_count());
    }

    /// Fronts look outward: the volume that they enclose, with what is below the body, is that of a car, and not its negative.
    #[test]
    fn a_body_looks_outward() {
        let mut mesh = Mesh::default();
        body(&mut mesh);
        assert!((5.0..9.0).contains(&mesh.volume_m3()), "{}", mesh.volume_m3());
    }

    /// One that drives is the same car, with its wheels beside it and its lamps lit.
    #[test]
    fn a_car_that_drives_is_the_car() {
        let (parked, driving) = (car(2), Car::new(2).expect("a paint"));
        let [body, wheel] = driving.pieces() else { panic!("{:?}", driving.pieces().len()) };
        let mut parked = parked;
        parked.clean();
        assert_eq!(parked.triangle_count(), body.mesh.triangle_count() + 4 * wheel.mesh.triangle_count());
        assert_eq!(wheel.copies.len(), 4);
        assert!(body.mesh.parts.contains_key(&Material::HeadlightLit));
        assert!(!body.mesh.parts.contains_key(&Material::TailLight));
        assert!(Car::new(Car::PAINTS).is_err());
    }
}
