//! The weather files: one street, one rain, four volumes in front of the camera.

use std::fmt::Write as _;

/// Side of the box of Tariq's model, m.
const BOX_M: f64 = 10.0;

/// Radius and height of the cylinder of Creus and Patow's model, m: the same volume as the box.
const CYLINDER_M: [f64; 2] = [5.642, 10.0];

/// Drops farther than this are not drawn, m. Theirs are 50 m away with streaks as large as the artist likes; a drop as
/// large as a drop is less than a pixel there.
pub(super) const FAR_M: f64 = 9.0;

/// Median volume diameter, mm, and shape of the gamma law: nearly all drops are visible up to [`FAR_M`].
pub(super) const MEDIAN_MM: f64 = 3.0;
pub(super) const SHAPE: f64 = 8.0;

/// A method to keep the rain in front of the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Model {
    ImSung,
    Tariq,
    CreusPatow,
    View,
}

impl Model {
    /// In the order of the paper's figure 6, ours last.
    pub(super) const ALL: [Self; 4] = [Self::ImSung, Self::Tariq, Self::CreusPatow, Self::View];

    /// Name in `rain.volume`.
    pub(super) fn key(self) -> &'static str {
        match self {
            Self::ImSung => "im-sung-2022",
            Self::Tariq => "tariq-2007",
            Self::CreusPatow => "creus-patow-2013",
            Self::View => "view",
        }
    }

    /// Title in the tables.
    pub(super) fn title(self) -> &'static str {
        match self {
            Self::ImSung => "Im & Sung 2022",
            Self::Tariq => "Tariq 2007",
            Self::CreusPatow => "Creus & Patow 2013",
            Self::View => "ours (view)",
        }
    }
}

/// Rain of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rain {
    pub(super) model: Model,
    pub(super) rate_mm_h: f64,
    pub(super) max_drops: u32,
    /// `None`: that of the camera's file.
    pub(super) fov_deg: Option<f64>,
}

/// The weather of a run. `scene` is the file of street and camera.
pub(super) fn text(rain: &Rain, scene: &str) -> String {
    let Rain { model, rate_mm_h, max_drops, fov_deg } = *rain;
    let mut text = format!(
        "[[model]]\nfile = \"{scene}\"\n\n[rain]\nrate_mm_h = {rate_mm_h}\ndistribution = \"gamma\"\n\
         gamma_shape = {SHAPE}\nmedian_diameter_mm = {MEDIAN_MM}\nseed = 6\nvolume = \"{}\"\nmax_drops = {max_drops}\n",
        model.key(),
    );
    let [radius, height] = CYLINDER_M;
    match model {
        Model::Tariq => text += &format!("box_m = {BOX_M}\n"),
        Model::CreusPatow => text += &format!("cylinder = {{ radius_m = {radius}, height_m = {height} }}\n"),
        Model::ImSung | Model::View => {}
    }
    text += &format!(
        "\n[sky]\nzenith_color = [2300, 2450, 2650]\n\n[camera]\nfar_m = {FAR_M}\nshutter_s = 0\nexposure_ev = 0.4\n"
    );
    if let Some(fov_deg) = fov_deg {
        let _ = writeln!(text, "fov_deg = {fov_deg}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_go_with_their_model() {
        for model in Model::ALL {
            let rain = Rain { model, rate_mm_h: 60.0, max_drops: 10_000, fov_deg: None };
            let text = text(&rain, "street.gltf");
            assert!(text.contains(&format!("volume = \"{}\"\n", model.key())), "{text}");
            assert_eq!(text.contains("box_m"), model == Model::Tariq);
            assert_eq!(text.contains("cylinder"), model == Model::CreusPatow);
            assert!(!text.contains("fov_deg"));
        }
        let rain = Rain { model: Model::View, rate_mm_h: 60.0, max_drops: 10, fov_deg: Some(12.0) };
        assert!(
            text(&rain, "street.gltf")
                .contains("[camera]\nfar_m = 9\nshutter_s = 0\nexposure_ev = 0.4\nfov_deg = 12\n")
        );
    }

    /// The two models with a fixed volume have the same volume.
    #[test]
    fn box_and_cylinder_hold_as_much() {
        let [radius, height] = CYLINDER_M;
        let cylinder = std::f64::consts::PI * radius * radius * height;
        assert!((cylinder / (BOX_M * BOX_M * BOX_M) - 1.0).abs() < 1.0e-3, "{cylinder}");
    }
}
