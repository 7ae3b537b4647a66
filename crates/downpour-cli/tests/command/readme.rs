//! The README shows the output of the command. Blocks marked `console` begin with a command line, followed by its
//! output, to standard output if there is any, else to standard error.

use crate::child::Downpour;

#[test]
fn the_readme_shows_what_the_command_writes() {
    let readme = include_str!("../../README.md");
    let mut count = 0;
    for block in readme.split("```console\n").skip(1) {
        let (block, _) = block.split_once("```").unwrap();
        let (line, shown) = block.split_once('\n').unwrap();
        let arguments: Vec<&str> = line.strip_prefix("$ downpour ").unwrap().split_whitespace().collect();
        let ended = Downpour::new(&arguments).run();
        let written = if ended.stdout.is_empty() { &ended.stderr } else { &ended.stdout };
        assert_eq!(written, shown, "{line}");
        count += 1;
    }
    assert!(count >= 5, "{count} blocks");
}
