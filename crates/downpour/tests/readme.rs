//! The README shows what the example prints.

#[allow(dead_code, reason = "its main is for the example alone")]
#[path = "../examples/drop_properties.rs"]
mod drop_properties;

#[test]
fn the_readme_shows_the_table_of_drops() {
    let table = drop_properties::table().expect("drops of 0.5 to 6 mm");
    assert!(include_str!("../README.md").contains(&table), "{table}");
}
