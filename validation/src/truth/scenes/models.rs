//! Models of boxes and spheres, written as glTF.

use std::fmt::Write as _;
use std::path::Path;

use crate::truth::write;
use downpour_math::ops::f64 as ops;

/// Extension of light above 1.
const STRENGTH: &str = "KHR_materials_emissive_strength";

/// A material: base color, metallic, roughness.
#[derive(Clone, Copy, Debug)]
struct Look([f64; 3], f64, f64);

/// Triangles of one material.
#[derive(Clone, Debug, Default)]
struct Part {
    /// Radiance that it gives off.
    glow: [f64; 3],
    /// Fraction that soaks up rain.
    porosity: Option<f64>,
    positions: Vec<[f64; 3]>,
    normals: Vec<[f64; 3]>,
    indices: Vec<u32>,
}

/// A model with its eye and its lamps.
#[derive(Clone, Debug)]
pub(super) struct Model {
    pub(super) name: &'static str,
    pub(super) of_night: bool,
    /// True if the rain has made all of it wet.
    pub(super) is_wet: bool,
    pub(super) eye: [f64; 3],
    pub(super) at: [f64; 3],
    pub(super) fov_deg: f64,
    pub(super) lamps: Vec<([f64; 3], [f64; 3])>,
    parts: Vec<(Look, Part)>,
}

const ASPHALT: Look = Look([0.12, 0.12, 0.13], 0.0, 0.9);
const STONE: Look = Look([0.45, 0.42, 0.38], 0.0, 0.95);
const PLASTER: Look = Look([0.75, 0.72, 0.65], 0.0, 1.0);
const BRICK: Look = Look([0.5, 0.2, 0.13], 0.0, 0.9);
const GREEN: Look = Look([0.15, 0.4, 0.2], 0.0, 0.9);
const BLUE: Look = Look([0.15, 0.25, 0.55], 0.0, 0.8);
const WHITE: Look = Look([0.8, 0.8, 0.8], 0.0, 1.0);

/// All models.
pub(super) fn all() -> Vec<Model> {
    let dry =
        [street("street", false), shed(), arcade(), spheres(), courtyard(), street("lamps", true), hall()];
    let wet = [sign("wet-sign-porous", 1.0, 0.85), sign("wet-sign-smooth", 0.0, 0.5)];
    dry.into_iter().chain(wet).collect()
}

/// A sign, 1 m x 0.5 m, 0.3 m over level wet ground and 4 m from the eye. The ground throws back red only, the sky is gray
/// and the sign has no green: blue less green is what the film mirrors of the sign, sample by sample.
fn sign(name: &'static str, porosity: f64, roughness: f64) -> Model {
    let mut model = Model::new(name, [0.0, 1.5, 4.0], [0.0, 0.1, 0.0], 46.0);
    model.is_wet = true;
    model.cuboid(Look([0.2, 0.0, 0.0], 0.0, roughness), [-30.0, -1.0, -30.0], [30.0, 0.0, 30.0]);
    model.last().porosity = Some(porosity);
    // To one side, so that a mirrored picture differs. A box without light keeps what is behind it dark; it is thin, as our ground stays
    // dry below it.
    let black = Look([0.0; 3], 0.0, 1.0);
    model.cuboid(black, [-1.3, 0.3, -0.012], [-0.3, 0.8, -0.002]);
    model.upright(black, [-1.3, 0.3], [-0.3, 0.8]);
    model.last().glow = [4.0, 0.0, 0.02];
    model
}

fn street(name: &'static str, of_night: bool) -> Model {
    let mut model = Model::new(name, [1.2, 1.7, 16.0], [-0.3, 2.6, -10.0], 55.0);
    model.of_night = of_night;
    model.cuboid(ASPHALT, [-60.0, -1.0, -80.0], [60.0, 0.0, 60.0]);
    for (k, look) in [PLASTER, BRICK, STONE, BLUE, PLASTER, GREEN, BRICK].into_iter().enumerate() {
        let z = 14.0 - 9.0 * k as f64;
        let height = [8.0, 11.0, 9.0, 13.0][k % 4];
        model.cuboid(look, [-14.0, -0.5, z - 8.5], [-6.0, height, z]);
        let height = [10.0, 7.0, 12.0][k % 3];
        let other = [STONE, GREEN, PLASTER, BRICK][k % 4];
        model.cuboid(other, [6.0, -0.5, z - 8.7], [14.0, height, z]);
    }
    model.cuboid(STONE, [-6.0, -0.5, -60.0], [-4.4, 0.15, 20.0]);
    model.cuboid(STONE, [4.4, -0.5, -60.0], [6.0, 0.15, 20.0]);
    // Objects: a van, a kiosk, a bench.
    model.cuboid(WHITE, [2.0, 0.35, -2.0], [3.9, 2.2, 2.4]);
    model.cuboid(GREEN, [-4.2, 0.0, 4.0], [-3.0, 2.4, 5.2]);
    model.cuboid(BRICK, [-3.9, 0.4, -6.0], [-3.3, 0.5, -3.8]);
    let warm = [60.0, 45.0, 25.0];
    model.lamps = vec![
        ([3.7, 4.6, 6.0], warm),
        ([-3.7, 4.6, -3.0], warm),
        ([3.7, 4.6, -13.0], warm),
        ([-5.0, 2.2, 9.0], [8.0, 12.0, 20.0]),
    ];
    model
}

