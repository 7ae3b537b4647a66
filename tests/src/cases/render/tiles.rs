//! `shaders/wgsl/render/tiles.wgsl` against `downpour_render::rain::tiles`.

use downpour_gpu::{Gpu, GpuError};
use downpour_math::rng::rng_draw;
use downpour_render::gpu::tiles::TilesPipeline;
use downpour_render::rain::ScreenDrop;
use downpour_render::rain::list::seen;
use downpour_render::rain::tiles::{
    TileLists, TilesFrame, tiles_bound, tiles_columns, tiles_is_listed, tiles_rows,
};
use downpour_shaders::Kernel;
use downpour_shaders::render::rain::{
    TILES, TILES_CLEAR_KERNEL, TILES_COUNT_KERNEL, TILES_MEASURE_KERNEL, TILES_PLACE_KERNEL,
    TILES_SCAN_KERNEL, TILES_SEEN_KERNEL, TILES_SORT_KERNEL,
};

use crate::Domain::{Below, Made};
use crate::compare::{Cpu, Gpu as FromGpu};
use crate::function::Run;
use crate::signature::WordKind;
use crate::words::IntoWords as _;
use crate::{FunctionCase, KernelCase, Tol};

/// Pictures with a column and a row more than whole tiles cover, and with none.
const SIZES: [[u32; 2]; 2] = [[313, 201], [320, 192]];
const SIZE: [u32; 2] = SIZES[0];

/// Words of a drop.
pub(super) const DROP_WORDS: usize = size_of::<ScreenDrop>() / 4;

/// A drop on or about a picture. All numbers have few digits in base two and slopes are powers of two, so that both sides compute
/// without rounding.
fn drop(random: [u32; 4]) -> ScreenDrop {
    let [a, b, c, d] = random;
    // Eighths of a pixel.
    let eighths = |word: u32, range: u32| (word % (8 * range)) as f32 / 8.0;
    let steep = [0.0, 0.25, 1.0, 8.0, -8.0, 64.0, -128.0][(c >> 8) as usize % 7];
    ScreenDrop {
        first: [eighths(a, 2 * SIZE[0]) - 60.0, eighths(b, 2 * SIZE[1]) - 40.0],
        screen_delta: [eighths(c, 48) - 24.0, steep],
        // Some are not on the picture at all, a few cover much of it.
        reach: match d % 16 {
            0 => -1.0,
            1 => eighths(d >> 8, 48),
            2 => 200.0,
            _ => eighths(d >> 8, 4),
        },
        // So few distances that many are equal.
        nearest: 0.5 + ((d >> 4) % 61) as f32,
        id: (d >> 11) % 1021,
        // Some are summed up: two in three of those that move, but for the widest.
        kind: (a >> 20) % 3,
        grid: (b >> 20) % 2,
        slope: 1.0 / 64.0,
        along: [0.0, [0.03125, 0.046875, 0.0625, 0.125, 0.25, 1.0][(b >> 22) as usize % 6]],
        weights: [[1.0, 1.0], [0.5, 1.5]][(a >> 23) as usize % 2],
        ..ScreenDrop::default()
    }
}

pub(super) fn drop_words(random: [u32; 4]) -> Vec<u32> {
    bytemuck::cast::<ScreenDrop, [u32; DROP_WORDS]>(drop(random)).to_vec()
}

/// A number of columns or rows.
fn count(random: [u32; 4]) -> Vec<u32> {
    vec![1 + random[0] % 320]
}

/// An edge of tiles.
fn edge(random: [u32; 4]) -> Vec<u32> {
    vec![8 << (random[0] % 5)]
}

fn size_words(random: [u32; 4]) -> Vec<u32> {
    SIZES[random[0] as usize % 2].to_vec()
}

/// First and last as the shader has them.
pub(super) fn pair(found: Option<[u32; 2]>) -> Vec<u32> {
    found.unwrap_or([1, 0]).words()
}

/// The cases.
#[must_use]
pub(super) fn functions() -> Vec<FunctionCase> {
    let exact = Tol::exact("sums, products and quotients without rounding");
    vec![
        FunctionCase::new(
            "tiles_rows",
            &TILES,
            &[Made(drop_words), Made(edge), Made(size_words)],
            exact,
            |a| pair(tiles_rows(&bytemuck::cast(a.u32s::<DROP_WORDS>()), a.u32(), a.u32s())),
        ),
        FunctionCase::new("tiles_is_listed", &TILES, &[Made(drop_words)], exact, |a| {
            tiles_is_listed(&bytemuck::cast(a.u32s::<DROP_WORDS>())).words()
        }),
        FunctionCase::new(
            "tiles_columns",
            &TILES,
            &[Made(drop_words), Below(14), Made(edge), Made(count)],
            exact,
            |a| pair(tiles_columns(&bytemuck::cast(a.u32s::<DROP_WORDS>()), a.u32(), a.u32(), a.u32())),
        ),
        FunctionCase::new(
            "tiles_bound",
            &TILES,
            &[Made(drop_words), Made(edge), Made(size_words)],
            exact,
            |a| tiles_bound(&bytemuck::cast(a.u32s::<DROP_WORDS>()), a.u32(), a.u32s()).words(),
        ),
    ]
}

