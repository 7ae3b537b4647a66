//! Rain and surfaces with holes: alpha says where a roof is.

use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};
use downpour_shaders::render::scene::{SCENE_BLENDED, SCENE_MASKED};
use downpour_sim::collision::{CollisionMap, CollisionOptions};
use downpour_sim::field::RainField;
use downpour_sim::shelter::Obstacles;
use downpour_sim::view::View;
use downpour_trace::builder::{MeshPart, SceneBuilder};
use downpour_trace::data::SceneData;
use downpour_trace::material::{MaterialLook, TextureUse};
use downpour_trace::puddle::{Ground, PuddleMap};
use downpour_trace::sky_light::SkyLight;
use glam::{Affine3A, DVec3, Vec2, Vec3};

/// Ground, and a roof from -2 to 2 m at a height of 3 m, of some alpha where x < 0 and of another where x > 0.
fn roofed(flags: u32, alphas: [u8; 2]) -> SceneData {
    let mut builder = SceneBuilder::new();
    let ground = builder.add_material(MaterialLook::default());
    let texels: Vec<[u8; 4]> = (0..64).map(|i| [255, 255, 255, alphas[i % 8 / 4]]).collect();
    let texture = builder.texture(8, 8, &texels, TextureUse::Color);
    let texture = builder.add_slot(texture);
    let maps = [Some(texture), None, None, None, None, None, None, None];
    let roof = builder.add_material(MaterialLook { flags, maps, ..MaterialLook::default() });
    let corners = [(-1.0f32, -1.0f32), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    for (material, height, half) in [(ground, 0.0, 4.0), (roof, 3.0, 2.0)] {
        let positions = corners.map(|(x, z)| [x * half, height, z * half]);
        let uvs = corners.map(|(x, z)| [0.5 + 0.5 * x, 0.5 + 0.5 * z]);
        let part = MeshPart {
            uvs: [Some(&uvs), None],
            ..MeshPart::plain(&positions, &[0, 2, 1, 0, 3, 2], material)
        };
        builder.add_mesh(&part, &Affine3A::IDENTITY);
    }
    builder.build(&SkyLight::uniform([1.0; 3]))
}

/// Roofs by their alpha, and whether each half lets the rain through: masked by glTF's cutoff of 0.5; blended only where
/// nothing is seen of it, for a pane of glass is a roof.
const ROOFS: [(u32, [u8; 2], [bool; 2]); 5] = [
    (SCENE_MASKED, [0, 255], [true, false]),
    (SCENE_MASKED, [100, 160], [true, false]),
    (SCENE_BLENDED, [0, 255], [true, false]),
    (SCENE_BLENDED, [0, 128], [true, false]),
    (0, [0, 255], [false, false]),
];

/// Positions under both halves, away from their edges.
fn under(half: usize) -> Vec3 {
    Vec3::new([-1.2, 1.2][half], 1.0, 0.3)
}

#[test]
fn rain_falls_through_what_alpha_leaves_out() -> Result<(), Box<dyn std::error::Error>> {
    let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 50.0)?;
    let field = RainField::new(&rain, 4)?;
    let view = View { eye: DVec3::new(0.0, 1.5, 4.0), far: 8.0, ..View::default() };
    let all = field.visible(&view, 2.0)?.drops;
    for (flags, alphas, open) in ROOFS {
        let scene = roofed(flags, alphas);
        let obstacles = Obstacles {
            nodes: &scene.nodes,
            triangles: &scene.triangles,
            holes: Some(&scene),
            origin: DVec3::ZERO,
        };
        let fallen = field.visible_among(&obstacles, &view, 2.0)?.drops;
        let options = CollisionOptions { size: [8.0; 2], texels: [64; 2], ..CollisionOptions::default() };
        let map = CollisionMap::from_arrays(&options, &scene.nodes, &scene.triangles, Some(&scene))?;
        let ground = Ground { middle: Vec3::ZERO, size: Vec2::splat(3.8), turn: 0.0, reach: 0.5 };
        let puddle = PuddleMap::painted(&scene, &ground, [2, 2], &[0.01; 4]);
        for half in 0..2 {
            let name = format!("{flags}, {alphas:?}, half {half}");
            let within = |position: DVec3| {
                let side = position.x * [-1.0, 1.0][half];
                (0.3..1.7).contains(&side) && position.z.abs() < 1.9 && (0.05..2.9).contains(&position.y)
            };
            let count = |drops: &[downpour_sim::field::FallingDrop]| {
                drops.iter().filter(|drop| within(drop.position)).count()
            };
            let whole = count(&all);
            assert!(whole > 50, "{name}: {whole}");
            assert_eq!(count(&fallen), if open[half] { whole } else { 0 }, "{name}: drops");
            assert_eq!(map.open(under(half)), open[half], "{name}: map");
            // Cells run along x first.
            assert_eq!(puddle.cells[half][3] > 0.5, open[half], "{name}: puddle");
        }
    }
    Ok(())
}
