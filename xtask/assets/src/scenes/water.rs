//! Water on the carriageway: rain that stands in the hollows and in the low parts of the gutters.

use downpour_street::Street;

/// Distance beyond the curbs to which the maps of the ground reach, meters: a map's border lets water out, and the curb does not.
const BESIDE_M: f32 = 0.15;
/// Unevenness of old setts in addition to the model, mm: between good and average roads of ISO 8608.
const RELIEF_MM: f32 = 3.0;
/// Edges of the cells near the camera and far from it, mm: shores run between cells, and a map has a row of the scene's table for each.
const NEAR_MM: u32 = 40;
const FAR_MM: u32 = 100;

/// A part of the street with one map of its ground.
#[derive(Clone, Copy)]
pub(super) struct Reach {
    /// z of its ends, meters, the nearer one to z = 0 first. An end inside the street is moved to where no hollow is cut.
    ends_z: [f32; 2],
    cell_mm: u32,
}

/// A part near the camera.
pub(super) fn near(from_z: f32, to_z: f32) -> Reach {
    Reach { ends_z: [from_z, to_z], cell_mm: NEAR_MM }
}

/// A part far from the camera.
pub(super) fn far(from_z: f32, to_z: f32) -> Reach {
    Reach { ends_z: [from_z, to_z], cell_mm: FAR_MM }
}

/// The line across the street nearest to a z that is midway between two hollows: water is cut there at its shallowest.
fn between_hollows(street: &Street, z: f32) -> f32 {
    let hollows = street.hollows();
    let gaps = hollows.windows(2).map(|pair| (pair[0].center_m[1] + pair[1].center_m[1]) / 2.0);
    gaps.min_by(|a, b| (a - z).abs().total_cmp(&(b - z).abs())).unwrap_or(z)
}

/// Puddles that the rain fills, on parts of the street.
pub(super) fn water(street: &Street, parts: &[Reach]) -> String {
    let settings = street.settings();
    let width = settings.carriageway_m + 2.0 * BESIDE_M;
    let is_end = |z: f32| z >= 0.0 || z <= -settings.length_m;
    let cut = |z: f32| if is_end(z) { z } else { between_hollows(street, z) };
    let mut text = String::from("\n# What ten minutes of this rain have left in hollows and gutters.\n");
    for part in parts {
        let [from, to] = part.ends_z.map(cut);
        // The search reaches from below the gutters to the curbs, and not to the floors of parked cars.
        text += &format!(
            "[[puddle]]\nposition_m = [0, 0.05, {:.2}]\nsize_m = [{width:.2}, {:.2}]\nreach_m = 0.15\nfill = \"rain\"\n\
             relief_mm = {RELIEF_MM}\ncell_mm = {}\n\n",
            (from + to) / 2.0,
            from - to,
            part.cell_mm
        );
    }
    text.trim_end().to_owned() + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use downpour_street::StreetSettings;

    /// No hollow is cut by the end of a map inside the street.
    #[test]
    fn cuts_are_between_hollows() {
        let street = Street::generate(&StreetSettings::default()).expect("a street");
        for z in [-12.0, -30.0, -52.0] {
            let cut = between_hollows(&street, z);
            assert!((cut - z).abs() < 3.5, "{z} {cut}");
            for hollow in street.hollows() {
                assert!((hollow.center_m[1] - cut).abs() > hollow.radii_m[1], "{z} {cut} {hollow:?}");
            }
        }
    }
}
