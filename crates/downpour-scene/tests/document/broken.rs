//! Broken files, made from valid ones: names and bytes. Tests of the library and of the command try all of them.

use super::triangle::{floats, glb, spoiled, triangle, triangle_of, with};
use serde_json::{Value, json};

/// A file with something wrong in it, or, rarely, something odd that is allowed.
pub(crate) struct Broken {
    pub(crate) name: String,
    pub(crate) bytes: Vec<u8>,
}

/// Values that are invalid at any path of a document.
fn values() -> [(&'static str, Value); 8] {
    [
        ("null", Value::Null),
        ("minus", json!(-1)),
        ("half", json!(0.5)),
        ("huge", json!(18_446_744_073_709_551_600u64)),
        ("text", json!("VEC7")),
        ("list", json!([])),
        ("object", json!({})),
        ("true", json!(true)),
    ]
}

/// Pointers to all values of a document that are no objects or lists, and to all lists.
fn pointers(value: &Value, here: &str, found: &mut Vec<String>) {
    match value {
        Value::Object(members) => {
            for (key, value) in members {
                pointers(value, &format!("{here}/{key}"), found);
            }
        }
        Value::Array(items) => {
            found.push(here.to_owned());
            for (index, value) in items.iter().enumerate() {
                pointers(value, &format!("{here}/{index}"), found);
            }
        }
        _ => found.push(here.to_owned()),
    }
}

/// A valid triangle with each of its values replaced by each of [`values`], one at a time.
pub(crate) fn replaced() -> Vec<Broken> {
    let mut found = Vec::new();
    pointers(&triangle(), "", &mut found);
    let mut all = Vec::new();
    for pointer in found {
        for (word, value) in values() {
            let name = format!("{}_{word}.gltf", pointer.trim_start_matches('/').replace('/', "_"));
            all.push(Broken { name, bytes: spoiled(&[(&pointer, value)]).to_string().into_bytes() });
        }
    }
    all
}

/// Addresses, ranges, formats, trees, containers and other kinds of files, each wrong in a different way.
pub(crate) fn chosen() -> Vec<Broken> {
    let document = |name: &str, changes: &[(&str, Value)]| Broken {
        name: format!("{name}.gltf"),
        bytes: spoiled(changes).to_string().into_bytes(),
    };
    let file = |name: &str, bytes: Vec<u8>| Broken { name: name.to_owned(), bytes };
    let attribute = |name: &str| format!("/meshes/0/primitives/0/attributes/{name}");
    let primitive = "/meshes/0/primitives/0";
    let max = u64::MAX;
    let mut all = vec![
        document("valid", &[]),
        document("unknown_keys", &[("/accessors/0/custom", json!([1])), ("/extras", json!(7))]),
        document("minor_version", &[("/asset/version", json!("2.7"))]),
        document("version_1", &[("/asset/version", json!("1.0"))]),
        document("no_version", &[("/asset", json!({}))]),
        document("needs_2.1", &[("/asset/minVersion", json!("2.1"))]),
        document("draco", &[("/extensionsRequired", json!(["KHR_draco_mesh_compression"]))]),
        document("unknown_extension", &[("/extensionsUsed", json!(["ACME_shape"]))]),
        document("parent_folder", &[("/buffers/0/uri", json!("../../../etc/passwd"))]),
        document("root_folder", &[("/buffers/0/uri", json!("/etc/passwd"))]),
        document("file_scheme", &[("/buffers/0/uri", json!("file:///etc/passwd"))]),
        document("network", &[("/buffers/0/uri", json!("https://example.com/a.bin"))]),
        document("not_utf8", &[("/buffers/0/uri", json!("%ff%fe.bin"))]),
        document("zero_byte", &[("/buffers/0/uri", json!("a%00b.bin"))]),
        document("no_base64", &[("/buffers/0/uri", json!("data:;base64,A-_="))]),
        document("not_found", &[("/buffers/0/uri", json!("nowhere.bin"))]),
        document("short_buffer", &[("/buffers/0/byteLength", json!(16))]),
        document("long_buffer", &[("/buffers/0/byteLength", json!(1u64 << 50))]),
        document("count_huge", &[("/accessors/0/count", json!(4_000_000_000u64))]),
        document("count_wraps", &[("/accessors/0/count", json!(1_537_228_672_809_129_302u64))]),
        document("view_at_the_end", &[("/bufferViews/0/byteOffset", json!(max - 15))]),
        document("stride_0", &[("/bufferViews/0/byteStride", json!(0))]),
        document("stride_4", &[("/bufferViews/0/byteStride", json!(4))]),
        document("positions_of_two", &[("/accessors/0/type", json!("VEC2"))]),
        document("indices_of_floats", &[("/accessors/2/componentType", json!(5126))]),
        document("indices_of_three", &[("/accessors/2/type", json!("VEC3"))]),
        document("no_position", &[(&format!("{primitive}/attributes"), json!({}))]),
        document("odd_attribute", &[(&attribute("TEXCOORD_A"), json!(0))]),
        document("own_attribute", &[(&attribute("_OWN"), json!(0))]),
        document("position_99", &[(&attribute("POSITION"), json!(99))]),
        document("color_of_one", &[(&attribute("COLOR_0"), json!(2))]),
        document("tangent_of_three", &[(&attribute("TANGENT"), json!(1))]),
        document("joints_alone", &[(&attribute("JOINTS_0"), json!(0))]),
        document("mode_7", &[(&format!("{primitive}/mode"), json!(7))]),
        document("lines", &[(&format!("{primitive}/mode"), json!(1))]),
        document("material_3", &[(&format!("{primitive}/material"), json!(3))]),
        document("morph_beyond", &[(&format!("{primitive}/targets"), json!([{"POSITION": 9}]))]),
        document("morph_unequal", &[(&format!("{primitive}/targets"), json!([{"POSITION": 2}]))]),
        document("weights_of_text", &[("/meshes/0/weights", json!(["x"]))]),
        document("own_child", &[("/nodes/0/children", json!([0]))]),
        document("child_77", &[("/nodes/0/children", json!([77]))]),
        document("no_rotation", &[("/nodes/0/rotation", json!([0, 0, 0, 0]))]),
        document("long_rotation", &[("/nodes/0/rotation", json!([0, 0, 3, 4]))]),
        document("scale_0", &[("/nodes/0/scale", json!([0, 1, 1]))]),
        document("mirrored", &[("/nodes/0/scale", json!([-1, 1, 1]))]),
        document("far_away", &[("/nodes/0/translation", json!([1e38, 0, 0]))]),
        document("beyond_floats", &[("/nodes/0/translation", json!([1e39, 0, 0]))]),
        document("matrix_of_3", &[("/nodes/0/matrix", json!([1, 2, 3]))]),
        document("matrix_of_nulls", &[("/nodes/0/matrix", json!(vec![Value::Null; 16]))]),
        document("root_twice", &[("/scenes/0/nodes", json!([0, 0]))]),
        document("scene_9", &[("/scene", json!(9))]),
        document("mesh_9", &[("/nodes/0/mesh", json!(9))]),
        document("skin_9", &[("/nodes/0/skin", json!(9))]),
        document("no_lens", &[("/cameras", json!([{"type": "perspective"}]))]),
        document("no_light", &[("/nodes/0/extensions", json!({"KHR_lights_punctual": {"light": 3}}))]),
        document("image_of_nothing", &[("/images", json!([{}]))]),
        document("image_above", &[("/images", json!([{"uri": "../a.png"}]))]),
        document("image_view_9", &[("/images", json!([{"bufferView": 9, "mimeType": "image/png"}]))]),
        document("texture_9", &[("/materials", json!([{"normalTexture": {"index": 9}}]))]),
        document("joint_5", &[("/skins", json!([{"joints": [5]}]))]),
        document("empty_skin", &[("/skins", json!([{"joints": []}]))]),
        document(
            "sampler_3",
            &[("/animations", json!([{"samplers": [{"input": 0, "output": 3}], "channels": []}]))],
        ),
        document("empty_lists", &[("/materials", json!([])), ("/textures", json!([]))]),
    ];
    let ring: Vec<Value> = [1, 2, 3, 1].map(|child| json!({"children": [child]})).to_vec();
    all.push(document("ring", &[("/nodes", Value::Array(ring))]));
    let chain = (1..=300).map(|i| json!({"children": [i]})).chain([json!({"mesh": 0})]).collect();
    all.push(document("deep_chain", &[("/nodes", Value::Array(chain))]));
    for (name, value) in [("nan", f32::NAN), ("infinite", f32::INFINITY), ("largest", f32::MAX)] {
        let mut bytes = floats(&[0.0, 0.0, 0.0, 1.0, value, 0.0, 0.0, 1.0, 0.0]);
        bytes.extend(floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0]));
        bytes.extend([0, 0, 1, 0, 2, 0, 0, 0]);
        all.push(file(&format!("{name}.gltf"), triangle_of(&bytes).to_string().into_bytes()));
    }
    let mut bytes = floats(&[0.0; 18]);
    bytes.extend([0, 0, 1, 0, 0xff, 0xff, 0, 0]);
    all.push(file("index_beyond.gltf", triangle_of(&bytes).to_string().into_bytes()));
    let text = triangle().to_string();
    all.push(file("cut.gltf", text.as_bytes()[..text.len() / 2].to_vec()));
    all.push(file("nested.gltf", "[".repeat(100_000).into_bytes()));
    all.push(file("latin.gltf", b"{\"asset\": {\"version\": \"2.\xff\"}}".to_vec()));
    all.push(file("mark.gltf", [b"\xef\xbb\xbf", text.as_bytes()].concat()));
    all.push(file("empty.gltf", Vec::new()));
    all.push(file("nothing.gltf", b"{}".to_vec()));
    all.push(file("number.gltf", text.replacen("\"count\":3", "\"count\":1e400", 1).into_bytes()));
    all.extend(containers());
    all
}