fn shed() -> Model {
    let mut model = Model::new("shed", [2.4, 1.6, 1.6], [-1.2, 1.1, -4.0], 62.0);
    model.cuboid(STONE, [-40.0, -1.0, -40.0], [40.0, 0.0, 40.0]);
    model.cuboid(WHITE, [-3.2, 0.0, -5.0], [-3.0, 3.0, 2.0]);
    model.cuboid(BRICK, [3.0, 0.0, -5.0], [3.2, 3.0, 2.0]);
    model.cuboid(PLASTER, [-3.2, 0.0, -5.2], [3.2, 3.0, -5.0]);
    model.cuboid(WHITE, [-3.4, 3.0, -5.4], [3.4, 3.2, 2.2]);
    model.cuboid(BLUE, [-2.4, 0.0, -4.4], [-1.2, 0.9, -3.2]);
    model.cuboid(GREEN, [0.9, 0.0, -4.6], [2.2, 1.7, -3.9]);
    model.sphere(Look([0.9, 0.75, 0.4], 1.0, 0.3), [-0.1, 0.5, -2.9], 0.5);
    model
}

fn arcade() -> Model {
    let mut model = Model::new("arcade", [-1.0, 1.7, 9.0], [0.6, 1.9, -4.0], 58.0);
    model.cuboid(STONE, [-50.0, -1.0, -50.0], [50.0, 0.0, 50.0]);
    model.cuboid(PLASTER, [-3.4, 0.0, -20.0], [-3.0, 5.0, 14.0]);
    model.cuboid(PLASTER, [-3.4, 4.0, -20.0], [1.6, 4.6, 14.0]);
    for k in 0..8 {
        let z = 11.0 - 4.0 * f64::from(k);
        model.cuboid(PLASTER, [0.9, 0.0, z - 0.7], [1.6, 4.0, z]);
    }
    model.cuboid(BRICK, [10.0, 0.0, -30.0], [12.0, 9.0, 20.0]);
    model.cuboid(GREEN, [-2.6, 0.0, 2.0], [-1.9, 0.8, 3.0]);
    model
}

fn spheres() -> Model {
    let mut model = Model::new("spheres", [0.0, 2.0, 7.5], [0.0, 0.75, 0.0], 42.0);
    model.cuboid(STONE, [-30.0, -1.0, -30.0], [30.0, 0.0, 30.0]);
    for (k, look) in [
        Look([0.95, 0.93, 0.88], 1.0, 0.0),
        Look([1.0, 0.77, 0.34], 1.0, 0.2),
        Look([0.9, 0.9, 0.92], 1.0, 0.45),
        Look([0.6, 0.08, 0.06], 0.0, 0.05),
        Look([0.1, 0.3, 0.5], 0.0, 0.3),
        Look([0.8, 0.8, 0.8], 0.0, 0.6),
    ]
    .into_iter()
    .enumerate()
    {
        let x = -3.1 + 1.24 * k as f64;
        model.sphere(look, [x, 0.6, if k % 2 == 0 { 0.0 } else { 0.9 }], 0.6);
    }
    model.cuboid(BRICK, [-4.0, 0.0, -2.6], [0.5, 1.6, -2.2]);
    model.cuboid(Look([0.9, 0.9, 0.9], 0.0, 0.1), [1.0, 0.0, -2.8], [2.6, 1.2, -1.6]);
    model
}

