//! `downpour street`: the same bytes for a seed, a model that `check` takes, errors.

use crate::child::Downpour;

const SHORT: &str = "length_m = 20\nfurniture = 0.3\n";

fn made(arguments: &[&str]) -> Vec<u8> {
    let fixed = ["street", "--settings", "s.toml", "-q", "-o", "street.glb"];
    let ended = Downpour::new(&[&fixed, arguments].concat()).with_file("s.toml", SHORT).run().succeeded();
    std::fs::read(ended.folder.path().join("street.glb")).unwrap()
}

#[test]
fn a_seed_is_a_street() {
    let street = made(&["--seed", "3"]);
    assert_eq!(&street[..4], b"glTF");
    assert!(street == made(&["--seed", "3"]) && street != made(&["--seed", "4"]));
    assert!(street != made(&["--seed", "3", "--night"]));
    let check = Downpour::new(&["check", "w.toml", "--json"]).with_file("street.glb", street);
    let json = check.with_file("w.toml", "model = [{ file = \"street.glb\" }]\n").run().succeeded().json();
    assert!(json["triangles"].as_u64().unwrap() > 20_000, "{json}");
}

#[test]
fn a_car_is_a_model_that_drives() {
    let glb = |arguments: &[&str]| {
        let ended =
            Downpour::new(&[&["street", "-q", "-o", "car.glb"], arguments].concat()).run().succeeded();
        std::fs::read(ended.folder.path().join("car.glb")).unwrap()
    };
    let car = glb(&["--car", "2", "--night"]);
    assert!(car != glb(&["--car", "2"]) && car != glb(&["--car", "3", "--night"]));
    let text = "[[model]]\nfile = \"car.glb\"\nanimation_speed = 8\ntranslation_m = [[0, [0, 0, 0]], [1, [0, 0, 8]]]\n";
    let check = Downpour::new(&["check", "w.toml", "--json"]).with_file("car.glb", car);
    let json = check.with_file("w.toml", text).run().succeeded().json();
    assert_eq!((&json["lights"], &json["animations_playing"][0]), (&2.into(), &"roll".into()), "{json}");
    Downpour::new(&["street", "--car", "6", "-o", "car.glb"])
        .run()
        .failed(2, &["paint: 6", "allowed: 0 to 5"]);
    Downpour::new(&["street", "--car", "1", "--seed", "1", "-o", "car.glb"]).run().failed(2, &["--seed"]);
}

#[test]
fn bad_settings_and_names_are_refused() {
    let refused = |text: &str, output: &str, code: i32, words: &[&str]| {
        let run = Downpour::new(&["street", "--settings", "s.toml", "-o", output]).with_file("s.toml", text);
        run.run().failed(code, words);
    };
    refused("length_m = 10", "a.glb", 2, &["s.toml: length_m: 10", "allowed: 20 to 500"]);
    refused("lenght_m = 30", "a.glb", 2, &["s.toml: line 1: unknown field `lenght_m`", "allowed: "]);
    refused("seed = ", "a.glb", 2, &["s.toml: line 1: ", "allowed: "]);
    refused(SHORT, "a.obj", 2, &["a.obj", "allowed: .glb"]);
    refused(SHORT, "missing/a.glb", 5, &["missing"]);
    let none = Downpour::new(&["street", "--settings", "none.toml", "-o", "a.glb"]);
    none.run().failed(5, &["none.toml"]);
}