/// Binary containers, complete and not.
fn containers() -> Vec<Broken> {
    let bytes =
        floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    let bytes = [bytes, vec![0, 0, 1, 0, 2, 0, 0, 0]].concat();
    let mut inner = triangle_of(&bytes);
    if let Some(buffer) = inner["buffers"][0].as_object_mut() {
        buffer.remove("uri");
    }
    let whole = glb(inner.to_string().as_bytes(), Some(&bytes));
    let chunk = whole.len() - 88;
    let patched = |at: usize, word: u32| {
        let mut bytes = whole.clone();
        bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
        bytes
    };
    let cut = |at: usize| {
        let mut bytes = whole[..at].to_vec();
        if at >= 12 {
            bytes[8..12].copy_from_slice(&(at as u32).to_le_bytes());
        }
        bytes
    };
    let two = with(inner.clone(), &[("/buffers/1", json!({"byteLength": 80}))]);
    let mut longer = whole.clone();
    longer.extend([0; 40]);
    let files = [
        ("whole", whole.clone()),
        ("magic", patched(0, 7)),
        ("version_1", patched(4, 1)),
        ("length_0", patched(8, 0)),
        ("length_max", patched(8, u32::MAX)),
        ("json_length_max", patched(12, u32::MAX)),
        ("json_length_0", patched(12, 0)),
        ("json_kind", patched(16, 7)),
        ("binary_length_max", patched(chunk, u32::MAX)),
        ("binary_kind", patched(chunk + 4, 7)),
        ("longer", longer),
        ("no_binary", glb(inner.to_string().as_bytes(), None)),
        ("two_buffers", glb(two.to_string().as_bytes(), Some(&bytes))),
        ("empty_json", glb(b"", Some(&bytes))),
        ("no_json", glb(b"not json", Some(&bytes))),
        ("empty", Vec::new()),
        ("one_byte", whole[..1].to_vec()),
        ("header", cut(12)),
        ("chunk_header", cut(20)),
        ("half_json", cut(60)),
        ("half_binary", cut(whole.len() - 40)),
    ];
    files.map(|(name, bytes)| Broken { name: format!("{name}.glb"), bytes }).into()
}

/// Files of other kinds: headers of pictures and textures that promise much, and noise.
pub(crate) fn others() -> Vec<Broken> {
    let noise: Vec<u8> = (0..400u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    let file = |name: &str, head: &[u8]| Broken { name: name.to_owned(), bytes: [head, &noise[..]].concat() };
    let mut ktx = b"\xabKTX 20\xbb\r\n\x1a\n".to_vec();
    ktx.extend([0xff; 60]);
    let png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\x7f\xff\xff\xff\x7f\xff\xff\xff\x08\x06\0\0\0";
    vec![
        file("picture.exr", b"v/1\x01\x02\0\0\0channels\0chlist\0\xff\xff\xff\x7f"),
        file("deep.exr", b"v/1\x01\x02\x08\0\0"),
        file("levels.ktx2", &ktx),
        file("huge.png", png),
        file("cut.jpg", b"\xff\xd8\xff\xe0\0\x10JFIF\0\x01"),
        file("sun.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 999999 +X 999999\n"),
        file("noise.bin", b""),
        file("table.tsv", b"a\tb\n"),
    ]
}
