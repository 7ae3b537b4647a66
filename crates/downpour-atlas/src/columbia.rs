//! The rain streak database of Columbia University as sets of an atlas.
//!
//! Source: K. Garg, S. K. Nayar, "Photorealistic rendering of rain streaks", 2006, and the database's page: drops of
//! 1.6 mm radius, exposed for 1/60 s, one period of their mode (2,0); the viewer 0 to 80 degrees above the horizon; the
//! light from -90 to 90 degrees of elevation and 10 to 170 degrees of azimuth, all in steps of 20; ten oscillations. Its
//! folders are
//!
//! > point_light_database/size{N}/dcam{EE}/cv{E}_v{V}_h{H}_osc{K}.png   (16 bits, gray, N columns)
//! > point_light_database/txt/dcam{EE}_point_max.txt                    (a brightness for each picture)
//!
//! with N of 4, 8, 16 or 32. For light from straight above or below there is one azimuth. A picture is scaled to its
//! maximum; the text file has lines `cvE`, `vV`, and `hH` with a number for each oscillation. Ambient light
//! (`env_light_database`) is not imported: refraction masks replace it.
//!
//! Conventions that the files do not define: pictures show a passage from top to bottom; a column is 133 mm (8 m/s
//! for 1/60 s) over 525 rows of 16 columns, so that half a picture is 1.27 radii; the side of the azimuths on which
//! streaks are brighter has the light behind the drop; brightness has no unit. Amplitudes are written as 0.
//!
//! Files are the caller's ([`ColumbiaFiles`]): this crate never sees one.

use downpour_drop::optics::WATER_INDEX;
use downpour_math::OutOfRange;
use downpour_math::ops::f64 as ops;
use half::f16;

use crate::AtlasError;
use crate::set::stored;
use crate::{StreakOptions, StreakOrigin, StreakOscillation, StreakSet, streak_frame};
use downpour_mask::file::shorten;

/// Elevations of the viewer in degrees.
pub const VIEWS: [i32; 5] = [0, 20, 40, 60, 80];
/// Elevations of the light in degrees.
pub const LIGHT_ELEVATIONS: [i32; 10] = [-90, -70, -50, -30, -10, 10, 30, 50, 70, 90];
/// Azimuths of the light in degrees.
pub const LIGHT_AZIMUTHS: [i32; 9] = [10, 30, 50, 70, 90, 110, 130, 150, 170];
/// Oscillations of each view and light.
pub const OSCILLATIONS: usize = 10;
/// Widths in columns.
pub const WIDTHS: [u32; 4] = [4, 8, 16, 32];

/// Radius of the drops, 1.6 mm.
const DIAMETER: f64 = 3.2e-3;
const HALF_EXTENT: f64 = 1.27;
/// Missing files that a message names.
const NAMED: usize = 5;
/// The highest picture that is taken.
const MAX_HEIGHT: u32 = 4096;

/// A grayscale picture of 16 bits, rows from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GrayPicture {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` values.
    pub values: Vec<u16>,
}

/// Source of the files of the database. Names are relative to its folder, with `/`.
pub trait ColumbiaFiles {
    /// Error of reading a file.
    type Error: From<AtlasError>;

    /// Reads a text file; `None` if it does not exist.
    ///
    /// # Errors
    /// If it is there and cannot be read.
    fn text(&mut self, name: &str) -> Result<Option<String>, Self::Error>;

    /// Reads a picture; `None` if it does not exist.
    ///
    /// # Errors
    /// If it is there and cannot be read.
    fn picture(&mut self, name: &str) -> Result<Option<GrayPicture>, Self::Error>;
}

/// Name of the picture of a viewer, a light and an oscillation.
#[must_use]
pub fn picture_name(width: u32, view: i32, elevation: i32, azimuth: i32, oscillation: usize) -> String {
    format!(
        "point_light_database/size{width}/dcam{view:02}/cv{view}_v{elevation}_h{azimuth}_osc{oscillation}.png"
    )
}

/// Name of the file of brightnesses of a view.
#[must_use]
pub fn brightness_name(view: i32) -> String {
    format!("point_light_database/txt/dcam{view:02}_point_max.txt")
}