fn courtyard() -> Model {
    let mut model = Model::new("courtyard", [3.6, 1.7, 5.0], [-1.6, 1.9, -3.0], 60.0);
    model.cuboid(STONE, [-40.0, -1.0, -40.0], [40.0, 0.0, 40.0]);
    model.cuboid(PLASTER, [-6.0, 0.0, -8.0], [-5.0, 9.0, 8.0]);
    model.cuboid(BRICK, [5.0, 0.0, -8.0], [6.0, 9.0, 8.0]);
    model.cuboid(WHITE, [-6.0, 0.0, -7.0], [6.0, 9.0, -6.0]);
    model.cuboid(PLASTER, [-6.0, 0.0, 6.0], [6.0, 9.0, 7.0]);
    model.cuboid(GREEN, [-3.0, 0.0, -4.0], [-1.6, 0.7, -1.0]);
    model.cuboid(BLUE, [1.0, 0.0, -5.4], [2.2, 2.2, -4.4]);
    model.cuboid(Look([0.2, 0.2, 0.22], 0.0, 0.15), [-4.9, 0.01, 0.0], [0.0, 0.03, 4.0]);
    model
}

fn hall() -> Model {
    let mut model = Model::new("hall", [2.6, 1.6, 2.2], [-1.6, 1.2, -3.0], 62.0);
    model.of_night = true;
    model.cuboid(STONE, [-20.0, -1.0, -20.0], [20.0, 0.0, 20.0]);
    model.cuboid(WHITE, [-4.2, 0.0, -5.0], [-4.0, 3.4, 3.0]);
    model.cuboid(BRICK, [4.0, 0.0, -5.0], [4.2, 3.4, 3.0]);
    model.cuboid(PLASTER, [-4.2, 0.0, -5.2], [4.2, 3.4, -5.0]);
    model.cuboid(WHITE, [-4.4, 3.4, -5.4], [4.4, 3.6, 3.2]);
    model.cuboid(BLUE, [-2.8, 0.0, -3.6], [-1.6, 1.0, -2.4]);
    model.sphere(Look([0.95, 0.93, 0.9], 1.0, 0.05), [0.6, 0.7, -2.4], 0.7);
    model.lamps = vec![([1.5, 2.6, -1.0], [6.0, 5.0, 3.5]), ([-3.2, 1.4, -4.4], [0.7, 1.0, 2.0])];
    model
}

impl Model {
    fn new(name: &'static str, eye: [f64; 3], at: [f64; 3], fov_deg: f64) -> Self {
        Self { name, of_night: false, is_wet: false, eye, at, fov_deg, lamps: Vec::new(), parts: Vec::new() }
    }

    /// The part that was added last.
    fn last(&mut self) -> &mut Part {
        let last = self.parts.len() - 1;
        &mut self.parts[last].1
    }

    /// A rectangle in the plane z = 0, seen from +Z.
    fn upright(&mut self, look: Look, [left, low]: [f64; 2], [right, high]: [f64; 2]) {
        let positions = vec![[left, low, 0.0], [right, low, 0.0], [right, high, 0.0], [left, high, 0.0]];
        let normals = vec![[0.0, 0.0, 1.0]; 4];
        self.parts
            .push((look, Part { positions, normals, indices: vec![0, 1, 2, 0, 2, 3], ..Part::default() }));
    }

