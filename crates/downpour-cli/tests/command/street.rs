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