/// The lists of drops of pictures, each made twice: the second time finds what the first one left.
fn lists(
    gpu: &Gpu,
    size: [u32; 2],
    room: Option<u32>,
    (pictures, drops): (u32, fn(u32) -> Vec<ScreenDrop>),
) -> Result<Run, GpuError> {
    let pipeline = TilesPipeline::new(gpu)?;
    let (mut cpu, mut found) = (Vec::new(), Vec::new());
    for seed in 0..pictures {
        let drops = drops(seed);
        let mut frame = TilesFrame::new(size, drops.len() as u32);
        frame.room = room.unwrap_or(frame.room);
        let lists = TileLists::with_room(&drops, size, frame.room).words();
        let list = gpu.storage_buffer("drops", &drops)?;
        let plate = gpu.storage_buffer("plate", &[[0.0f32; 4]])?;
        let pass = pipeline.prepare(gpu, &list, &plate, &frame)?;
        gpu.submit(&pass.dispatches())?;
        gpu.submit(&pass.dispatches())?;
        let words = pass.read()?;
        // Words behind the lists are not written.
        found.extend(words.into_iter().take(lists.len()));
        cpu.extend(lists);
    }
    Ok(Run {
        arguments: (0..cpu.len() as u32).map(|k| vec![k]).collect(),
        cpu: Cpu(cpu),
        gpu: FromGpu(found),
        kinds: vec![WordKind::Integer],
    })
}

fn random_drops<const COUNT: u32>(seed: u32) -> Vec<ScreenDrop> {
    (0..COUNT).map(|k| drop(rng_draw([seed, 5], k, 0, 0))).collect()
}

/// 2^14 drops of which each covers all of 2^18 tiles: their number is 2^32, which 32 bits hold as 0.
fn everywhere(seed: u32) -> Vec<ScreenDrop> {
    let one = |k| ScreenDrop { first: [2048.0; 2], reach: 3000.0, ..drop(rng_draw([seed, 6], k, 0, 0)) };
    (0..1 << 14).map(one).collect()
}

/// Drops that are looked for: more than one row of workgroups has.
const SEEN: u32 = 9000;

/// Which drops a picture shows whose distances differ from pixel to pixel.
fn seen_case(gpu: &Gpu) -> Result<Run, GpuError> {
    let drops: Vec<ScreenDrop> = (0..SEEN).map(|k| drop(rng_draw([8, 5], k, 0, 0))).collect();
    let pixel = |k| [0.0, 0.0, 0.0, rng_draw([9, 5], k / 40, 0, 0).map(|word| word % 64)[0] as f32];
    let clean: Vec<[f32; 4]> = (0..SIZE[0] * SIZE[1]).map(pixel).collect();
    let distances: Vec<f32> = drops.iter().map(|drop| seen(drop, &clean, SIZE)).collect();
    for kind in [|at: f32| at > 0.0, |at| at == 0.0, |at| at < 0.0] {
        assert!(distances.iter().filter(|at| kind(**at)).count() > 20);
    }
    let pipeline = TilesPipeline::new(gpu)?;
    let (list, plate) = (gpu.storage_buffer("drops", &drops)?, gpu.storage_buffer("plate", &clean)?);
    let pass = pipeline.prepare(gpu, &list, &plate, &TilesFrame::new(SIZE, SEEN))?;
    gpu.submit(&[pass.seen()])?;
    let found = gpu.read::<f32>(pass.distances().0)?;
    let words = |all: &[f32]| all.iter().map(|at| at.to_bits()).collect();
    Ok(Run {
        arguments: (0..SEEN).map(|k| vec![k]).collect(),
        cpu: Cpu(words(&distances)),
        gpu: FromGpu(words(&found[..distances.len()])),
        kinds: vec![WordKind::Float],
    })
}

/// The cases.
#[must_use]
pub(super) fn kernels() -> Vec<KernelCase> {
    const OTHERS: &[&Kernel] = &[
        &TILES_CLEAR_KERNEL,
        &TILES_MEASURE_KERNEL,
        &TILES_COUNT_KERNEL,
        &TILES_SCAN_KERNEL,
        &TILES_PLACE_KERNEL,
    ];
    let exact = Tol::exact("integers, from numbers without rounding");
    let of = |name, run| KernelCase {
        name,
        kernel: &TILES_SORT_KERNEL,
        with: OTHERS,
        overrides: &[],
        text: None,
        tol: exact,
        run,
    };
    vec![
        of("main_tiles_sort (tiles of 8 pixels)", |gpu| {
            lists(gpu, SIZES[0], None, (2, random_drops::<9000>))
        }),
        of("main_tiles_sort (larger tiles, long lists)", |gpu| {
            lists(gpu, SIZES[1], Some(60_000), (2, random_drops::<6000>))
        }),
        of("main_tiles_sort (one list)", |gpu| lists(gpu, SIZES[1], Some(9000), (2, random_drops::<9000>))),
        of("main_tiles_sort (two drops)", |gpu| lists(gpu, SIZES[0], None, (2, random_drops::<2>))),
        of("main_tiles_sort (whole tiles)", |gpu| lists(gpu, SIZES[1], None, (2, random_drops::<700>))),
        of("main_tiles_sort (more than 32 bits hold)", |gpu| {
            lists(gpu, [4096; 2], Some(1 << 14), (1, everywhere))
        }),
        KernelCase::new("main_tiles_seen", &TILES_SEEN_KERNEL, exact, seen_case),
    ]
}
