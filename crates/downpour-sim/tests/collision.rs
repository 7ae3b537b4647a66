//! Collision map against scenes with known answers and against exact rays.

#[path = "collision/scenes.rs"]
mod scenes;

use downpour_bvh::Bvh;
use downpour_math::ops;
use downpour_shaders::sim::collision::{COLLISION_NONE, COLLISION_SURFACE, COLLISION_WALL};
use downpour_sim::SimError;
use downpour_sim::collision::{
    CollisionFrame, CollisionHit, CollisionMap, CollisionOptions, collision_normal, collision_pack,
    collision_solid,
};
use glam::{Quat, Vec3};
use scenes::{Triangle, boxes, cuboid, floor, quad, sphere, turned, units};

const DOWN: Vec3 = Vec3::NEG_Y;

/// A map of `n` x `n` texels over `size` meters around the origin.
fn map(scene: &[Triangle], fall: Vec3, size: f32, n: u32) -> CollisionMap {
    let options = CollisionOptions { fall, size: [size; 2], texels: [n; 2], ..CollisionOptions::default() };
    CollisionMap::new(&options, &Bvh::new(scene)).expect("a map")
}

fn at(x: f32, y: f32, z: f32) -> Vec3 {
    Vec3::new(x, y, z)
}

/// The angle between two unit vectors, radians.
fn angle(a: Vec3, b: Vec3) -> f32 {
    2.0 * ops::asin(0.5 * (a - b).length().min(2.0))
}

fn expect(hit: Option<CollisionHit>, kind: u32, fraction: f32, normal: Vec3) {
    let hit = hit.expect("nothing was hit");
    assert_eq!(hit.kind, kind, "{hit:?}");
    assert!((hit.fraction - fraction).abs() < 1.0e-3 && angle(hit.normal, normal) < 1.0e-3, "{hit:?}");
}

/// A fall of so many degrees from down toward +X.
fn slanted(degrees: f32) -> Vec3 {
    let a = degrees.to_radians();
    at(ops::sin(a), -ops::cos(a), 0.0)
}

#[test]
fn under_a_roof_it_is_dry_and_the_floor_stops_what_the_wind_brings() {
    let mut scene = floor([-10.0, -10.0], [10.0, 10.0], 0.0);
    scene.extend(floor([-2.0, -2.0], [2.0, 2.0], 3.0));
    let map = map(&scene, DOWN, 16.0, 160);
    for x in [-1.9, 0.03, 1.9] {
        assert!(map.open(at(x, 3.1, 0.5)) && !map.open(at(x, 2.9, 0.5)) && !map.open(at(x, 0.1, 0.5)));
        assert!(!map.inside(at(x, 2.9, 0.5)) && !map.inside(at(x, 0.1, 0.5)) && map.inside(at(x, -0.1, 0.5)));
        expect(map.find(at(x, 3.2, 0.5), at(x, 2.8, 0.5)), COLLISION_SURFACE, 0.5, Vec3::Y);
    }
    assert!(map.open(at(2.2, 0.1, 0.5)) && map.inside(at(2.2, -0.1, 0.5)));
    // From the side, below the roof, to the floor.
    assert_eq!(map.find(at(2.3, 1.5, 0.0), at(1.2, 1.0, 0.3)), None);
    expect(map.find(at(1.2, 0.3, 0.3), at(0.6, -0.1, 0.3)), COLLISION_SURFACE, 0.75, Vec3::Y);
    // A drop that is blown upwards hits the roof from below.
    expect(map.find(at(0.5, 2.9, 0.0), at(0.6, 3.1, 0.0)), COLLISION_SURFACE, 0.5, Vec3::NEG_Y);
    // A bounced drop leaves, even if it is 1 mm below the surface.
    for y in [0.0, 3.0] {
        for below in [0.0, 0.5e-3, -1.0e-3] {
            assert_eq!(map.find(at(0.5, y - below, 0.0), at(0.55, y + 0.05, 0.02)), None, "{y} - {below}");
            let again = map.find(at(0.5, y - below, 0.0), at(0.55, y - 0.05, 0.02));
            assert!(again.is_some_and(|hit| hit.fraction < 0.03), "{y} - {below}: {again:?}");
        }
    }
}

