//! A build without the feature `gpu`.

use crate::child::downpour;

#[test]
fn auto_takes_the_cpu_and_gpu_is_an_error() {
    let arguments = ["mask", "--diameter", "2", "--size", "16", "-o", "m.exr"];
    let ended = downpour(&arguments).succeeded().left(&["m.exr"]);
    assert!(
        ended.stderr.starts_with("downpour: backend: cpu (this build has no GPU support)\n"),
        "{}",
        ended.stderr
    );
    let words = ["no GPU support", "feature `gpu`", "--backend cpu"];
    downpour(&[&arguments[..], &["--backend", "gpu"]].concat()).failed(4, &words).with_one_line().left(&[]);
    assert_eq!(downpour(&["adapters", "--json"]).failed(4, &words).stdout, "[]\n");
}
