//! `downpour render --frames -o clip.mp4`: a file that players accept, complete or absent.

use std::fs;
use std::io::Write as _;
use std::path::Path;

use sha2::{Digest as _, Sha256};

use crate::child::{Ended, PATIENCE, names_in};
use crate::clip::clip;

fn film(folder: &Path, arguments: &[&str]) -> Ended {
    clip(folder, &[&["-o", "@clip.mp4"], arguments].concat()).run()
}

fn number(bytes: &[u8], at: usize) -> usize {
    u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()) as usize
}

/// The boxes of a stretch of bytes: names and bodies. They fill it.
fn boxes(mut bytes: &[u8]) -> Vec<(String, &[u8])> {
    let mut found = Vec::new();
    while !bytes.is_empty() {
        let (whole, rest) = bytes.split_at(number(bytes, 0));
        found.push((String::from_utf8(whole[4..8].to_vec()).unwrap(), &whole[8..]));
        bytes = rest;
    }
    found
}

/// The body of a box in boxes.
fn at<'a>(bytes: &'a [u8], path: &[&str]) -> &'a [u8] {
    path.iter().fold(bytes, |bytes, name| {
        let found = boxes(bytes).into_iter().find(|(found, _)| found == name);
        found.unwrap_or_else(|| panic!("no {name}")).1
    })
}

#[test]
fn a_video_is_a_file_of_av1() {
    let folder = tempfile::tempdir().unwrap();
    film(folder.path(), &["--frames", "5..12", "--stats", "@a.json"]).succeeded();
    assert_eq!(names_in(folder.path()), ["a.json", "clip.mp4"]);
    let file = fs::read(folder.path().join("clip.mp4")).unwrap();
    let names: Vec<String> = boxes(&file).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["ftyp", "moov", "mdat"]);
    assert!(at(&file, &["ftyp"]).chunks(4).any(|brand| brand == b"av01"));
    // 7 pictures of 1/8 s each.
    let media = ["moov", "trak", "mdia"];
    let header = at(&file, &[&media[..], &["mdhd"]].concat());
    let (timescale, length) = (number(header, 12), number(header, 16));
    assert_eq!(length * 8, timescale * 7);
    let movie = at(&file, &["moov", "mvhd"]);
    assert_eq!((number(movie, 12), number(movie, 16)), (timescale, length));
    let table = at(&file, &[&media[..], &["minf", "stbl"]].concat());
    let times = at(table, &["stts"]);
    assert_eq!((number(times, 4), number(times, 8), number(times, 12) * 8), (1, 7, timescale));
    assert_eq!((number(at(table, &["stss"]), 4), number(at(table, &["stss"]), 8)), (1, 1));
    // The samples fill the data, from the offset in the table.
    let sizes = at(table, &["stsz"]);
    assert_eq!((number(sizes, 4), number(sizes, 8)), (0, 7));
    let sizes: Vec<usize> = (0..7).map(|k| number(sizes, 12 + 4 * k)).collect();
    let data = at(&file, &["mdat"]);
    assert_eq!(sizes.iter().sum::<usize>(), data.len());
    let begin = number(at(table, &["stco"]), 8);
    assert_eq!(begin, file.len() - data.len());
    // The first picture starts with a sequence header, and none with a temporal delimiter.
    let mut offset = begin;
    for (k, size) in sizes.iter().enumerate() {
        let kind = file[offset] >> 3 & 15;
        assert!(kind != 2 && (kind == 1) == (k == 0), "sample {k} begins with an OBU of kind {kind}");
        offset += size;
    }
    let entry = at(table, &["stsd"])[8..].to_vec();
    assert_eq!(&entry[4..8], b"av01");
    assert_eq!(entry[32..36], [0, 32, 0, 18]);
    let inner = &entry[8 + 78..];
    // Version 1, profile 0, 4:2:0, color samples level with luma samples and between rows.
    assert_eq!((at(inner, &["av1C"])[0], at(inner, &["av1C"])[2] & 0b0111_1111), (0x81, 0b0000_1101));
    // BT.709, sRGB, BT.709, limited.
    assert_eq!(at(inner, &["colr"]), [&b"nclx"[..], &[0, 1, 0, 13, 0, 1, 0]].concat());
    let stats: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.path().join("a.json")).unwrap()).unwrap();
    assert_eq!(stats["frames"].as_array().unwrap().len(), 7);
    assert!(stats["encode_ms"].is_number());
}