#[test]
fn outside_the_map_and_without_a_scene_everything_is_open() {
    let hilly = map(&floor([-10.0, -10.0], [10.0, 10.0], 0.0), DOWN, 4.0, 40);
    let empty = map(&[], slanted(20.0), 4.0, 40);
    for position in [at(2.1, -5.0, 0.0), at(0.0, -5.0, -2.1), at(1.0e9, -1.0, 0.0), at(f32::NAN, -1.0, 0.0)] {
        assert!(hilly.open(position) && !hilly.inside(position), "{position}");
        assert_eq!(hilly.find(position, position + at(0.01, -1.0, 0.0)), None, "{position}");
    }
    assert!(empty.open(at(0.0, -100.0, 0.0)) && empty.find(Vec3::ZERO, at(0.0, -100.0, 0.0)).is_none());
    assert!(empty.texels().iter().all(|t| t.depths[0] >= COLLISION_NONE));
    // A path that crosses the whole map is followed for 32 texels and no farther; the result says so.
    let hit = downpour_sim::collision::collision_find(
        hilly.frame(),
        hilly.texels(),
        at(-1.95, 0.5, 0.0),
        at(6.05, 0.5, 0.0),
    );
    assert!(hit.kind == 0 && (hit.fraction - 31.5 / 80.0).abs() < 0.02, "{hit:?}");
}

/// The tangent plane of each texel is the plane itself.
#[test]
fn a_tilted_plane_is_met_where_it_is() {
    for (slope_x, slope_z) in [(0.5, 0.2), (-1.5, 0.7), (0.0, 2.5)] {
        let y = |x: f32, z: f32| slope_x * x + slope_z * z;
        let corner = |x: f32, z: f32| at(x, y(x, z), z);
        let scene =
            quad([corner(-20.0, -20.0), corner(-20.0, 20.0), corner(20.0, 20.0), corner(20.0, -20.0)]);
        let normal = at(-slope_x, 1.0, -slope_z).normalize();
        for fall in [DOWN, slanted(20.0)] {
            let map = map(&scene, fall, 20.0, 200);
            let mut worst = 0.0f32;
            for i in 0..2000 {
                let [a, b, c, d] = units(i, 0);
                let target = corner(4.0 * a - 2.0, 4.0 * b - 2.0);
                let way = fall * 0.2 + at(0.3 * c - 0.15, 0.0, 0.3 * d - 0.15);
                // Up to 3 texels aside: some paths would lead away from a steep plane.
                if way.dot(normal) > -0.02 {
                    continue;
                }
                let hit = map
                    .find(target - 0.6 * way, target + 0.4 * way)
                    .unwrap_or_else(|| panic!("{target} {way} {fall} {normal}"));
                assert_eq!(hit.kind, COLLISION_SURFACE, "{hit:?}");
                assert!(angle(hit.normal, normal) < 2.0e-4, "{hit:?} {normal}");
                let met = target + way * (hit.fraction - 0.6);
                worst = worst.max((met - target).dot(normal).abs());
            }
            // 0.1 % of a texel of 0.1 m; measured 0.03 %.
            assert!(worst < 1.0e-4, "{slope_x} {slope_z} {fall}: {worst} m");
        }
    }
}

#[test]
fn a_sphere_has_its_normals_and_is_solid() {
    let center = at(0.3, 5.0, -0.2);
    let ball = map(&sphere(center, 2.0, 96), DOWN, 5.0, 200);
    for i in 0..3000 {
        let [a, b, ..] = units(i, 1);
        let (x, z) = (3.0 * a - 1.5, 3.0 * b - 1.5);
        let r2 = x * x + z * z;
        if r2 > 1.7 * 1.7 {
            continue;
        }
        let top = center + at(x, (4.0 - r2).sqrt(), z);
        let hit = ball.find(top + at(0.0, 0.3, 0.0), top - at(0.0, 0.1, 0.0)).expect("the ball is there");
        let normal = (top - center) / 2.0;
        // Facets of 2 degrees, texels of 2.5 cm.
        assert!(angle(hit.normal, normal) < 0.05, "{hit:?} {normal}");
        assert!((hit.fraction - 0.75).abs() < 0.05, "{hit:?} at {x} {z}");
        let below = center - (top - center);
        assert!(ball.inside(center + at(x, 0.0, z)) && !ball.inside(at(top.x, below.y - 0.2, top.z)));
    }
    assert!(ball.open(at(2.4, 0.0, -0.2)) && !ball.open(at(0.3, 0.0, -0.2)));
}

