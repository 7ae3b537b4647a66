//! Addresses, containers and the ranges of buffers, views and accessors: G1 to G15, G35, B1 to B5.

use crate::document::{floats, glb, triangle_of, with};
use crate::{Row, doc, made, text, uri};
use serde_json::json;

pub(crate) fn addresses() -> Vec<Row> {
    vec![
        uri(
            "G1",
            "../../../../../../etc/passwd",
            "buffers[0].uri: \"../../../../../../etc/passwd\" leaves the scene folder",
        ),
        uri("G2", "file:///etc/passwd", "only relative paths inside the scene folder, or data:"),
        uri("G3", "/etc/passwd", "buffers[0].uri: \"/etc/passwd\" is absolute"),
        uri("G4", "%2e%2e/%2e%2e/etc/passwd", "leaves the scene folder"),
        uri("G5", "%ff%fe.bin", "is not UTF-8 after decoding"),
        uri("G6", "file:///dev/zero", "only relative"),
        uri("G8", "a%00b.bin", "holds a zero byte"),
        uri("G8", ".", "names no file"),
        uri("G8", "C:\\x", "has a scheme or a drive"),
        uri("G8", "http://example.com/a.bin", "has a scheme"),
        doc("G8", &[("/buffers/0/uri", json!(7))], 2, "buffers[0].uri: 7; allowed"),
        doc(
            "",
            &[("/images", json!([{"uri": "../../../../../../etc/hostname", "mimeType": "image/png"}]))],
            2,
            "images[0].uri: \"../../../../../../etc/hostname\" leaves",
        ),
        // Its view is longer than its buffer, so the file that it names is never looked for.
        doc(
            "",
            &[("/buffers/0", json!({"byteLength": 16, "uri": "fifo.bin"}))],
            2,
            "bufferViews[0]: byteOffset 0 and byteLength 36",
        ),
    ]
}

pub(crate) fn ranges() -> Vec<Row> {
    let max = u64::MAX;
    vec![
        doc(
            "G10",
            &[("/accessors/0/count", json!(0))],
            2,
            "accessors[0].count: 0; allowed: a whole number from 1 on",
        ),
        doc(
            "G11",
            &[("/accessors/0/count", json!(4_000_000_000u64))],
            2,
            "accessors[0].count: 4000000000 elements",
        ),
        // Times 12 bytes it wraps to 8.
        doc(
            "G11",
            &[("/accessors/0/count", json!(1_537_228_672_809_129_302u64))],
            2,
            "allowed: at most 3, as bufferViews[0] has 36 bytes",
        ),
        doc(
            "G11",
            &[("/accessors/0/count", json!(max))],
            2,
            "accessors[0].count: 18446744073709551615 elements",
        ),
        text("G11", "\"count\":3", "\"count\":1e30", 2, "accessors[0].count: 1e+30; allowed: a whole number"),
        text("G11", "\"count\":3", "\"count\":-3", 2, "accessors[0].count: -3"),
        text("G11", "\"count\":3", "\"count\":2.5", 2, "accessors[0].count: 2.5"),
        doc(
            "G12",
            &[("/accessors/0/byteOffset", json!(max - 15))],
            2,
            "from byteOffset 18446744073709551600 on",
        ),
        doc(
            "G12",
            &[("/bufferViews/0/byteOffset", json!(max - 15))],
            2,
            "bufferViews[0]: byteOffset 18446744073709551600",
        ),
        doc(
            "G12",
            &[("/bufferViews/0/byteLength", json!(35))],
            2,
            "at most 2, as bufferViews[0] has 35 bytes",
        ),
        doc("G12", &[("/accessors/0/byteOffset", json!(1))], 2, "at most 2, as bufferViews[0] has 36 bytes"),
        doc("G13", &[("/bufferViews/0/byteLength", json!(81))], 2, "within buffers[0], which has 80 bytes"),
        doc(
            "G14",
            &[("/bufferViews/0/byteStride", json!(0))],
            2,
            "bufferViews[0].byteStride: 0; allowed: 4 to 252",
        ),
        doc("G14", &[("/bufferViews/0/byteStride", json!(3))], 2, "byteStride: 3; allowed: 4 to 252"),
        doc("G14", &[("/bufferViews/0/byteStride", json!(253))], 2, "byteStride: 253; allowed: 4 to 252"),
        doc("G14", &[("/bufferViews/0/byteStride", json!(1u64 << 40))], 2, "byteStride: 1099511627776"),
        doc(
            "G15",
            &[("/bufferViews/0/byteStride", json!(4))],
            2,
            "elements of 12 bytes, but bufferViews[0] has",
        ),
        doc(
            "G35",
            &[("/buffers/0/byteLength", json!(1u64 << 50))],
            2,
            "1125899906842624 bytes, but the data has 80",
        ),
        doc("", &[("/buffers/0/byteLength", json!(0))], 2, "buffers[0].byteLength: 0"),
        doc("", &[("/buffers/0/uri", json!("data:;base64,A-_="))], 2, "base64 after RFC 4648"),
        doc("", &[("/buffers/0", json!({"byteLength": 80}))], 2, "buffers[0]: no uri and no binary chunk"),
        doc(
            "",
            &[("/accessors/0/min", json!(["a", "b", "c"]))],
            2,
            "accessors[0].min[0]: \"a\"; allowed: a number",
        ),
    ]
}

