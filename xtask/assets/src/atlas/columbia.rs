//! The Columbia database from its folder. Its pictures go through the guarded reader of `downpour-scene`.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use downpour_atlas::AtlasError;
use downpour_atlas::columbia::{ColumbiaFiles, GrayPicture, import};
use downpour_atlas::write_streaks;
use downpour_scene::Budget;
use downpour_scene::picture::decode_gray16;

use crate::files;

/// Texels along a streak.
const ROWS: u32 = 64;
/// The largest file that is read, in bytes: the database's have 70 kB.
const MAX_FILE_BYTES: u64 = 4 << 20;

/// Error as text.
#[derive(Debug)]
struct TextError(String);

impl From<AtlasError> for TextError {
    fn from(error: AtlasError) -> Self {
        Self(error.to_string())
    }
}

struct Database {
    folder: PathBuf,
}

impl Database {
    fn bytes(&self, name: &str) -> Result<Option<Vec<u8>>, TextError> {
        let path = self.folder.join(name);
        let to_error = |error: std::io::Error| TextError(format!("{}: {error}", path.display()));
        let about = match std::fs::metadata(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            about => about.map_err(to_error)?,
        };
        if !about.is_file() || about.len() > MAX_FILE_BYTES {
            return Err(TextError(format!("{}: no file of at most 4 MiB", path.display())));
        }
        std::fs::read(&path).map(Some).map_err(to_error)
    }
}

impl ColumbiaFiles for Database {
    type Error = TextError;

    fn text(&mut self, name: &str) -> Result<Option<String>, TextError> {
        let Some(bytes) = self.bytes(name)? else { return Ok(None) };
        String::from_utf8(bytes).map(Some).map_err(|error| TextError(format!("{name}: {error}")))
    }

    fn picture(&mut self, name: &str) -> Result<Option<GrayPicture>, TextError> {
        let Some(bytes) = self.bytes(name)? else { return Ok(None) };
        let gray =
            decode_gray16(name, &bytes, &mut Budget::default()).map_err(|e| TextError(e.to_string()))?;
        Ok(Some(GrayPicture { width: gray.width, height: gray.height, values: gray.values }))
    }
}

/// Writes `columbia_{K}.ktx2` of the pictures of this width for each oscillation K.
pub(super) fn run(folder: &Path, width: &str, output: &Path) -> Result<(), String> {
    let columns = width.parse().map_err(|_| format!("width {width}: 4, 8, 16 or 32 columns are allowed"))?;
    if !folder.is_dir() {
        return Err(format!("{}: no folder", folder.display()));
    }
    let sets =
        import(&mut Database { folder: folder.to_owned() }, columns, ROWS).map_err(|TextError(t)| t)?;
    std::fs::create_dir_all(output).map_err(|error| format!("{}: {error}", output.display()))?;
    for (k, set) in sets.iter().enumerate() {
        let bytes = write_streaks(set).map_err(|error| error.to_string())?;
        files::publish(output, &format!("columbia_{k}.ktx2"), &bytes)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use downpour_atlas::StreakAtlas;
    use downpour_atlas::columbia::{
        LIGHT_AZIMUTHS, LIGHT_ELEVATIONS, OSCILLATIONS, VIEWS, brightness_name, picture_name,
    };
    use image::{ImageBuffer, Luma};

    /// A folder of the database's layout, its pictures of 4 columns.
    fn generate(folder: &Path) {
        let texts = folder.join("point_light_database/txt");
        std::fs::create_dir_all(&texts).expect("a folder");
        for (view, height) in VIEWS.into_iter().zip([40, 38, 30, 20, 8]) {
            std::fs::create_dir_all(folder.join(format!("point_light_database/size4/dcam{view:02}")))
                .expect("a folder");
            let picture =
                ImageBuffer::from_fn(4, height, |x, _| Luma([if x == 1 { 65535u16 } else { 1000 }]));
            let mut png = std::io::Cursor::new(Vec::new());
            picture.write_to(&mut png, image::ImageFormat::Png).expect("a PNG");
            let mut text = format!("cv{view}\n");
            for v in LIGHT_ELEVATIONS {
                text += &format!("v{v}\n");
                for h in LIGHT_AZIMUTHS.into_iter().filter(|&h| v.abs() != 90 || h == 170) {
                    text += &format!("h{h} {}\n", ["0.25"; OSCILLATIONS].join(" "));
                    for k in 0..OSCILLATIONS {
                        std::fs::write(folder.join(picture_name(4, view, v, h, k)), png.get_ref())
                            .expect("a picture");
                    }
                }
            }
            std::fs::write(folder.join(brightness_name(view)), text).expect("a text");
        }
    }

    #[test]
    fn a_folder_of_the_database_becomes_an_atlas() {
        let from = tempfile::tempdir().expect("a folder");
        let to = tempfile::tempdir().expect("a folder");
        generate(from.path());
        super::run(from.path(), "4", to.path()).expect("an atlas");
        let atlas = StreakAtlas::load(to.path()).expect("an atlas");
        assert_eq!(atlas.data().frame.counts, [1, 10, 5, 74]);
        // Sixteen bits are preserved: 1000 of 65535 would be 4 of 255.
        let layer = atlas.sets()[0].layer(0, 0).expect("a layer");
        assert!((layer[1].to_f32() - 0.25).abs() < 1.0e-4);
        assert!((layer[0].to_f32() - 0.25 * 1000.0 / 65535.0).abs() < 1.0e-6, "{}", layer[0]);

        let gone = picture_name(4, 20, -30, 50, 2);
        std::fs::remove_file(from.path().join(&gone)).expect("it was there");
        let message = super::run(from.path(), "4", to.path()).expect_err("a picture is missing");
        assert_eq!(message, format!("{gone}: is missing from the database"));
        std::fs::write(from.path().join(&gone), b"no picture").expect("a file");
        let message = super::run(from.path(), "4", to.path()).expect_err("a picture is damaged");
        assert!(message.contains(&gone), "{message}");
        let message = super::run(from.path(), "16", to.path()).expect_err("no pictures of this width");
        assert!(message.contains("size16") && message.contains("more"), "{message}");
        assert!(super::run(from.path(), "x", to.path()).expect_err("no number").contains("4, 8, 16 or 32"));
        assert!(super::run(&from.path().join("a"), "4", to.path()).expect_err("none").contains("no folder"));
    }
}