#[test]
fn a_box_stops_from_above_by_its_top_and_from_the_side_as_a_wall() {
    let scene = cuboid(at(-1.0, 1.0, -1.0), at(1.0, 3.0, 1.0));
    let map = map(&scene, DOWN, 6.0, 60);
    assert!(
        map.inside(at(0.2, 2.0, 0.3)) && !map.inside(at(0.2, 0.9, 0.3)) && !map.inside(at(1.2, 2.0, 0.3))
    );
    expect(map.find(at(0.5, 3.1, 0.0), at(0.52, 2.9, 0.0)), COLLISION_SURFACE, 0.5, Vec3::Y);
    expect(map.find(at(1.1, 2.0, 0.0), at(0.9, 1.9, 0.0)), COLLISION_WALL, 0.5, Vec3::X);
    expect(map.find(at(0.0, 2.0, -1.2), at(0.0, 2.1, -0.8)), COLLISION_WALL, 0.5, Vec3::NEG_Z);
    // Blown up against the underside.
    expect(map.find(at(0.0, 0.9, 0.0), at(0.0, 1.1, 0.0)), COLLISION_SURFACE, 0.5, Vec3::NEG_Y);
    // Across the edge of the top, a little below it: it has hit the top.
    let edge = map.find(at(1.04, 3.0, 0.0), at(0.96, 2.98, 0.0)).expect("the edge is there");
    assert_eq!(edge.kind, COLLISION_SURFACE, "{edge:?}");
    assert_eq!(map.find(at(1.3, 3.5, 0.0), at(1.2, 0.5, 0.0)), None);
    assert_eq!(map.find(at(0.3, 0.5, 0.0), at(0.2, -9.0, 0.0)), None);
}

#[test]
fn a_bridge_and_the_road_under_it_both_stop_rain() {
    let mut scene = floor([-10.0, -10.0], [10.0, 10.0], 0.0);
    scene.extend(cuboid(at(-10.0, 5.0, -2.0), at(10.0, 5.6, 2.0)));
    let map = map(&scene, DOWN, 16.0, 128);
    assert!(
        map.inside(at(0.0, 5.3, 0.0)) && !map.inside(at(0.0, 4.9, 0.0)) && !map.inside(at(0.0, 0.1, 0.0))
    );
    expect(map.find(at(0.1, 5.7, 0.0), at(0.1, 5.5, 0.0)), COLLISION_SURFACE, 0.5, Vec3::Y);
    assert_eq!(map.find(at(0.0, 2.0, 2.3), at(0.0, 1.5, 1.0)), None);
    expect(map.find(at(0.0, 0.1, 1.0), at(0.0, -0.1, 0.9)), COLLISION_SURFACE, 0.5, Vec3::Y);
    assert_eq!(map.find(at(0.0, 5.3, 2.1), at(0.0, 5.25, 1.9)).map(|hit| hit.kind), Some(COLLISION_WALL));
}

/// A house without a bottom that stands in the ground is solid down to the ground; an awning is not, whatever is below.
#[test]
fn a_house_in_the_ground_is_solid_and_an_awning_is_not() {
    let mut scene = floor([-10.0, -10.0], [10.0, 10.0], 0.0);
    let house = cuboid(at(-4.0, -0.4, -1.0), at(-2.0, 3.0, 1.0));
    // The third pair of a box's faces is its bottom.
    scene.extend(house.iter().enumerate().filter(|(i, _)| !(4..6).contains(i)).map(|(_, t)| *t));
    scene.extend(cuboid(at(-1.0, -0.4, -1.0), at(1.0, 3.0, 1.0)));
    scene.extend(floor([3.0, -1.0], [5.0, 1.0], 3.0));
    scene.extend(cuboid(at(3.5, -0.2, -0.5), at(4.5, 1.0, 0.5)));
    for fall in [DOWN, slanted(25.0)] {
        let map = map(&scene, fall, 14.0, 140);
        for (x, y, inside) in [(-3.0, 1.5, true), (0.0, 1.5, true), (4.0, 2.0, false), (4.0, 0.5, true)] {
            assert_eq!(map.inside(at(x, y, 0.1)), inside, "{fall}: {x} {y}");
        }
        for x in [-1.95, 1.05] {
            let hit = map.find(at(x, 1.0, 0.0), at(x - 0.2, 0.9, 0.0)).expect("a wall");
            assert!(angle(hit.normal, Vec3::X) < 1.0e-3, "{fall}: {x} {hit:?}");
            // Along a slanted fall, walls are surfaces of the map, on the lee side from below.
            assert_eq!(hit.kind, if fall == DOWN { COLLISION_WALL } else { COLLISION_SURFACE }, "{fall}");
        }
        assert_eq!(map.find(at(5.1, 2.0, 0.0), at(4.8, 1.9, 0.0)), None, "{fall}");
    }
}