/// Killed while frames are made, the video is made from the frames that are there, and is the same.
#[cfg(unix)]
#[test]
fn a_video_goes_on_where_it_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let reference = tempfile::tempdir().unwrap();
    let arguments = ["--frames", "0..6"];
    film(reference.path(), &arguments).succeeded();
    let whole = fs::read(reference.path().join("clip.mp4")).unwrap();
    let work = folder.path().join(".clip.mp4.frames");
    let command = ["-o", "@clip.mp4", "--frames", "0..6"];
    let running = clip(folder.path(), &command).start();
    let begin = std::time::Instant::now();
    while !work.join("000001.png").exists() {
        assert!(begin.elapsed() < PATIENCE, "two frames");
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    running.signal("KILL");
    assert_eq!(running.end().code, None);
    assert_eq!(names_in(folder.path()), [".clip.mp4.frames"]);
    let copy = |from: &Path, to: &Path| {
        fs::create_dir_all(to).unwrap();
        for name in names_in(from) {
            fs::copy(from.join(&name), to.join(&name)).unwrap();
        }
    };
    let kept = tempfile::tempdir().unwrap();
    copy(&work, kept.path());
    // Not in between: the frames are of a clip, and not of another one.
    film(folder.path(), &[&arguments[..], &["--rate", "1"]].concat()).failed(2, &["rate 400", "--overwrite"]);
    let ended = film(folder.path(), &arguments).succeeded();
    assert!(ended.stderr.contains("frames are there"), "{}", ended.stderr);
    assert_eq!(names_in(folder.path()), ["clip.mp4"]);
    assert!(fs::read(folder.path().join("clip.mp4")).unwrap() == whole);
    // A kill after the video got its name and before its frames were removed.
    copy(kept.path(), &work);
    film(folder.path(), &arguments).failed(5, &["clip.mp4 exists", "--overwrite"]);
    let hexadecimal = |bytes: &[u8]| -> String { bytes.iter().map(|byte| format!("{byte:02x}")).collect() };
    let line = format!("{{\"video\":\"{} of 0..6\"}}", hexadecimal(&Sha256::digest(&whole)));
    let check = hexadecimal(&Sha256::digest(&line)[..8]);
    let journal = fs::OpenOptions::new().append(true).open(work.join(".%06d.png.downpour-job"));
    journal.unwrap().write_all(format!("{check} {line}\n").as_bytes()).unwrap();
    film(folder.path(), &["--frames", "0..7"]).failed(5, &["clip.mp4 exists"]);
    film(folder.path(), &arguments).succeeded();
    assert_eq!(names_in(folder.path()), ["clip.mp4"]);
    assert!(fs::read(folder.path().join("clip.mp4")).unwrap() == whole);
}

#[test]
fn bad_videos_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |arguments: &[&str], code, words: &[&str]| {
        film(folder.path(), arguments).failed(code, words);
        assert_eq!(names_in(folder.path()), ["clip.mp4"]);
    };
    fs::write(folder.path().join("clip.mp4"), "precious").unwrap();
    refused(&["--frames", "0..2"], 5, &["clip.mp4 exists", "--overwrite"]);
    refused(&["--frames", "0..2", "--layers"], 2, &["--layers", "for .exr only"]);
    assert_eq!(fs::read(folder.path().join("clip.mp4")).unwrap(), b"precious");
    for size in ["33x18", "32x19", "14x32", "1x1"] {
        let output = folder.path().join("b.mp4");
        let arguments =
            ["render", "--size", size, "--frames", "0..2", "--fps", "8", "-o", output.to_str().unwrap()];
        let ended = crate::scene_files::storm(&arguments).run();
        ended.failed(2, &[&size.replace('x', " x "), ".mp4", "even numbers from 16"]).with_one_line();
    }
    assert_eq!(names_in(folder.path()), ["clip.mp4"]);
    film(folder.path(), &["--frames", "0..2", "--overwrite"]).succeeded();
    assert!(fs::read(folder.path().join("clip.mp4")).unwrap().len() > 500);
    assert_eq!(names_in(folder.path()), ["clip.mp4"]);
}
