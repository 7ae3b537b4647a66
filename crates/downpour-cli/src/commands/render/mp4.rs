//! A track of AV1 as an MP4 file: ISO/IEC 14496-12 boxes, and the AV1 ISO Media File Format Binding 1.2.
//!
//! All metadata of the samples precedes them, so that a player can start before the end is loaded.

/// A coded picture.
pub(super) struct Sample {
    /// Its OBUs, without temporal delimiters.
    pub(super) data: Vec<u8>,
    /// True if decoding can start here.
    pub(super) key: bool,
}

/// Contents of a file.
pub(super) struct Track<'a> {
    pub(super) size: [u16; 2],
    /// Units of time in a second.
    pub(super) timescale: u32,
    /// Units of time that a picture stays.
    pub(super) step: u32,
    /// The body of the box `av1C`.
    pub(super) configuration: &'a [u8],
    /// Primaries, transfer function and matrix of ITU-T H.273, and true if all 256 values are used.
    pub(super) color: ([u16; 3], bool),
}

/// The identity, as boxes have matrices.
const MATRIX: [u32; 9] = [0x1_0000, 0, 0, 0, 0x1_0000, 0, 0, 0, 0x4000_0000];

/// The file.
pub(super) fn write(track: &Track<'_>, samples: &[Sample]) -> Vec<u8> {
    let file_type =
        boxed(b"ftyp", &[b"isom", &0u32.to_be_bytes()[..], b"isom", b"iso6", b"av01", b"mp41"].concat());
    let payload: u64 = samples.iter().map(|sample| sample.data.len() as u64).sum();
    // The length of a box that needs more than 32 bits follows its name.
    let long = payload > u64::from(u32::MAX) - 8;
    let header: u64 = if long { 16 } else { 8 };
    // The boxes before the samples have one length for any offset.
    let before = file_type.len() as u64 + movie(track, samples, 0).len() as u64 + header;
    let mut file = file_type;
    file.extend(movie(track, samples, u32::try_from(before).unwrap_or(u32::MAX)));
    if long {
        file.extend([&1u32.to_be_bytes()[..], b"mdat", &(payload + header).to_be_bytes()].concat());
    } else {
        file.extend([&count(payload + header).to_be_bytes()[..], b"mdat"].concat());
    }
    for sample in samples {
        file.extend(&sample.data);
    }
    file
}

fn movie(track: &Track<'_>, samples: &[Sample], first_byte: u32) -> Vec<u8> {
    let length = count(samples.len() as u64).saturating_mul(track.step);
    let mut header = vec![0, 0, track.timescale, length, 0x1_0000, 0x0100_0000, 0, 0];
    header.extend(MATRIX);
    header.extend([0; 6]);
    // The number of the next track.
    header.push(2);
    let [width, height] = track.size.map(u32::from);
    let mut track_header = vec![0, 0, 1, 0, length, 0, 0, 0, 0];
    track_header.extend(MATRIX);
    track_header.extend([width << 16, height << 16]);
    // Language "und", in three letters of five bits.
    let media_header = [0, 0, track.timescale, length, 0x55c4_0000];
    let handler = [&[0; 8][..], b"vide", &[0; 12], b"video\0"].concat();
    let reference = [&words(&[1])[..], &full_box(b"url ", 1, &[])].concat();
    let information = [
        full_box(b"vmhd", 1, &[0; 8]),
        boxed(b"dinf", &full_box(b"dref", 0, &reference)),
        boxed(b"stbl", &sample_table(track, samples, first_byte)),
    ];
    let media = [
        full_box(b"mdhd", 0, &words(&media_header)),
        // The first four bytes of the handler are those of a full box.
        boxed(b"hdlr", &handler),
        boxed(b"minf", &information.concat()),
    ];
    // Enabled, and part of the presentation.
    let trak = [full_box(b"tkhd", 3, &words(&track_header)), boxed(b"mdia", &media.concat())];
    let moov = [full_box(b"mvhd", 0, &words(&header)), boxed(b"trak", &trak.concat())];
    boxed(b"moov", &moov.concat())
}

/// Offsets and durations of the samples: one chunk holds them all.
fn sample_table(track: &Track<'_>, samples: &[Sample], first_byte: u32) -> Vec<u8> {
    let number = count(samples.len() as u64);
    let keys: Vec<u32> = (1..).zip(samples).filter(|(_, sample)| sample.key).map(|(k, _)| k).collect();
    let sizes: Vec<u32> = samples.iter().map(|sample| count(sample.data.len() as u64)).collect();
    [
        full_box(b"stsd", 0, &[&words(&[1])[..], &boxed(b"av01", &sample_entry(track))].concat()),
        full_box(b"stts", 0, &words(&[1, number, track.step])),
        full_box(b"stss", 0, &[words(&[count(keys.len() as u64)]), words(&keys)].concat()),
        full_box(b"stsc", 0, &words(&[1, 1, number, 1])),
        full_box(b"stsz", 0, &[words(&[0, number]), words(&sizes)].concat()),
        full_box(b"stco", 0, &words(&[1, first_byte])),
    ]
    .concat()
}

fn sample_entry(track: &Track<'_>) -> Vec<u8> {
    let ([primaries, transfer, matrix], full) = track.color;
    let [width, height] = track.size.map(u16::to_be_bytes);
    let codes = [primaries, transfer, matrix].map(u16::to_be_bytes).concat();
    let color = [b"nclx", &codes[..], &[u8::from(full) << 7]].concat();
    // The second 1 is the number of pictures in a sample, 24 the bits of a pixel.
    let fixed = [&[0, 0, 0, 0, 0, 0, 0, 1][..], &[0; 16], &width, &height, &words(&[72 << 16, 72 << 16, 0])];
    let name = [&[0, 1][..], &[0; 32], &[0, 24, 0xff, 0xff]];
    [&fixed.concat()[..], &name.concat(), &boxed(b"av1C", track.configuration), &boxed(b"colr", &color)]
        .concat()
}

fn boxed(name: &[u8; 4], body: &[u8]) -> Vec<u8> {
    [&count(body.len() as u64 + 8).to_be_bytes()[..], name, body].concat()
}

/// A box with a version, which is 0 here, and flags.
fn full_box(name: &[u8; 4], flags: u32, body: &[u8]) -> Vec<u8> {
    boxed(name, &[&flags.to_be_bytes()[..], body].concat())
}

fn words(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_be_bytes()).collect()
}

fn count(number: u64) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}