#[test]
fn sheets_stop_rain_whichever_way_they_face() {
    let up = floor([-1.0, -1.0], [1.0, 1.0], 2.0);
    let down: Vec<Triangle> = up.iter().map(|&[a, b, c]| [a, c, b]).collect();
    let both = [up.clone(), down.clone()].concat();
    for (sheet, name) in [(up, "up"), (down, "down"), (both, "both")] {
        let scene = [sheet, floor([-5.0, -5.0], [5.0, 5.0], 0.0)].concat();
        let map = map(&scene, DOWN, 4.0, 40);
        expect(map.find(at(0.0, 2.1, 0.0), at(0.0, 1.9, 0.0)), COLLISION_SURFACE, 0.5, Vec3::Y);
        expect(map.find(at(0.0, 1.9, 0.0), at(0.0, 2.1, 0.0)), COLLISION_SURFACE, 0.5, Vec3::NEG_Y);
        assert!(!map.inside(at(0.0, 1.0, 0.0)), "{name}");
        expect(map.find(at(0.0, 0.1, 0.0), at(0.0, -0.1, 0.0)), COLLISION_SURFACE, 0.5, Vec3::Y);
    }
}

#[test]
fn stacked_and_overlapping_boxes_are_one_solid() {
    let touching =
        [cuboid(at(-1.0, 0.0, -1.0), at(1.0, 1.0, 1.0)), cuboid(at(-1.0, 1.0, -1.0), at(1.0, 2.0, 1.0))];
    let overlapping =
        [cuboid(at(-1.0, 0.0, -1.0), at(1.0, 1.3, 1.0)), cuboid(at(-0.9, 0.8, -0.9), at(0.9, 2.0, 0.9))];
    for scene in [touching.concat(), overlapping.concat()] {
        let map = map(&scene, DOWN, 4.0, 40);
        for y in [0.1, 0.9, 1.05, 1.4, 1.9] {
            assert!(map.inside(at(0.1, y, 0.2)), "{y}");
        }
        assert!(!map.inside(at(0.1, -0.1, 0.2)) && map.open(at(0.1, 2.1, 0.2)));
        assert_eq!(map.find(at(1.1, 0.7, 0.0), at(0.8, 0.6, 0.0)).map(|hit| hit.kind), Some(COLLISION_WALL));
    }
}

/// Twelve leaves are more than a texel holds: the ground is kept.
#[test]
fn under_many_leaves_is_the_ground() {
    let mut scene = floor([-5.0, -5.0], [5.0, 5.0], 0.0);
    for k in 1..=12 {
        scene.extend(floor([-1.0, -1.0], [1.0, 1.0], 2.0 + 0.3 * k as f32));
    }
    for n in [12, 30] {
        for k in 13..=n {
            scene.extend(floor([-1.0, -1.0], [1.0, 1.0], 5.0 + 0.1 * k as f32));
        }
        let map = map(&scene, DOWN, 4.0, 40);
        let top = if n == 12 { 5.6 } else { 8.0 };
        expect(map.find(at(0.0, top + 0.1, 0.0), at(0.0, top - 0.1, 0.0)), COLLISION_SURFACE, 0.5, Vec3::Y);
        assert!(!map.inside(at(0.0, 1.0, 0.0)), "{n}");
        expect(map.find(at(0.3, 0.1, 0.0), at(0.4, -0.1, 0.0)), COLLISION_SURFACE, 0.5, Vec3::Y);
    }
}

