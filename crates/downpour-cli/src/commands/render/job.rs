//! Parameters of the frames of a clip: two runs with the same job render the same frames, bit for bit.

use std::fmt::{self, Write as _};

use downpour::atlas::StreakAtlas;
use downpour::scene::picture::Pixels;
use downpour::trace::frame_scene::FrameScene;
use downpour::weather::{Loaded, Weather};
use sha2::{Digest as _, Sha256};

/// Names and values, in a fixed order. Values are text, so that no number is rounded by a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Job(pub(super) Vec<(&'static str, String)>);

/// The digest of bytes, in hexadecimal digits.
pub(super) fn digest(bytes: &[u8]) -> String {
    hexadecimal(Sha256::new_with_prefix(bytes))
}

/// The digest of a streak atlas.
pub(super) fn atlas_digest(atlas: &StreakAtlas) -> String {
    let data = atlas.data();
    let mut sum = Sha256::new();
    sum.update(bytemuck::bytes_of(data.frame));
    sum.update(bytemuck::cast_slice::<_, u8>(data.triangles));
    sum.update(bytemuck::cast_slice::<_, u8>(data.texels));
    sum.update(bytemuck::cast_slice::<_, u8>(data.amounts));
    hexadecimal(sum)
}

/// Digest of a scene: its buffers and its camera at the first frame, the weather, and the
/// animations of the scene.
pub(super) fn scene_digest(weather: &Weather, loaded: &Loaded, first: &FrameScene) -> String {
    let mut sum = Sha256::new();
    let data = &first.data;
    let buffers: [&[u8]; 6] = [
        bytemuck::cast_slice(&data.nodes),
        bytemuck::cast_slice(&data.triangles),
        bytemuck::cast_slice(&data.corners),
        bytemuck::cast_slice(&data.table),
        bytemuck::cast_slice(&data.texels),
        bytemuck::cast_slice(&data.sky),
    ];
    for buffer in buffers {
        sum.update((buffer.len() as u64).to_le_bytes());
        sum.update(buffer);
    }
    for mask in &loaded.masks {
        let bytes: &[u8] = match mask.as_ref().map(|mask| &mask.pixels) {
            Some(Pixels::Rgba8(pixels)) => bytemuck::cast_slice(pixels),
            Some(Pixels::RgbaF32(pixels)) => bytemuck::cast_slice(pixels),
            None => &[],
        };
        sum.update((bytes.len() as u64).to_le_bytes());
        sum.update(bytes);
    }
    let rest = (data.slots, data.lights, data.light_count, data.sky_levels, data.sky_irradiance);
    let mut text = Text(sum);
    // The name of the file in messages is not part of the scene.
    let weather = Weather { name: String::new(), ..weather.clone() };
    // Formatting does not fail, and neither does the digest.
    let _ = write!(text, "{rest:?} {:?} {:?} {weather:?}", first.viewpoint, (first.origin, first.depth));
    if let Some(model) = &loaded.drop_model {
        let _ = write!(text, "{:?} {:?} {:?}", model.positions, model.normals, model.indices);
    }
    if loaded.is_animated() {
        let scene = &loaded.scene;
        let _ = write!(text, "{:?} {:?} {:?}", loaded.animations, scene.animations, scene.nodes);
        let _ = write!(text, "{:?} {:?} {:?}", scene.skins, scene.meshes, scene.roots);
    }
    hexadecimal(text.0)
}

/// Text that is digested as it is written.
struct Text(Sha256);

impl fmt::Write for Text {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.update(text.as_bytes());
        Ok(())
    }
}

fn hexadecimal(sum: Sha256) -> String {
    sum.finalize().iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}
