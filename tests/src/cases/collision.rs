//! `shaders/wgsl/sim/collision*` against `downpour-sim`.

use downpour_bvh::{Bvh, BvhTriangle};
use downpour_gpu::{ComputeKernel, Gpu, GpuError};
use downpour_math::ops;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::compose;
use downpour_shaders::sim::collision::{
    COLLISION, COLLISION_LAYERS, COLLISION_MAP, COLLISION_MAP_KERNEL, COLLISION_START,
};
use downpour_sim::collision::{
    CollisionFrame, CollisionMap, CollisionOptions, CollisionPiece, CollisionTexel, collision_column,
    collision_count, collision_depths, collision_find, collision_map_add, collision_map_between,
    collision_map_faces, collision_map_normal, collision_normal, collision_pack, collision_position,
    collision_shallow, collision_slope, collision_solid, collision_square, collision_turn, collision_wall,
};
use downpour_sim::gpu::collision::GpuCollisionMap;
use glam::{Quat, Vec2, Vec3};

use crate::Domain::{Below, Fixed, Made, OneOf, Uniform, Unit3};
use crate::compare::{Cpu, Gpu as FromGpu, POISON};
use crate::function::Run;
use crate::signature::WordKind::{Float, Integer};
use crate::words::{Args, IntoWords as _};
use crate::{FunctionCase, KernelCase, Tol};

fn more(random: [u32; 4], dimension: u32) -> [f32; 4] {
    rng_draw([random[0], random[1]], random[2], random[3], dimension).map(rng_unit)
}

/// A fall of so many radians from down.
fn slanted(angle: f32, towards: f32) -> Vec3 {
    let s = ops::sin(angle);
    Vec3::new(s * ops::cos(towards), -ops::cos(angle), s * ops::sin(towards))
}

fn vec3(args: &mut Args<'_>) -> Vec3 {
    Vec3::from(args.f32s())
}

/// The words of a `CollisionMap` of 1 to 64 texels of 5 to 50 cm, about the origin.
fn map_words(random: [u32; 4]) -> Vec<u32> {
    let ([a, b, c, d], [e, f, ..]) = (more(random, 0), more(random, 1));
    let texels = [1 + random[0] % 64, 1 + random[1] % 64];
    let options = CollisionOptions {
        fall: slanted(1.3 * a, 6.0 * b),
        center: Vec3::new(c, d, -c) * 4.0,
        size: [texels[0] as f32 * (0.05 + 0.45 * e), texels[1] as f32 * (0.05 + 0.45 * f)],
        texels,
        anchor: Vec3::new(d, e, f),
    };
    let scene = Bvh::new(&[[[0.0, 3.0, 0.0], [1.0, 2.0 * a, 0.0], [0.0, 1.0, 1.0]]]);
    let m = CollisionFrame::new(&options, &scene).expect("a map");
    [
        m.low.words(),
        vec![m.triangles],
        m.across.words(),
        m.steep.words(),
        m.along.words(),
        m.merge.words(),
        m.fall.words(),
        m.edge.words(),
        m.per_edge.words(),
        m.anchor.words(),
        m.size.words(),
    ]
    .concat()
}

fn map(args: &mut Args<'_>) -> CollisionFrame {
    CollisionFrame {
        low: args.f32s(),
        triangles: args.u32(),
        across: args.f32s(),
        steep: args.f32(),
        along: args.f32s(),
        merge: args.f32(),
        fall: args.f32s(),
        padding_1: 0,
        edge: args.f32s(),
        per_edge: args.f32s(),
        anchor: args.f32s(),
        padding_2: 0,
        size: args.u32s(),
        padding_3: [0; 2],
    }
}

/// A packed surface that is not steep.
fn surface_word(random: [u32; 4]) -> u32 {
    let [a, b, c, _] = random.map(rng_unit);
    collision_pack(Vec3::new(a - 0.5, b - 0.5, 0.25 + c), random[3] & 1 == 1)
}

/// The words of a `CollisionTexel` with 0 to 4 surfaces down to 8 m.
fn texel_words(random: [u32; 4]) -> Vec<u32> {
    let layers = random[0] as usize % 5;
    let mut depth = 0.0;
    let mut texel = CollisionTexel::OPEN;
    for k in 0..layers {
        depth += 0.02 + 2.0 * more(random, k as u32)[0];
        texel.depths[k] = depth;
        texel.surfaces[k] = surface_word(rng_draw([random[1], random[2]], k as u32, 5, 6));
    }
    [texel.depths.words(), texel.surfaces.to_vec()].concat()
}