/// The map of a slanted fall is that of a vertical one on the rotated scene.
#[test]
fn a_slanted_fall_is_a_straight_one_on_a_turned_scene() {
    let scene = boxes(12);
    let fall = slanted(45.0);
    let turn = Quat::from_rotation_arc(fall, DOWN);
    let slanted = map(&scene, fall, 12.0, 96);
    let straight = map(&turned(&scene, turn), DOWN, 12.0, 96);
    let mut different = 0;
    let (mut hits, n) = (0, 4000);
    for i in 0..n {
        let [a, b, c, d] = units(i, 2);
        let start = at(8.0 * a - 4.0, 5.0 * b, 8.0 * c - 4.0);
        let end = start + fall * 0.5 + at(0.2 * d - 0.1, 0.0, 0.1);
        let (x, y) = (slanted.find(start, end), straight.find(turn * start, turn * end));
        hits += u32::from(x.is_some());
        let same = match (x, y) {
            (Some(x), Some(y)) => {
                x.kind == y.kind
                    && (x.fraction - y.fraction).abs() < 1.0e-2
                    && angle(turn * x.normal, y.normal) < 1.0e-2
            }
            (x, y) => x == y,
        };
        different += u32::from(!same || slanted.open(start) != straight.open(turn * start));
    }
    assert!(hits > n / 20, "{hits}");
    // Rays that pass an edge within rounding may be on either side; measured none.
    assert!(different * 1000 <= n, "{different} of {n}");
}

/// Fractions of falling drops that the map stops more than a texel before, or behind, the plane of the triangle that
/// an exact ray hits first.
fn strays(scene: &[Triangle], map: &CollisionMap, way: Vec3, size: f32, n: u32) -> [f64; 2] {
    let bvh = Bvh::new(scene);
    let texel = map.frame().edge[0];
    let (mut early, mut late, mut stopped) = (0, 0, 0);
    for i in 0..n {
        let [a, b, ..] = units(i, 3);
        let target = at(size * (a - 0.5), 0.0, size * (b - 0.5));
        let start = target - way * 40.0;
        let Some(hit) = bvh.hit(start.to_array(), way.to_array(), 0.0) else { continue };
        stopped += 1;
        let [p, q, r] = scene[hit.triangle as usize].map(Vec3::from);
        let normal = (q - p).cross(r - p).normalize();
        // Steps as long as those of a drop of 9 m/s at 60 pictures a second.
        let step = 0.15;
        let exact = hit.distance;
        let mut at = (exact - 1.0 - 0.1 * units(i, 4)[0]).max(0.0);
        let mut met = None;
        while met.is_none() && at < exact + 2.0 {
            let found = map.find(start + way * at, start + way * (at + step));
            met = found.map(|hit| at + step * hit.fraction);
            at += step;
        }
        let behind = (met.unwrap_or(at) - exact) * way.dot(normal).abs();
        early += u32::from(behind < -texel);
        late += u32::from(behind > texel);
    }
    [early, late].map(|count| f64::from(count) / f64::from(stopped))
}

/// Drops over 60 boxes, tilted and not, that intersect each other: along the fall of the map, and at an angle to it.
#[test]
fn drops_stop_where_exact_rays_do() {
    let scene = boxes(60);
    // Measured at most 0.34 % too early and 0.54 % too late, at edges, which are accurate to half a texel.
    for (fall, way) in [(0.0, 0.0), (30.0, 30.0), (0.0, 10.0), (30.0, 20.0), (0.0, 30.0)] {
        let map = map(&scene, slanted(fall), 26.0, 520);
        let [early, late] = strays(&scene, &map, slanted(way), 14.0, 20_000);
        assert!(early < 0.006 && late < 0.008, "fall {fall}, way {way}: early {early}, late {late}");
    }
}