/// Lights of the database: elevation and the azimuths at it.
fn lights() -> impl Iterator<Item = (i32, &'static [i32])> {
    LIGHT_ELEVATIONS.iter().flat_map(|&v| {
        let single: Vec<&[i32]> = if v.abs() == 90 {
            vec![&LIGHT_AZIMUTHS[..]]
        } else {
            LIGHT_AZIMUTHS.iter().map(std::slice::from_ref).collect()
        };
        single.into_iter().map(move |azimuths| (v, azimuths))
    })
}

/// Reads the database into one set for each oscillation; `rows` texels along each streak.
///
/// # Errors
/// [`AtlasError::Unreadable`] that names the first missing files and counts the others;
/// [`AtlasError::InFile`] if a picture or a list of brightnesses is not as described; what `files` says.
pub fn import<F: ColumbiaFiles>(files: &mut F, width: u32, rows: u32) -> Result<Vec<StreakSet>, F::Error> {
    if !WIDTHS.contains(&width) {
        let (quantity, found) = ("width of the database's pictures", f64::from(width));
        return Err(AtlasError::OutOfRange(OutOfRange {
            quantity,
            found,
            unit: "columns",
            allowed: "4, 8, 16 or 32".into(),
        })
        .into());
    }
    let options = StreakOptions {
        columns: width,
        rows,
        rays: 1,
        half_extent: HALF_EXTENT,
        light_radius: 0.5_f64.to_radians(),
        refractive_index: WATER_INDEX,
    };
    options.check()?;
    let mut missing = Vec::new();
    let mut texels: Vec<Vec<f16>> = vec![Vec::new(); OSCILLATIONS];
    // Brightness of small and of large azimuths.
    let mut sides = [0.0f64; 2];
    for view in VIEWS {
        let name = brightness_name(view);
        let Some(text) = files.text(&name)? else {
            missing.push(name);
            continue;
        };
        let brightness = Brightness::read(&name, &text)?;
        for (elevation, azimuths) in lights() {
            for (oscillation, out) in texels.iter_mut().enumerate() {
                let mut found = None;
                for &azimuth in azimuths {
                    let name = picture_name(width, view, elevation, azimuth, oscillation);
                    if let Some(picture) = files.picture(&name)? {
                        found = Some((azimuth, name, picture));
                        break;
                    }
                }
                let Some((azimuth, name, picture)) = found else {
                    missing.push(picture_name(width, view, elevation, azimuths[0], oscillation));
                    continue;
                };
                let factor = brightness.of(elevation, azimuth, oscillation)?;
                let streak = resampled(&name, &picture, width, rows)?;
                let sum: f64 = streak.iter().sum();
                if elevation.abs() == 10 && azimuth != 90 {
                    sides[usize::from(azimuth > 90)] += sum * factor;
                }
                out.extend(streak.iter().map(|v| stored((v * factor) as f32)));
            }
        }
    }
    if let Some(first) = missing.first() {
        let shown = missing.iter().take(NAMED).skip(1).map(String::as_str).collect::<Vec<_>>().join(", ");
        let reason = match missing.len() {
            1 => "is missing from the database".to_owned(),
            n if n <= NAMED => format!("is missing from the database, and {shown}"),
            n => format!("is missing from the database, and {shown} and {} more", n - NAMED),
        };
        return Err(AtlasError::Unreadable { path: first.clone(), reason }.into());
    }
    let small_is_behind = sides[0] > sides[1];
    let directions: Vec<Vec<[f64; 3]>> =
        VIEWS.iter().map(|&view| view_lights(view, small_is_behind)).collect();
    let elevations: Vec<f64> = VIEWS.iter().map(|&view| f64::from(view).to_radians()).collect();
    let sets = texels.into_iter().enumerate().map(|(k, texels)| {
        let set = StreakSet {
            origin: StreakOrigin::Columbia,
            diameter: DIAMETER,
            oscillation: StreakOscillation {
                phase: k as f64 / OSCILLATIONS as f64,
                ..StreakOscillation::NONE
            },
            options,
            elevations: elevations.clone(),
            directions: directions.clone(),
            texels,
            amounts: Vec::new(),
        };
        set.check()?;
        Ok(set)
    });
    sets.collect::<Result<Vec<_>, AtlasError>>().map_err(F::Error::from)
}