fn texel(args: &mut Args<'_>) -> CollisionTexel {
    CollisionTexel { depths: args.f32s(), surfaces: args.u32s() }
}

/// The words of a map, a texel, and a piece of a path that begins within 2 mm of one of the texel's surfaces.
fn close_words(random: [u32; 4]) -> Vec<u32> {
    let texel_random = [random[0] - random[0] % 5 + 1 + random[0] % 4, random[1], random[2], random[3]];
    let words = [map_words(random), texel_words(texel_random)].concat();
    let mut args = Args::new(&words);
    let (map, texel) = (map(&mut args), texel(&mut args));
    let ([a, b, c, d], [e, f, ..]) = (more(random, 8), more(random, 9));
    let start = [a - 0.5, b - 0.5];
    let layer = random[3] as usize % (1 + random[0] as usize % 4);
    let depth = collision_depths(&map, &texel, Vec2::from(start))[layer];
    let before = [0, 1, COLLISION_START, COLLISION_START][random[2] as usize % 4];
    let piece = ((start, depth + 4.0e-3 * c - 2.0e-3), ([d - 0.5, e - 0.5], depth + 2.0 * f - 1.0));
    [words, piece.words(), vec![before]].concat()
}

fn column(a: &mut Args<'_>) -> Vec<u32> {
    let (map, texel) = (map(a), texel(a));
    let (start, end) = (vec3(a), vec3(a));
    let met = collision_column(&map, &texel, &CollisionPiece { start, end, before: a.u32() });
    ((met.kind, met.fraction), [met.layer, met.beneath, met.count]).words()
}

fn triangle(args: &mut Args<'_>) -> BvhTriangle {
    let (corner, index) = (args.f32s(), args.u32());
    let (edge_1, lets_through) = (args.f32s(), args.u32());
    BvhTriangle { corner, index, edge_1, lets_through, edge_2: args.f32s(), padding: 0 }
}