pub(crate) fn containers() -> Vec<Row> {
    let bytes = floats(&[0.0; 20]);
    let mut inner = triangle_of(&bytes);
    inner["buffers"][0].as_object_mut().expect("an object").remove("uri");
    let json = inner.to_string();
    let whole = glb(json.as_bytes(), Some(&bytes));
    let patched = |at: usize, word: u32| {
        let mut bytes = whole.clone();
        bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
        bytes
    };
    // The header's length is made to fit, so that the cut shows in the chunk.
    let cut = |at: usize| {
        let mut bytes = whole[..at].to_vec();
        bytes[8..12].copy_from_slice(&(at as u32).to_le_bytes());
        bytes
    };
    let foreign = with(inner.clone(), &[("/buffers/0/uri", json!("file:///etc/passwd"))]);
    let two = with(inner.clone(), &[("/buffers/1", json!({"byteLength": 80}))]);
    let mut latin = json.clone().into_bytes();
    latin[2] = 0xE4;
    let exr = "an OpenEXR image; allowed: a glTF 2.0 file";
    let ktx = "a KTX2 texture; allowed: a glTF 2.0 file";
    vec![
        made("", whole.clone(), 0, "meshes: 3 vertices without a normal"),
        made("B1", patched(8, 0), 2, "GLB header: length 0 in a file of"),
        made("B2", patched(8, u32::MAX), 2, "GLB header: length 4294967295 in a file of"),
        made(
            "B3",
            patched(whole.len() - 88, u32::MAX),
            2,
            "GLB chunk 1: 4294967295 bytes, but only 80 follow",
        ),
        made("B3", cut(whole.len() - 8), 2, "GLB chunk 1: 80 bytes, but only 72 follow"),
        made("B3", glb(&latin, Some(&bytes)), 2, "JSON: not UTF-8 from byte 2 on"),
        made("B3", whole[..40].to_vec(), 2, "in a file of 40 bytes; allowed: 20 to 40"),
        made("B3", cut(40), 2, "GLB chunk 0:"),
        made("B3", whole[..14].to_vec(), 2, "GLB header: a file of 14 bytes, cut within the first 20"),
        made(
            "B4",
            glb(foreign.to_string().as_bytes(), Some(&bytes)),
            2,
            "\"file:///etc/passwd\" has a scheme",
        ),
        made(
            "B5",
            glb(two.to_string().as_bytes(), Some(&bytes)),
            2,
            "buffers[1]: no uri and no binary chunk",
        ),
        made("", patched(4, 1), 2, "GLB header: version 1; allowed: version 2"),
        made("", [&b"v/1\x01\x02\0\0\0"[..], &[0; 40]].concat(), 2, exr),
        made("", [&b"\xabKTX 20\xbb\r\n\x1a\n"[..], &[0; 80]].concat(), 2, ktx),
        made("", b"\x89PNG\r\n\x1a\n".to_vec(), 2, "a PNG image; allowed: a glTF 2.0 file"),
        made("", b"hello\x07 world".to_vec(), 2, "a file that begins with \"hello\\u{7} w\""),
        made("", b"\xff\xfe{\0}\0".to_vec(), 2, "begins with the bytes ff fe 7b 00 7d 00"),
        made("", Vec::new(), 2, "an empty file; allowed: a glTF 2.0 file"),
    ]
}