/// Single steps of drops from positions outside solids: stopped or not, and at which position.
#[test]
fn random_ways_are_stopped_as_exact_rays_are() {
    let scene = boxes(60);
    let bvh = Bvh::new(&scene);
    let map = map(&scene, DOWN, 26.0, 520);
    let (mut different, mut hits, mut ways) = (0, 0, 0);
    for i in 0..100_000 {
        let ([a, b, c, d], [e, f, ..]) = (units(i, 7), units(i, 8));
        let start = at(14.0 * a - 7.0, 4.0 * b, 14.0 * c - 7.0);
        if map.inside(start) {
            continue;
        }
        ways += 1;
        let way = slanted(60.0 * d - 30.0) * (0.05 + 0.25 * e) + at(0.0, 0.0, 0.2 * f - 0.1);
        let exact = bvh.hit(start.to_array(), way.to_array(), 0.0).filter(|hit| hit.distance <= 1.0);
        let found = map.find(start, start + way);
        hits += u32::from(exact.is_some());
        different += u32::from(match (exact, found) {
            // A texel, 5 cm.
            (Some(exact), Some(found)) => (exact.distance - found.fraction).abs() * way.length() > 0.05,
            (exact, found) => exact.is_some() != found.is_some(),
        });
    }
    assert!(hits > 3000, "{hits}");
    // Measured 436 of 92 745, of which 5 650 are stopped: edges again.
    assert!(different * 100 < ways, "{different} of {ways}, {hits} of them stopped");
}

/// A house of the street with its neighbors' walls, its shop and its awning.
#[test]
fn a_roof_of_the_street_does_not_leak() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/scenes/plain/models/street.gltf");
    let mut budget = downpour_scene::Budget::default();
    let model = downpour_scene::gltf::read_triangles(path.as_ref(), &mut budget).unwrap();
    let middle = at(-10.5, 0.0, -9.25);
    let corner = |i: u32| Vec3::from(model.positions[i as usize]) - middle;
    let near = |t: &&[u32; 3]| t.iter().all(|&i| corner(i).with_y(0.0).abs().max_element() < 7.0);
    let mut scene: Vec<Triangle> =
        model.indices.iter().filter(near).map(|t| t.map(|i| corner(i).to_array())).collect();
    assert!(scene.len() > 5000, "{} triangles of a house", scene.len());
    scene.extend(floor([-30.0, -30.0], [30.0, 30.0], 0.0));
    // Edges are accurate to half a texel, 2.5 cm: gutters, ledges and the awning have some 60 m of them in 100 m^2. At
    // an angle to the fall of the map there are also more than four surfaces above each other, open at a side.
    // Measured late: 0.35 %, 0.18 %, 0.45 %; early: 0.06 %, 0.03 %, 0.63 %.
    for (fall, way, most_early, most_late) in
        [(0.0, 0.0, 0.002, 0.005), (30.0, 30.0, 0.002, 0.004), (0.0, 30.0, 0.009, 0.007)]
    {
        let map = map(&scene, slanted(fall), 24.0, 480);
        let [early, late] = strays(&scene, &map, slanted(way), 10.0, 100_000);
        assert!(late < most_late && early < most_early, "fall {fall}, way {way}: early {early}, late {late}");
    }
}

#[test]
fn the_same_bits_for_any_number_of_threads() {
    let bvh = Bvh::new(&boxes(30));
    let options = CollisionOptions { fall: slanted(20.0), texels: [97, 61], ..CollisionOptions::default() };
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| CollisionMap::new(&options, &bvh).unwrap())
    };
    let (one, three) = (with(1), with(3));
    assert_eq!(bytemuck::cast_slice::<_, u32>(one.texels()), bytemuck::cast_slice::<_, u32>(three.texels()));
    assert!(one.texels().iter().any(|t| t.depths[2] < COLLISION_NONE));
}