/// The cases.
pub(super) fn functions() -> Vec<FunctionCase> {
    let (a_map, a_texel) = (Made(map_words), Made(texel_words));
    let a_surface = Made(|r| vec![surface_word(r)]);
    let steep = Made(|r| {
        let [a, b, ..] = r.map(rng_unit);
        vec![collision_pack(Vec3::new(a - 0.5, b - 0.5, 0.0), r[3] & 1 == 1)]
    });
    let a_triangle = Made(|r| {
        let [corner, edge_1, edge_2] =
            [0, 1, 2].map(|k| more(r, k).map(|x| (x - 0.5).to_bits())[..3].to_vec());
        [corner, vec![r[0] % 9], edge_1, vec![r[1] % 2], edge_2].concat()
    });
    let (near, fraction, offset) = (Uniform(-20.0, 20.0), Uniform(-1.0, 1.0), Uniform(-0.5, 0.5));
    vec![
        FunctionCase::new(
            "collision_position",
            &COLLISION,
            &[a_map, near, near, near],
            Tol::relative(
                1.0e-5,
                1.0e-3,
                "scalar products of up to 40 m, known to 1e-5 m, times 20 per m; a GPU may fuse them",
            ),
            |a| collision_position(&map(a), vec3(a)).to_array().words(),
        ),
        FunctionCase::new(
            "collision_pack",
            &COLLISION,
            &[
                Made(|r| {
                    let [a, b, c, _] = r.map(rng_unit);
                    [a - 0.5, b - 0.5, c - 0.02].words()
                }),
                Below(2),
            ],
            Tol::exact("integers, but for numbers half-way between two").with_outliers(2.0e-3),
            |a| {
                let normal = vec3(a);
                collision_pack(normal, a.u32() != 0).words()
            },
        ),
        FunctionCase::new("collision_solid", &COLLISION, &[a_surface], Tol::exact("a bit of a word"), |a| {
            collision_solid(a.u32()).words()
        }),
        FunctionCase::new(
            "collision_square",
            &COLLISION,
            &[a_surface],
            Tol::absolute(1.0e-6, "unpacking is known to 1 ulp of 1, and the third is a difference of them"),
            |a| collision_square(a.u32()).to_array().words(),
        ),
        FunctionCase::new(
            "collision_normal",
            &COLLISION,
            &[a_surface],
            Tol::absolute(2.0e-6, "as collision_square, a square root and a division"),
            |a| collision_normal(a.u32()).to_array().words(),
        ),
        FunctionCase::new(
            "collision_slope",
            &COLLISION,
            &[a_surface],
            Tol::relative(1.0e-5, 1.0e-5, "as collision_square, divided by 0.15 or more"),
            |a| collision_slope(a.u32()).to_array().words(),
        ),
        // Surfaces that are steep to the last digit.
        FunctionCase::new(
            "collision_square",
            &COLLISION,
            &[steep],
            Tol::absolute(1.0e-6, "unpacking is known to 1 ulp of 1, and the third is a difference of them"),
            |a| collision_square(a.u32()).to_array().words(),
        ),
        FunctionCase::new(
            "collision_slope",
            &COLLISION,
            &[steep],
            Tol::relative(1.0e-5, 1.0e-3, "what is unpacked (1 ulp), over the least that counts"),
            |a| collision_slope(a.u32()).to_array().words(),
        ),
        FunctionCase::new(
            "collision_depths",
            &COLLISION,
            &[a_map, a_texel, offset, offset],
            Tol::relative(1.0e-6, 1.0e-5, "as collision_slope, times a texel"),
            |a| {
                let (map, texel) = (map(a), texel(a));
                collision_depths(&map, &texel, Vec2::from(a.f32s())).words()
            },
        ),
        FunctionCase::new(
            "collision_count",
            &COLLISION,
            &[near, near, near, near, near],
            Tol::exact("comparisons"),
            |a| collision_count(&a.f32s(), a.f32()).words(),
        ),
        FunctionCase::new(
            "collision_shallow",
            &COLLISION,
            &[a_map, a_surface],
            Tol::relative(1.0e-5, 1.0e-6, "as collision_slope, and a square root"),
            |a| collision_shallow(&map(a), a.u32()).words(),
        ),
        FunctionCase::new(
            "collision_column",
            &COLLISION,
            &[
                a_map,
                a_texel,
                offset,
                offset,
                Uniform(0.0, 5.0),
                offset,
                offset,
                Uniform(0.0, 5.0),
                Made(|r| vec![[0, 1, 2, COLLISION_START][r[0] as usize % 4]]),
            ],
            Tol::absolute(
                2.0e-4,
                "a quotient of depths known to 1e-5; a drop on a surface may be on either side",
            )
            .with_outliers(5.0e-4),
            column,
        ),
        // Drops that begin within millimeters of a surface.
        FunctionCase::new(
            "collision_column",
            &COLLISION,
            &[Made(close_words)],
            Tol::absolute(
                2.0e-4,
                "a quotient of depths known to 1e-5; a drop on a surface may be on either side",
            )
            .with_outliers(3.0e-3),
            column,
        ),
        FunctionCase::new(
            "collision_turn",
            &COLLISION,
            &[a_map, Unit3],
            Tol::absolute(1.0e-6, "a sum of three products below 1; a GPU may fuse them"),
            |a| collision_turn(&map(a), vec3(a)).to_array().words(),
        ),
        FunctionCase::new(
            "collision_wall",
            &COLLISION,
            &[a_map, fraction, fraction, fraction],
            Tol::absolute(1.0e-5, "a unit vector of a sum of two products: a square root and a division"),
            |a| collision_wall(&map(a), vec3(a)).to_array().words(),
        ),
        FunctionCase::new(
            "collision_map_faces",
            &COLLISION_MAP,
            &[a_triangle, Unit3],
            Tol::exact("a sign; of a triangle that is seen from its edge it may be either")
                .with_outliers(1.0e-3),
            |a| collision_map_faces(&triangle(a), vec3(a)).words(),
        ),
        // Along the triangle, exactly, and across it.
        FunctionCase::new(
            "collision_map_faces",
            &COLLISION_MAP,
            &[
                [Fixed(0.0); 3].as_slice(),
                &[Below(9), Fixed(1.0), Fixed(0.0), Fixed(0.0), Below(2), Fixed(0.0), Fixed(1.0), Fixed(0.0)],
                &[OneOf(&[-1.0, 0.0, 1.0]); 3],
            ]
            .concat(),
            Tol::exact("a sign of numbers that are exact"),
            |a| collision_map_faces(&triangle(a), vec3(a)).words(),
        ),
        FunctionCase::new(
            "collision_map_normal",
            &COLLISION_MAP,
            &[a_map, a_triangle],
            Tol::absolute(
                1.0e-6,
                "products of numbers below 0.5; seen from its edge, a triangle may be turned either way",
            )
            .with_outliers(1.0e-3),
            |a| {
                let map = map(a);
                collision_map_normal(&map, &triangle(a)).to_array().words()
            },
        ),
        FunctionCase::new(
            "collision_map_between",
            &COLLISION_MAP,
            &[Below(4), Below(4)],
            Tol::exact("a choice between integers"),
            |a| collision_map_between(a.u32(), a.u32()).words(),
        ),
        FunctionCase::new(
            "collision_map_add",
            &COLLISION_MAP,
            &[a_texel, Below(7), Uniform(5.0, 9.0), a_surface, Below(2), Below(2)],
            Tol::exact("values are moved"),
            |a| {
                let (texel, stored, depth, surface) = (texel(a), a.u32(), a.f32(), a.u32());
                let added = collision_map_add(&texel, stored, depth, surface, a.u32() != 0, a.u32() != 0);
                (added.depths, added.surfaces).words()
            },
        ),
    ]
}

