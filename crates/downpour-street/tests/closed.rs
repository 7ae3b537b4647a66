//! Surfaces that should be closed are: nothing looks into a post, a bin or a car.

use std::collections::BTreeMap;

use downpour_street::{LampEra, Material, Mesh, Street, StreetSettings};
use glam::Vec3;

/// Corners of a mesh, those at the same point as one, and the triangles between them.
#[derive(Default)]
struct Welded {
    points: Vec<Vec3>,
    triangles: Vec<[usize; 3]>,
    /// Points by cells of 2 mm.
    cells: BTreeMap<[i32; 3], Vec<usize>>,
}

impl Welded {
    /// Triangles of a material, or of all of them.
    fn new(mesh: &Mesh, only: Option<Material>) -> Self {
        let mut welded = Self::default();
        for (_, part) in mesh.parts.iter().filter(|(material, _)| only.is_none_or(|only| only == **material))
        {
            for corners in part.indices.chunks_exact(3) {
                let corner = |k: usize| part.vertices[corners[k] as usize].position;
                let triangle = [corner(0), corner(1), corner(2)].map(|point| welded.point(point));
                welded.triangles.push(triangle);
            }
        }
        welded
    }

    /// The number of a point, the same for all within 0.1 mm.
    fn point(&mut self, point: Vec3) -> usize {
        let [x, y, z] = (point * 500.0).floor().to_array().map(|v| v as i32);
        for d in 0..27 {
            let cell = [x + d % 3 - 1, y + d / 3 % 3 - 1, z + d / 9 - 1];
            let near = self.cells.get(&cell).into_iter().flatten();
            if let Some(&known) = near.into_iter().find(|&&k| self.points[k].distance(point) < 1e-4) {
                return known;
            }
        }
        self.points.push(point);
        self.cells.entry([x, y, z]).or_default().push(self.points.len() - 1);
        self.points.len() - 1
    }

    /// The triangles that are joined to the corner nearest to a point.
    fn joined_to(mut self, point: Vec3) -> Self {
        let distance = |k: &usize| self.points[*k].distance_squared(point);
        let nearest = (0..self.points.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let mut is_joined = vec![false; self.points.len()];
        is_joined[nearest.expect("points")] = true;
        loop {
            let mut has_grown = false;
            for triangle in &self.triangles {
                let count = triangle.iter().filter(|&&k| is_joined[k]).count();
                has_grown |= count == 1 || count == 2;
                if count > 0 {
                    triangle.iter().for_each(|&k| is_joined[k] = true);
                }
            }
            if !has_grown {
                break;
            }
        }
        self.triangles.retain(|triangle| is_joined[triangle[0]]);
        self
    }

    /// Volume inside, m^3, positive if the faces look outwards (divergence theorem).
    fn volume_m3(&self) -> f32 {
        let of = |t: &[usize; 3]| {
            let [a, b, c] = t.map(|k| self.points[k]);
            a.dot(b.cross(c)) / 6.0
        };
        self.triangles.iter().map(of).sum()
    }

    /// Ends of the edges that have no triangle on their other side.
    fn open_edges(&self) -> Vec<[Vec3; 2]> {
        let mut edges: BTreeMap<[usize; 2], i32> = BTreeMap::new();
        for [a, b, c] in &self.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let (edge, turn) = if from < to { ([*from, *to], 1) } else { ([*to, *from], -1) };
                *edges.entry(edge).or_default() += turn;
            }
        }
        let open = edges.into_iter().filter(|(_, turn)| *turn != 0);
        open.map(|(edge, _)| edge.map(|k| self.points[k])).collect()
    }
}

/// The mesh of a thing in one of some full streets.
fn mesh(name: &str, lamps: LampEra) -> Mesh {
    let street = |seed| {
        let settings = StreetSettings { seed, lamps, furniture: 1.0, cars: 1.0, ..StreetSettings::default() };
        Street::generate(&settings).expect("a street")
    };
    let found = (0..8).find_map(|seed| {
        street(seed).pieces().iter().find(|piece| piece.name == name).map(|piece| piece.mesh.clone())
    });
    found.unwrap_or_else(|| panic!("no {name}"))
}

