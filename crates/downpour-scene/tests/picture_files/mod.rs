//! Writers of small, and of wrong, picture files.
#![allow(dead_code, reason = "each test binary uses some of them")]

/// Data as a zlib stream.
pub(crate) fn zlib(data: &[u8]) -> Vec<u8> {
    miniz_oxide::deflate::compress_to_vec_zlib(data, 9)
}

/// One chunk of a PNG file.
pub(crate) fn png_chunk(kind: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let body = [kind.as_slice(), data].concat();
    let mut crc = u32::MAX;
    for &byte in &body {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = (crc >> 1) ^ (0xedb8_8320 & (crc & 1).wrapping_neg());
        }
    }
    let length = (data.len() as u32).to_be_bytes();
    [length.as_slice(), &body, &(!crc).to_be_bytes()].concat()
}

/// A PNG file with this header and these compressed rows, consistent or not.
pub(crate) fn png(width: u32, height: u32, depth: u8, color: u8, data: &[u8]) -> Vec<u8> {
    let head = [&width.to_be_bytes()[..], &height.to_be_bytes(), &[depth, color, 0, 0, 0]].concat();
    let magic = b"\x89PNG\r\n\x1a\n".to_vec();
    [magic, png_chunk(b"IHDR", &head), png_chunk(b"IDAT", data), png_chunk(b"IEND", b"")].concat()
}

/// A Radiance HDR file with these lines in its header, and these RGBE pixels without run lengths.
pub(crate) fn hdr(lines: &str, width: u32, height: u32, pixels: &[u8]) -> Vec<u8> {
    let head = format!("#?RADIANCE\n{lines}FORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n");
    [head.as_bytes(), pixels].concat()
}

/// One attribute of an OpenEXR header.
pub(crate) fn exr_attribute(name: &str, kind: &str, value: &[u8]) -> Vec<u8> {
    let length = (value.len() as u32).to_le_bytes();
    [name.as_bytes(), b"\0", kind.as_bytes(), b"\0", &length, value].concat()
}

/// Parts of an OpenEXR file; [`ExrFile::default`] is a valid one of 2 x 2 half pixels.
#[derive(Clone)]
pub(crate) struct ExrFile {
    pub(crate) version: u32,
    pub(crate) channels: Vec<(&'static str, u32, i32)>,
    pub(crate) compression: u8,
    pub(crate) data: [i32; 4],
    pub(crate) display: [i32; 4],
    pub(crate) aspect: f32,
    pub(crate) more: Vec<u8>,
    pub(crate) body: Vec<u8>,
}

impl Default for ExrFile {
    fn default() -> Self {
        let row = |y: u32, values: [u16; 6]| {
            let mut chunk = [y.to_le_bytes(), 12u32.to_le_bytes()].concat();
            chunk.extend(values.into_iter().flat_map(u16::to_le_bytes));
            chunk
        };
        // Half floats: 1 is 0x3c00, 2 is 0x4000, 0.5 is 0x3800. Channel by channel: B, G, R.
        let rows = [row(0, [0x3c00, 0, 0, 0x3800, 0x4000, 0]), row(1, [0, 0, 0, 0, 0, 0x3c00])];
        Self {
            version: 2,
            channels: vec![("B", 1, 1), ("G", 1, 1), ("R", 1, 1)],
            compression: 0,
            data: [0, 0, 1, 1],
            display: [0, 0, 1, 1],
            aspect: 1.0,
            more: Vec::new(),
            body: rows.concat(),
        }
    }
}

impl ExrFile {
    /// The file, with a table of two blocks.
    pub(crate) fn bytes(&self) -> Vec<u8> {
        let mut file = self.header();
        let start = file.len() as u64 + 16;
        file.extend(start.to_le_bytes());
        file.extend((start + 20).to_le_bytes());
        file.extend(&self.body);
        file
    }

    /// The file up to the end of its header.
    pub(crate) fn header(&self) -> Vec<u8> {
        let mut list = Vec::new();
        for (name, kind, sampling) in &self.channels {
            list.extend(name.as_bytes());
            list.push(0);
            list.extend(kind.to_le_bytes());
            list.extend([0; 4]);
            list.extend(sampling.to_le_bytes());
            list.extend(sampling.to_le_bytes());
        }
        list.push(0);
        let window = |w: [i32; 4]| w.into_iter().flat_map(i32::to_le_bytes).collect::<Vec<u8>>();
        [
            &b"\x76\x2f\x31\x01"[..],
            &self.version.to_le_bytes(),
            &exr_attribute("channels", "chlist", &list),
            &exr_attribute("compression", "compression", &[self.compression]),
            &exr_attribute("dataWindow", "box2i", &window(self.data)),
            &exr_attribute("displayWindow", "box2i", &window(self.display)),
            &exr_attribute("lineOrder", "lineOrder", &[0]),
            &exr_attribute("pixelAspectRatio", "float", &self.aspect.to_le_bytes()),
            &exr_attribute("screenWindowCenter", "v2f", &[0; 8]),
            &exr_attribute("screenWindowWidth", "float", &1.0f32.to_le_bytes()),
            &self.more,
            b"\0",
        ]
        .concat()
    }
}