/// A floor, and boxes that stand in it, in each other, and above it; leaves over all that.
fn scene() -> Bvh {
    let mut all = Vec::new();
    let mut quad = |c: [Vec3; 4]| {
        let [p, q, r, s] = c.map(|v| v.to_array());
        all.extend([[p, q, r], [p, r, s]]);
    };
    let flat = |low: f32, high: f32, y: f32| {
        [[low, low], [low, high], [high, high], [high, low]].map(|[x, z]| Vec3::new(x, y, z))
    };
    quad(flat(-9.0, 9.0, 0.0));
    for k in 0..9 {
        quad(flat(-4.0 + 0.3 * k as f32, -2.0 + 0.3 * k as f32, 3.0 + 0.2 * k as f32));
    }
    for i in 0..24 {
        let ([a, b, c, d], [e, f, g, h]) = (more([i, 1, 2, 3], 0), more([i, 1, 2, 3], 1));
        let half = Vec3::new(0.2 + 0.8 * a, 0.2 + 0.8 * b, 0.2 + 0.8 * c);
        let turn = Quat::from_rotation_y(6.0 * d) * Quat::from_rotation_x(if h < 0.3 { h } else { 0.0 });
        let position = Vec3::new(8.0 * e - 4.0, 2.5 * f, 8.0 * g - 4.0);
        let at = |bits: u32| {
            let sign = |k: u32| if bits >> k & 1 == 1 { 1.0 } else { -1.0 };
            position + turn * (half * Vec3::new(sign(0), sign(1), sign(2)))
        };
        for face in [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]] {
            quad(face.map(at));
        }
    }
    Bvh::new(&all)
}

fn options(angle: f32) -> CollisionOptions {
    CollisionOptions {
        fall: slanted(angle, 0.7),
        size: [9.0, 10.0],
        texels: [72, 60],
        ..CollisionOptions::default()
    }
}

/// The depths of a texel, and of each surface its normal and what is below.
fn texel_values(texels: &[CollisionTexel]) -> Vec<u32> {
    let surface = |&s: &u32| [collision_normal(s).to_array().words(), collision_solid(s).words()].concat();
    texels
        .iter()
        .flat_map(|t| [t.depths.words(), t.surfaces.iter().flat_map(surface).collect()].concat())
        .collect()
}

/// A whole map.
fn map_case(gpu: &Gpu, angle: f32) -> Result<Run, GpuError> {
    let scene = scene();
    let map = CollisionMap::new(&options(angle), &scene).expect("a map");
    let nodes = gpu.storage_buffer("bvh nodes", &scene.nodes)?;
    let triangles = gpu.storage_buffer("bvh triangles", &scene.triangles)?;
    let [width, height] = map.frame().size;
    let there = GpuCollisionMap::new(gpu, [width, height])?;
    let poison = vec![POISON; size_of_val(map.texels()) / 4];
    gpu.queue().write_buffer(there.map().texels(), 0, bytemuck::cast_slice(&poison));
    there.update(gpu, map.frame(), &nodes, &triangles)?;
    let made = there.map().read(gpu)?;
    Ok(Run {
        arguments: (0..width * height).map(|i| vec![i % width, i / width]).collect(),
        cpu: Cpu(texel_values(map.texels())),
        gpu: FromGpu(texel_values(&made)),
        kinds: [vec![Float; 4], [Float, Float, Float, Integer].repeat(COLLISION_LAYERS as usize)].concat(),
    })
}

