//! The one comparer of CPU and GPU results.

use crate::signature::WordKind;
use crate::tolerance::Tol;

/// Word that fills an output buffer before a run. As an f32 it is a NaN; as a word it is none of the small numbers.
pub const POISON: u32 = 0x7fc0_dead;

/// Relative differences are taken to at least this.
pub const MIN_SCALE: f64 = 1.0e-30;

/// Words that the CPU computed. Only twins make these.
#[derive(Clone, Debug)]
pub struct Cpu(pub Vec<u32>);

/// Words that were read back from a GPU. Only readback makes these.
#[derive(Clone, Debug)]
pub struct Gpu(pub Vec<u32>);

/// The outcome of a comparison.
#[derive(Clone, Debug, Default)]
pub struct Comparison {
    /// Number of words that were compared.
    pub compared: usize,
    /// Number of words outside the tolerance.
    pub outside: usize,
    /// Largest absolute difference of numbers.
    pub worst_abs: f64,
    /// Largest relative difference of numbers, where the CPU's is above 1e-30.
    pub worst_rel: f64,
    /// Largest distance of numbers in units in the last place.
    pub worst_ulp: u32,
    /// Mean of the errors, each as a fraction of what is allowed and at most 1.
    pub mean: f64,
    /// Index of the word with the largest absolute difference, or of the first that is wrong in kind.
    pub worst_at: usize,
    /// Description of what is wrong, if anything.
    pub failure: Option<String>,
}

/// Compares word by word. `kinds` repeats along the words.
///
/// # Panics
/// If `kinds` is empty.
#[must_use]
pub fn compare(cpu: &Cpu, gpu: &Gpu, kinds: &[WordKind], tol: &Tol) -> Comparison {
    let mut out = Comparison { compared: cpu.0.len(), ..Comparison::default() };
    if cpu.0.is_empty() || cpu.0.len() != gpu.0.len() {
        out.failure = Some(format!("{} words from the CPU, {} from the GPU", cpu.0.len(), gpu.0.len()));
        return out;
    }
    let (mut first_wrong, mut used) = (None, 0.0);
    for (at, (&c, &g)) in cpu.0.iter().zip(&gpu.0).enumerate() {
        let wrong = if g == POISON && c != POISON {
            Some("the GPU did not write it".to_owned())
        } else if kinds[at % kinds.len()] == WordKind::Integer {
            (c != g).then(|| format!("CPU {c:#010x}, GPU {g:#010x}"))
        } else {
            let (a, b) = (f32::from_bits(c), f32::from_bits(g));
            if !a.is_finite() || !b.is_finite() {
                // Infinities of the same sign agree; NaN never does.
                (a != b || a.is_nan()).then(|| format!("CPU {a}, GPU {b}"))
            } else {
                let difference = (f64::from(a) - f64::from(b)).abs();
                let relative = difference / f64::from(a).abs().max(MIN_SCALE);
                let ulp = ulp_distance(a, b);
                if difference > out.worst_abs {
                    out.worst_abs = difference;
                    out.worst_at = at;
                }
                out.worst_rel = out.worst_rel.max(relative);
                out.worst_ulp = out.worst_ulp.max(ulp);
                let within = difference <= tol.abs || relative <= tol.rel || ulp <= tol.ulp;
                if within {
                    used += tol.used(difference, relative, ulp);
                }
                (!within).then(|| {
                    format!("CPU {a:e}, GPU {b:e}: {difference:e} apart, {relative:e} relative, {ulp} ulp")
                })
            }
        };
        if let Some(text) = wrong {
            used += 1.0;
            out.outside += 1;
            first_wrong.get_or_insert((at, text));
        }
    }
    let fraction = out.outside as f64 / out.compared as f64;
    if let Some((at, text)) = first_wrong.filter(|_| fraction > tol.outliers) {
        out.failure = Some(format!(
            "{} of {} words are outside {tol:?}; first at word {at}: {text}",
            out.outside, out.compared
        ));
    }
    out.mean = used / out.compared as f64;
    if out.failure.is_none() && out.mean > tol.mean {
        out.failure = Some(format!(
            "the errors are {:.2e} of what {tol:?} allows in the mean; {:.2e} at most",
            out.mean, tol.mean
        ));
    }
    out
}