/// With drops relative to an anchor, a scene 10 km away is hit as exactly as one at the origin.
#[test]
fn far_from_the_origin_the_digits_are_kept() {
    let anchor = at(10_240.0, 0.0, -8_192.0);
    let scene = boxes(20);
    let there: Vec<Triangle> = scene.iter().map(|t| t.map(|p| (Vec3::from(p) + anchor).to_array())).collect();
    let options = CollisionOptions { size: [14.0; 2], texels: [140; 2], ..CollisionOptions::default() };
    let near = CollisionMap::new(&options, &Bvh::new(&scene)).unwrap();
    let far = CollisionMap::new(&CollisionOptions { anchor, ..options }, &Bvh::new(&there)).unwrap();
    let (mut different, mut hits) = (0, 0);
    for i in 0..4000 {
        let [a, b, c, d] = units(i, 5);
        let start = at(12.0 * a - 6.0, 4.0 * b, 12.0 * c - 6.0);
        let end = start + at(0.1 * d, -0.4, 0.0);
        let (x, y) = (near.find(start, end), far.find(start, end));
        hits += u32::from(x.is_some());
        let same = match (x, y) {
            (Some(x), Some(y)) => x.kind == y.kind && (x.fraction - y.fraction).abs() < 0.01,
            (x, y) => x.is_none() && y.is_none(),
        };
        different += u32::from(!same);
    }
    // The corners of the far scene are rounded to 0.5 mm; measured none.
    assert!(different <= 4 && hits > 400, "{different} of {hits}");
}

#[test]
fn a_covering_map_covers() {
    let (low, high) = (at(-3.0, 0.0, 2.0), at(5.0, 9.0, 6.0));
    let fall = slanted(35.0);
    let options = CollisionOptions::covering(low, high, fall, [64, 32]).unwrap();
    let map = CollisionMap::new(&options, &Bvh::new(&boxes(3))).unwrap();
    for corner in 0..8 {
        let pick = |k: usize| if corner >> k & 1 == 1 { high[k] } else { low[k] };
        let position =
            downpour_sim::collision::collision_position(map.frame(), at(pick(0), pick(1), pick(2)));
        assert!(
            position.x > -0.01 && position.x < 64.01 && position.y > -0.01 && position.y < 32.01,
            "{position}"
        );
    }
    let [width, height] = options.size;
    let exact = 8.0 * ops::cos(35.0f32.to_radians()) + 9.0 * ops::sin(35.0f32.to_radians());
    assert!((width - exact).abs() < 1.0e-3 && (height - 4.0).abs() < 1.0e-4, "{width} {height}");
}

#[test]
fn what_cannot_be_says_what_and_what_could() {
    let scene = Bvh::new(&boxes(1));
    let good = CollisionOptions::default();
    let cases = [
        (CollisionOptions { fall: slanted(81.0), ..good }, "81", "0 to 80"),
        (CollisionOptions { fall: Vec3::Y, ..good }, "180", "0 to 80"),
        (CollisionOptions { fall: Vec3::ZERO, ..good }, "NaN", "0 to 80"),
        (CollisionOptions { texels: [0, 5], ..good }, "0 texels", "1 to 4096"),
        (CollisionOptions { texels: [5, 4097], ..good }, "4097 texels", "1 to 4096"),
        (CollisionOptions { size: [f32::NAN, 1.0], ..good }, "NaN m", "above 0"),
        (CollisionOptions { size: [1.0, 0.0], ..good }, "0 m", "above 0"),
        (CollisionOptions { center: at(0.0, f32::INFINITY, 0.0), ..good }, "inf m", "1e7"),
        (CollisionOptions { anchor: at(2.0e7, 0.0, 0.0), ..good }, "20000000 m", "1e7"),
    ];
    for (options, found, allowed) in cases {
        let error: SimError = CollisionFrame::new(&options, &scene).unwrap_err();
        let text = error.to_string();
        assert!(text.contains(found) && text.contains(allowed), "{text}");
    }
    assert!(CollisionFrame::new(&CollisionOptions { fall: 7.0 * slanted(79.9), ..good }, &scene).is_ok());
    assert!(CollisionOptions::covering(Vec3::ONE, Vec3::ZERO, DOWN, [4, 4]).is_err());
}

/// 16 and 15 bits: the slope of a steep plane is accurate to 2e-4 rad, and flat is exactly flat.
#[test]
fn normals_keep_their_digits() {
    for i in 0..4000 {
        let [a, b, c, _] = units(i, 6);
        let normal = at(a - 0.5, b - 0.5, c + 1.0e-3).normalize();
        for solid in [false, true] {
            let word = collision_pack(normal * 3.0, solid);
            assert!(angle(collision_normal(word), normal) < 2.0e-4, "{normal}");
            assert_eq!(collision_solid(word), solid);
        }
    }
    assert_eq!(collision_normal(collision_pack(Vec3::Z, true)), Vec3::Z);
}