/// The module, asked as the step of drops asks it.
fn find_text() -> String {
    compose(&[&COLLISION]).replace("@binding(8)", "@binding(0)").replace("@binding(9)", "@binding(1)")
        + "
@group(0) @binding(2) var<storage, read> parity_ways: array<array<vec4f, 2>>;
@group(0) @binding(3) var<storage, read_write> parity_out: array<array<u32, 8>>;

@compute @workgroup_size(64)
fn main_parity(@builtin(global_invocation_id) id: vec3u) {
    let start = parity_ways[id.x][0].xyz;
    let hit = collision_find(start, parity_ways[id.x][1].xyz);
    let sky = select(0u, 1u, collision_open(start));
    let solid = select(0u, 1u, collision_inside(start));
    let normal = bitcast<vec3u>(hit.normal);
    parity_out[id.x] = array(sky, solid, hit.kind, bitcast<u32>(hit.fraction), normal.x, normal.y, normal.z, collision_cover(start).x);
}
"
}

/// Ways of drops through a map, asked of the module as the step of drops asks it.
fn find_case(gpu: &Gpu, angle: f32) -> Result<Run, GpuError> {
    let map = CollisionMap::new(&options(angle), &scene()).expect("a map");
    let fall = Vec3::from(map.frame().fall);
    let ways: Vec<[[f32; 4]; 2]> = (0..8192)
        .map(|i| {
            let ([a, b, c, d], [e, f, ..]) = (more([i, 4, 5, 6], 0), more([i, 4, 5, 6], 1));
            let start = Vec3::new(9.0 * a - 4.5, 4.5 * b, 9.0 * c - 4.5);
            // Every fourth goes up.
            let down = if i % 4 == 0 { -0.3 } else { 0.5 };
            let end = start + fall * (down * d) + Vec3::new(0.6 * e - 0.3, 0.0, 0.6 * f - 0.3);
            [start.extend(0.0).to_array(), end.extend(0.0).to_array()]
        })
        .collect();
    let kernel = ComputeKernel::from_source(gpu, "main_parity", &find_text(), &[])?;
    let out = gpu.storage_buffer("parity out", &vec![POISON; 8 * ways.len()])?;
    let bindings = kernel.bind(
        gpu,
        &[
            &gpu.uniform_buffer("collision frame", map.frame())?,
            &gpu.storage_buffer("collision texels", map.texels())?,
            &gpu.storage_buffer("ways", &ways)?,
            &out,
        ],
    )?;
    gpu.submit(&[kernel.dispatch(&bindings, [(ways.len() / 64) as u32, 1, 1])])?;
    let asked = |[start, end]: &[[f32; 4]; 2]| {
        let [start, end] = [start, end].map(|v| Vec3::from_slice(&v[..3]));
        let hit = collision_find(map.frame(), map.texels(), start, end);
        let [above, _] = downpour_sim::collision::collision_cover(map.frame(), map.texels(), start);
        [
            [map.open(start), map.inside(start)].words(),
            hit.kind.words(),
            hit.fraction.words(),
            hit.normal.to_array().words(),
            above.words(),
        ]
        .concat()
    };
    Ok(Run {
        arguments: ways.iter().map(|way| way.as_flattened().iter().map(|x| x.to_bits()).collect()).collect(),
        cpu: Cpu(ways.iter().flat_map(asked).collect()),
        gpu: FromGpu(gpu.read(&out)?),
        kinds: vec![Integer, Integer, Integer, Float, Float, Float, Float, Integer],
    })
}

/// The cases.
pub(super) fn kernels() -> Vec<KernelCase> {
    let made = |name, run| {
        KernelCase {
        name,
        kernel: &COLLISION_MAP_KERNEL,
        with: &[],
        overrides: &[],
        text: None,
        tol: Tol::relative(
            1.0e-5,
            1.5e-4,
            "depths known to 1e-5 of 10 m, normals in steps of 6e-5; a ray along an edge may see it on either side",
        )
        .with_outliers(3.0e-3),
        run,
    }
    };
    let found = |name, run| {
        KernelCase {
        name,
        kernel: &COLLISION_MAP_KERNEL,
        with: &[],
        overrides: &[],
        text: Some(find_text),
        tol: Tol::absolute(
            1.0e-3,
            "positions known to 1e-5 m of ways of 0.1 m and more; a drop at a border or on a surface may be on either side",
        )
        .with_outliers(3.0e-3),
        run,
    }
    };
    vec![
        made("main_collision_map: from above", |gpu| map_case(gpu, 0.0)),
        made("main_collision_map: along a fall of 30 degrees", |gpu| map_case(gpu, 0.52)),
        found("collision_find: from above", |gpu| find_case(gpu, 0.0)),
        found("collision_find: along a fall of 30 degrees", |gpu| find_case(gpu, 0.52)),
    ]
}
