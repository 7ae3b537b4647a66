//! The importer of the streak database, on a database of the same names made here.

use std::collections::BTreeMap;

use downpour_atlas::AtlasError;
use downpour_atlas::columbia::{
    ColumbiaFiles, GrayPicture, LIGHT_AZIMUTHS, LIGHT_ELEVATIONS, OSCILLATIONS, VIEWS, brightness_name,
    import, picture_name,
};
use downpour_atlas::{StreakAtlas, StreakOrigin, read_streaks, write_streaks};

#[derive(Default)]
struct Database {
    texts: BTreeMap<String, String>,
    pictures: BTreeMap<String, GrayPicture>,
}

impl ColumbiaFiles for Database {
    type Error = AtlasError;

    fn text(&mut self, name: &str) -> Result<Option<String>, AtlasError> {
        Ok(self.texts.get(name).cloned())
    }

    fn picture(&mut self, name: &str) -> Result<Option<GrayPicture>, AtlasError> {
        Ok(self.pictures.get(name).cloned())
    }
}

/// Pictures of 4 columns, lower for a higher viewer; the upper half has the brightest value, the lower none. Streaks
/// are brighter for small azimuths.
fn database() -> Database {
    let mut made = Database::default();
    for (view, height) in VIEWS.into_iter().zip([131, 123, 101, 68, 27]) {
        let mut text = format!("cv{view}\n");
        for v in LIGHT_ELEVATIONS {
            text += &format!("v{v}\n");
            for h in LIGHT_AZIMUTHS {
                let only = v.abs() != 90 || h == 170;
                if !only {
                    continue;
                }
                text += &format!("h{h}");
                for k in 0..OSCILLATIONS {
                    text += &format!(" {}", f64::from(200 - h) / 1000.0 + k as f64 * 1.0e-3);
                    let values =
                        (0..height * 4).map(|i| if i / 4 < height / 2 { 65535 } else { 0 }).collect();
                    let picture = GrayPicture { width: 4, height, values };
                    made.pictures.insert(picture_name(4, view, v, h, k), picture);
                }
                text += " \n";
            }
        }
        made.texts.insert(brightness_name(view), text);
    }
    made
}

#[test]
fn names_are_those_of_the_database() {
    assert_eq!(picture_name(16, 0, -10, 30, 7), "point_light_database/size16/dcam00/cv0_v-10_h30_osc7.png");
    assert_eq!(brightness_name(20), "point_light_database/txt/dcam20_point_max.txt");
}

#[test]
fn a_whole_database_becomes_an_atlas() {
    let sets = import(&mut database(), 4, 16).unwrap();
    assert_eq!(sets.len(), OSCILLATIONS);
    let set = &sets[3];
    assert_eq!((set.origin, set.layers()), (StreakOrigin::Columbia, 5 * 74));
    assert!((set.diameter - 3.2e-3).abs() < 1.0e-12);
    // View 0, the light at v = -70 (the second elevation: layer 0 is the one below), h = 50.
    let layer = set.layer(0, 1 + 2).unwrap();
    let factor = 0.150 + 0.003;
    assert!((layer[0].to_f32() - factor).abs() < 1.0e-3);
    assert_eq!(layer[15 * 4].to_f32(), 0.0);
    // 131 rows on 16: the edge, at 65 rows, is in row 7.
    let edge = layer[7 * 4].to_f32() / factor;
    assert!((edge - (65.0 * 16.0 / 131.0 - 7.0)).abs() < 2.0e-3, "{edge}");
    // Small azimuths are brighter, so the light is behind the drop there.
    let direction = set.directions[0][1 + 2];
    let (v, h) = (-70.0f64.to_radians(), 50.0f64.to_radians());
    let cos = downpour_math::ops::f64::cos;
    let sin = downpour_math::ops::f64::sin;
    let law = [cos(v) * sin(h), sin(v), -cos(v) * cos(h)];
    assert!(direction.iter().zip(law).all(|(a, b)| (a - b).abs() < 1.0e-12), "{direction:?} {law:?}");
    // Seen from 60 degrees above, the light straight above is toward the viewer.
    let above = set.directions[3][73];
    assert!((above[2] - sin(60.0f64.to_radians())).abs() < 1.0e-12, "{above:?}");
    let again = read_streaks(&write_streaks(set).unwrap()).unwrap();
    assert_eq!(again.texels, set.texels);
    let atlas = StreakAtlas::from_sets(sets).unwrap();
    assert_eq!(atlas.data().frame.counts, [1, 10, 5, 74]);
}

#[test]
fn what_is_missing_is_named() {
    let mut one = database();
    let name = picture_name(4, 40, 30, 90, 5);
    one.pictures.remove(&name).unwrap();
    let error = import(&mut one, 4, 16).unwrap_err();
    assert!(matches!(error, AtlasError::Unreadable { .. }));
    assert_eq!(error.to_string(), format!("{name}: is missing from the database"));
    let mut many = database();
    many.pictures.retain(|name, _| !name.contains("dcam60"));
    let error = import(&mut many, 4, 16).unwrap_err().to_string();
    assert!(error.contains("dcam60/cv60_v-90_h10_osc0.png") && error.contains("and 735 more"), "{error}");
    let mut text = database();
    text.texts.remove(&brightness_name(20)).unwrap();
    let error = import(&mut text, 4, 16).unwrap_err().to_string();
    assert!(error.contains("dcam20_point_max.txt"), "{error}");
    let error = import(&mut Database::default(), 4, 16).unwrap_err();
    assert!(matches!(error, AtlasError::Unreadable { .. }));
    assert!(import(&mut database(), 5, 16).unwrap_err().to_string().contains("4, 8, 16 or 32"));
}

#[test]
fn what_is_not_as_described_is_named() {
    let mut short = database();
    let name = brightness_name(0);
    let text = short.texts[&name].replacen("h30 ", "h30 NaN ", 1);
    short.texts.insert(name.clone(), text);
    let error = import(&mut short, 4, 16).unwrap_err();
    assert!(error.to_string().contains(&name) && error.to_string().contains("h30 NaN"), "{error}");
    let mut wide = database();
    let name = picture_name(4, 0, -90, 170, 0);
    wide.pictures.insert(name.clone(), GrayPicture { width: 5, height: 1, values: vec![0; 5] });
    let error = import(&mut wide, 4, 16).unwrap_err().to_string();
    assert!(error.contains(&name) && error.contains("5 x 1"), "{error}");
}