#[test]
fn boxes_are_closed_and_look_outwards() {
    for (name, material, volume_m3) in [
        // Four planks of 1.7 x 0.088 x 0.032 m and three of 1.7 x 0.03 x 0.09 m.
        ("bench", Material::Wood, 4.0 * 1.7 * 0.088 * 0.032 + 3.0 * 1.7 * 0.03 * 0.09),
        // Seven slats of the seat and three of the back.
        ("chair", Material::Wood, 7.0 * 0.41 * 0.016 * 0.042 + 3.0 * 0.40 * 0.062 * 0.014),
        ("planter", Material::Joinery, 0.48 * 0.48 * 0.44 + 0.52 * 0.52 * 0.05),
        ("planter", Material::Soil, 0.44 * 0.44 * 0.055),
        ("grate", Material::Soil, 1.2 * 1.2 * 0.034),
    ] {
        let mesh = Welded::new(&mesh(name, LampEra::Lantern), Some(material));
        assert_eq!(mesh.open_edges(), Vec::<[Vec3; 2]>::new(), "{name}");
        assert!((mesh.volume_m3() / volume_m3 - 1.0).abs() < 1e-3, "{name} {}", mesh.volume_m3());
    }
}

/// Turned shapes: the whole of bollard, bin and table top, each closed.
#[test]
fn turned_shapes_are_closed_and_look_outwards() {
    let turned = [
        ("bollard", Material::Iron, 0.013..0.018),
        ("bin", Material::Iron, 0.055..0.075),
        ("table", Material::Stone, 0.010..0.012),
    ];
    for (name, material, volume_m3) in turned {
        let mesh = Welded::new(&mesh(name, LampEra::Lantern), Some(material));
        assert_eq!(mesh.open_edges(), Vec::<[Vec3; 2]>::new(), "{name}");
        assert!(volume_m3.contains(&mesh.volume_m3()), "{name} {}", mesh.volume_m3());
    }
}

/// Posts and trunks stand in the ground, and are open there and nowhere else.
#[test]
fn posts_and_trunks_are_open_in_the_ground_alone() {
    let posts = [
        ("lamp", Material::Iron, LampEra::Lantern),
        ("lamp", Material::Iron, LampEra::Sodium),
        ("lamp", Material::Iron, LampEra::Led),
        ("sign post", Material::Zinc, LampEra::Lantern),
        ("tree", Material::Bark, LampEra::Lantern),
    ];
    for (name, material, lamps) in posts {
        let post = Welded::new(&mesh(name, lamps), Some(material)).joined_to(Vec3::ZERO);
        assert!(post.triangles.iter().flatten().any(|&k| post.points[k].y > 2.5), "{name}");
        let over = post.open_edges().into_iter().flatten().map(|point| point.y).fold(f32::MIN, f32::max);
        assert!(over < 1e-3, "{name} {lamps:?}: {over}");
        assert!(post.volume_m3() > 0.001, "{name} {}", post.volume_m3());
    }
}

/// The body of a car, of paint, glass and trim together, is open below alone: along its sills and arches.
#[test]
fn the_body_of_a_car_is_open_below_alone() {
    let body = Welded::new(&mesh("car 0", LampEra::Lantern), None).joined_to(Vec3::new(0.0, 5.0, -0.3));
    assert!((5.5..8.0).contains(&body.volume_m3()), "{}", body.volume_m3());
    let open = body.open_edges();
    for end in open.iter().flatten() {
        // The bottom of doors and bumpers; the top of an arch is 0.70 m high.
        let is_arch = [1.30f32, -1.25].iter().any(|axle| (end.z - axle).abs() < 0.39);
        assert!(end.y < if is_arch { 0.71 } else { 0.33 }, "{end}");
    }
    // One edge all around.
    let mut ends: BTreeMap<[i32; 3], usize> = BTreeMap::new();
    for end in open.iter().flatten() {
        *ends.entry((*end * 1e4).round().to_array().map(|v| v as i32)).or_default() += 1;
    }
    assert!(ends.values().all(|&count| count == 2), "{ends:?}");
}