/// The lights of a view in the frame of its streaks.
fn view_lights(view: i32, small_is_behind: bool) -> Vec<[f64; 3]> {
    let frame = streak_frame(f64::from(view).to_radians());
    let behind = if small_is_behind { -1.0 } else { 1.0 };
    lights()
        .map(|(elevation, azimuths)| {
            let (v, h) = (f64::from(elevation).to_radians(), f64::from(azimuths[0]).to_radians());
            let level = if elevation.abs() == 90 { 0.0 } else { ops::cos(v) };
            let light = [level * ops::sin(h), ops::sin(v), behind * level * ops::cos(h)];
            frame.map(|axis| axis[0] * light[0] + axis[1] * light[1] + axis[2] * light[2])
        })
        .collect()
}

/// Brightnesses of the pictures of a view.
struct Brightness<'a> {
    name: &'a str,
    rows: Vec<(i32, i32, Vec<f64>)>,
}

impl<'a> Brightness<'a> {
    fn read(name: &'a str, text: &str) -> Result<Self, AtlasError> {
        const ALLOWED: &str = "lines cvE, vV, and hH with ten numbers of 0 or more";
        let mut elevation = None;
        let mut rows = Vec::new();
        for line in text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with("cv")) {
            let wrong = || wrong(name, "line", shorten(line), ALLOWED);
            if let Some(number) = line.strip_prefix('v') {
                elevation = Some(number.trim().parse::<i32>().map_err(|_| wrong())?);
                continue;
            }
            let mut words = line.strip_prefix('h').ok_or_else(wrong)?.split_whitespace();
            let azimuth = words.next().and_then(|word| word.parse::<i32>().ok()).ok_or_else(wrong)?;
            let numbers: Option<Vec<f64>> =
                words.map(|word| word.parse::<f64>().ok().filter(|v| (0.0..=1.0e4).contains(v))).collect();
            let numbers = numbers.filter(|n| n.len() == OSCILLATIONS).ok_or_else(wrong)?;
            rows.push((elevation.ok_or_else(wrong)?, azimuth, numbers));
        }
        Ok(Self { name, rows })
    }

    fn of(&self, elevation: i32, azimuth: i32, oscillation: usize) -> Result<f64, AtlasError> {
        let row = self.rows.iter().find(|(v, h, _)| (*v, *h) == (elevation, azimuth));
        row.and_then(|(_, _, numbers)| numbers.get(oscillation)).copied().ok_or_else(|| {
            let found = format!("no brightness for v{elevation} h{azimuth}");
            wrong(self.name, "lines", found, "a brightness for each picture")
        })
    }
}

fn wrong(name: &str, location: &'static str, found: String, allowed: &'static str) -> AtlasError {
    AtlasError::File { location, found, allowed }.in_file(name.as_ref())
}

/// Picture resampled to `rows` rows, each the mean of the rows it covers; 1 is the brightest value.
fn resampled(name: &str, picture: &GrayPicture, width: u32, rows: u32) -> Result<Vec<f64>, AtlasError> {
    let GrayPicture { width: found, height, values } = picture;
    let whole = values.len() == *found as usize * *height as usize;
    if *found != width || !(1..=MAX_HEIGHT).contains(height) || !whole {
        let found = format!("{found} x {height} pixels");
        return Err(wrong(name, "size", found, "as many columns as the folder says, 1 to 4096 rows"));
    }
    let columns = width as usize;
    let scale = f64::from(*height) / f64::from(rows);
    let mut out = Vec::with_capacity(rows as usize * columns);
    for row in 0..rows {
        let (from, to) = (f64::from(row) * scale, f64::from(row + 1) * scale);
        let last = (to.ceil() as u32).min(*height);
        let mut sums = vec![0.0; columns];
        for source in from as u32..last {
            let fraction = (to.min(f64::from(source + 1)) - from.max(f64::from(source))).max(0.0) / scale;
            let start = source as usize * columns;
            for (sum, &value) in sums.iter_mut().zip(&values[start..start + columns]) {
                *sum += fraction * f64::from(value) / 65535.0;
            }
        }
        out.extend(sums);
    }
    Ok(out)
}