    fn cuboid(&mut self, look: Look, low: [f64; 3], high: [f64; 3]) {
        let mut part = Part::default();
        for face in 0..6 {
            let (axis, end) = (face % 3, face / 3);
            let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
            let first = part.positions.len() as u32;
            for (a, b) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                let mut position = [0.0; 3];
                position[axis] = if end == 0 { low[axis] } else { high[axis] };
                position[u] = if a == 0 { low[u] } else { high[u] };
                position[v] = if b == 0 { low[v] } else { high[v] };
                let mut normal = [0.0; 3];
                normal[axis] = if end == 0 { -1.0 } else { 1.0 };
                part.positions.push(position);
                part.normals.push(normal);
            }
            let order = if end == 0 { [0, 2, 1, 0, 3, 2] } else { [0, 1, 2, 0, 2, 3] };
            part.indices.extend(order.map(|k| first + k));
        }
        self.parts.push((look, part));
    }

    fn sphere(&mut self, look: Look, middle: [f64; 3], radius: f64) {
        const ROUND: u32 = 96;
        const DOWN: u32 = 48;
        let mut part = Part::default();
        for row in 0..=DOWN {
            let polar = std::f64::consts::PI * f64::from(row) / f64::from(DOWN);
            for column in 0..=ROUND {
                let turn = std::f64::consts::TAU * f64::from(column) / f64::from(ROUND);
                let normal =
                    [ops::sin(polar) * ops::cos(turn), ops::cos(polar), ops::sin(polar) * ops::sin(turn)];
                part.positions.push(std::array::from_fn(|k| middle[k] + radius * normal[k]));
                part.normals.push(normal);
            }
        }
        let at = |row: u32, column: u32| row * (ROUND + 1) + column;
        for row in 0..DOWN {
            for column in 0..ROUND {
                let [a, b] = [at(row, column), at(row, column + 1)];
                let [c, d] = [at(row + 1, column + 1), at(row + 1, column)];
                part.indices.extend([a, b, c, a, c, d]);
            }
        }
        self.parts.push((look, part));
    }

    /// Writes the model as a .gltf with its .bin.
    pub(super) fn write(&self, file: &Path) -> Result<(), String> {
        let mut bytes: Vec<u8> = Vec::new();
        let [mut views, mut accessors, mut meshes, mut nodes, mut materials] =
            std::array::from_fn(|_| Vec::<String>::new());
        for (k, (Look(base, metallic, roughness), part)) in self.parts.iter().enumerate() {
            let count = part.positions.len();
            for list in [&part.positions, &part.normals] {
                views.push(format!(
                    "{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{}}}",
                    bytes.len(),
                    12 * count
                ));
                bytes.extend(list.iter().flatten().flat_map(|&v| (v as f32).to_le_bytes()));
            }
            views.push(format!(
                "{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{}}}",
                bytes.len(),
                4 * part.indices.len()
            ));
            bytes.extend(part.indices.iter().flat_map(|i| i.to_le_bytes()));
            let bound = |pick: fn(f64, f64) -> f64, start: f64| -> [f64; 3] {
                std::array::from_fn(|axis| {
                    part.positions.iter().map(|position| f64::from(position[axis] as f32)).fold(start, pick)
                })
            };
            let (low, high) = (bound(f64::min, f64::INFINITY), bound(f64::max, f64::NEG_INFINITY));
            accessors.push(format!(
                "{{\"bufferView\":{},\"componentType\":5126,\"count\":{count},\"type\":\"VEC3\",\"min\":{low:?},\"max\":{high:?}}}",
                3 * k
            ));
            accessors.push(format!(
                "{{\"bufferView\":{},\"componentType\":5126,\"count\":{count},\"type\":\"VEC3\"}}",
                3 * k + 1
            ));
            accessors.push(format!(
                "{{\"bufferView\":{},\"componentType\":5125,\"count\":{},\"type\":\"SCALAR\"}}",
                3 * k + 2,
                part.indices.len()
            ));
            meshes.push(format!(
                "{{\"primitives\":[{{\"attributes\":{{\"POSITION\":{},\"NORMAL\":{}}},\"indices\":{},\"material\":{k}}}]}}",
                3 * k,
                3 * k + 1,
                3 * k + 2
            ));
            nodes.push(format!("{{\"mesh\":{k}}}"));
            let [r, g, b] = base;
            let mut material = format!(
                "{{\"pbrMetallicRoughness\":{{\"baseColorFactor\":[{r},{g},{b},1],\"metallicFactor\":{metallic},\"roughnessFactor\":{roughness}}}"
            );
            let strength = part.glow.into_iter().fold(0.0, f64::max);
            if strength > 0.0 {
                let color = part.glow.map(|c| c / strength);
                let _ = write!(
                    material,
                    ",\"emissiveFactor\":{color:?},\"extensions\":{{\"{STRENGTH}\":{{\"emissiveStrength\":{strength}}}}}"
                );
            }
            if let Some(porosity) = part.porosity {
                let _ = write!(material, ",\"extras\":{{\"porosity\":{porosity}}}");
            }
            materials.push(material + "}");
        }
        let binary = file.with_extension("bin");
        let uri = binary.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let mut text =
            format!("{{\"asset\":{{\"version\":\"2.0\"}},\"extensionsUsed\":[\"{STRENGTH}\"],\"scene\":0,");
        let all: Vec<String> = (0..nodes.len()).map(|k| k.to_string()).collect();
        let _ = write!(text, "\"scenes\":[{{\"nodes\":[{}]}}],", all.join(","));
        for (name, list) in [
            ("nodes", nodes),
            ("meshes", meshes),
            ("materials", materials),
            ("accessors", accessors),
            ("bufferViews", views),
        ] {
            let _ = write!(text, "\"{name}\":[{}],", list.join(","));
        }
        let _ = write!(text, "\"buffers\":[{{\"uri\":\"{uri}\",\"byteLength\":{}}}]}}", bytes.len());
        write(&binary, &bytes)?;
        write(file, text.as_bytes())
    }
}