/// Distance of two numbers in steps between neighboring representable numbers. Both zeros are the same number.
#[must_use]
pub fn ulp_distance(a: f32, b: f32) -> u32 {
    let order = |x: f32| {
        let bits = i64::from(x.to_bits());
        if bits & 0x8000_0000 == 0 { bits } else { 0x8000_0000 - bits }
    };
    u32::try_from((order(a) - order(b)).unsigned_abs()).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLOAT: &[WordKind] = &[WordKind::Float];
    const INTEGER: &[WordKind] = &[WordKind::Integer];

    fn of(values: &[f32]) -> Vec<u32> {
        values.iter().map(|v| v.to_bits()).collect()
    }

    fn fails(cpu: &[u32], gpu: &[u32], kinds: &[WordKind], tol: Tol) -> bool {
        compare(&Cpu(cpu.to_vec()), &Gpu(gpu.to_vec()), kinds, &tol).failure.is_some()
    }

    #[test]
    fn distance_in_the_last_place() {
        assert_eq!(ulp_distance(1.0, 1.0), 0);
        assert_eq!(ulp_distance(0.0, -0.0), 0);
        assert_eq!(ulp_distance(1.0, f32::from_bits(1.0f32.to_bits() + 3)), 3);
        assert_eq!(ulp_distance(f32::from_bits(2), -f32::from_bits(3)), 5);
        assert_eq!(ulp_distance(f32::MAX, f32::MIN), 2 * f32::MAX.to_bits());
    }

    #[test]
    fn what_must_fail_fails() {
        let exact = Tol::exact("test");
        let loose = Tol::absolute(1.0e9, "test");
        assert!(fails(&of(&[1.0]), &of(&[1.000_000_1]), FLOAT, exact), "one bit");
        assert!(fails(&[3], &[4], INTEGER, loose), "integers have no tolerance");
        assert!(fails(&of(&[1.0]), &[POISON], FLOAT, loose), "an untouched slot");
        assert!(fails(&[1], &[POISON], INTEGER, loose), "an untouched integer");
        assert!(fails(&of(&[f32::NAN]), &of(&[f32::NAN]), FLOAT, loose), "NaN on both sides");
        assert!(fails(&of(&[1.0]), &of(&[f32::INFINITY]), FLOAT, loose), "an infinity");
        assert!(fails(&[], &[], FLOAT, loose), "nothing at all");
        assert!(fails(&of(&[1.0]), &of(&[1.0, 1.0]), FLOAT, loose), "different lengths");
        let few = Tol::exact("test").with_outliers(0.1);
        let cpu = of(&[0.0; 10]);
        let mut gpu = cpu.clone();
        gpu[3] = 1.0f32.to_bits();
        assert!(!fails(&cpu, &gpu, FLOAT, few), "one of ten is allowed");
        gpu[4] = 1.0f32.to_bits();
        assert!(fails(&cpu, &gpu, FLOAT, few), "two of ten are not");
        let mean = |mean: f64| Tol { mean, ..Tol::absolute(2.0, "test") };
        let (cpu, gpu) = (of(&[0.0; 10]), of(&[0.1; 10]));
        assert!(!fails(&cpu, &gpu, FLOAT, mean(0.06)), "a twentieth of what is allowed");
        assert!(fails(&cpu, &gpu, FLOAT, mean(0.04)), "each is close enough, all of them are not");
    }

    #[test]
    fn what_must_pass_passes() {
        assert!(!fails(&of(&[1.0, -2.0]), &of(&[1.0, -2.0]), FLOAT, Tol::exact("test")));
        assert!(!fails(&of(&[1.0]), &of(&[1.0001]), FLOAT, Tol::relative(2.0e-4, 0.0, "test")));
        assert!(!fails(&of(&[0.0]), &of(&[-0.0]), FLOAT, Tol::exact("test")));
    }
}
