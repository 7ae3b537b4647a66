//! Domains of the arguments of a function-level case.

use downpour_math::ops;
use downpour_math::rng::rng_draw;

/// The values that an argument (or a part of one) takes.
#[derive(Clone, Copy, Debug)]
pub enum Domain {
    /// A number, uniform between the two, both ends included among the first calls.
    Uniform(f32, f32),
    /// A positive number whose logarithm is uniform between those of the two.
    LogUniform(f32, f32),
    /// One of these numbers.
    OneOf(&'static [f32]),
    /// Any word.
    AnyWord,
    /// A word below this.
    Below(u32),
    /// A unit vector: three numbers.
    Unit3,
    /// Always this number.
    Fixed(f32),
    /// Words made by a function of four random words.
    Made(fn([u32; 4]) -> Vec<u32>),
    /// Another domain of one word; in every fourth call one of these numbers, where a branch has its edge.
    Or(&'static Domain, &'static [f32]),
}

impl Domain {
    /// The words of one value. The first calls of a case visit the ends of ranges; the later are random.
    fn words(&self, call: u32, argument: u32, out: &mut Vec<u32>) {
        let random = rng_draw([0x5eed, 7], call, argument, 0);
        // f64: a uniform number from 32 bits, ends included.
        let unit = f64::from(random[0]) / f64::from(u32::MAX);
        // Ends: bit `argument` of the call's number chooses, so that combinations of ends are met as well.
        let end = (call < 64).then(|| (call >> (argument % 6)) & 1 == 1);
        let between = |lo: f64, hi: f64| match end {
            Some(false) => lo,
            Some(true) => hi,
            None => lo + (hi - lo) * unit,
        };
        match *self {
            Self::Uniform(lo, hi) => out.push((between(lo.into(), hi.into()) as f32).to_bits()),
            Self::LogUniform(lo, hi) => {
                let value = match end {
                    Some(false) => lo,
                    Some(true) => hi,
                    None => {
                        let (a, b) = (ops::f64::ln(lo.into()), ops::f64::ln(hi.into()));
                        ops::f64::exp(a + (b - a) * unit) as f32
                    }
                };
                out.push(value.to_bits());
            }
            Self::OneOf(values) => out.push(values[random[0] as usize % values.len()].to_bits()),
            Self::AnyWord => out.push(match call {
                0 => 0,
                1 => u32::MAX,
                // Single bits, where fields of a word begin and halves of the range meet.
                2..34 => 1 << ((call + 5 * argument) % 32),
                _ => random[0],
            }),
            Self::Below(limit) => out.push(match end {
                Some(false) => 0,
                Some(true) => limit - 1,
                None => random[0] % limit,
            }),
            Self::Unit3 => {
                let axis = call as usize % 6;
                let v = if call < 64 && call.is_multiple_of(2) {
                    let mut v = [0.0f32; 3];
                    v[axis % 3] = if axis < 3 { 1.0 } else { -1.0 };
                    v
                } else {
                    let z = 2.0 * unit - 1.0;
                    let phi = std::f64::consts::TAU * f64::from(random[1]) / f64::from(u32::MAX);
                    let r = (1.0 - z * z).max(0.0).sqrt();
                    [(r * ops::f64::cos(phi)) as f32, (r * ops::f64::sin(phi)) as f32, z as f32]
                };
                out.extend(v.map(f32::to_bits));
            }
            Self::Fixed(value) => out.push(value.to_bits()),
            Self::Made(make) => out.extend(make(random)),
            Self::Or(_, values) if random[3].is_multiple_of(4) => {
                out.push(values[random[2] as usize % values.len()].to_bits());
            }
            Self::Or(other, _) => other.words(call, argument, out),
        }
    }

    /// The arguments of `calls` calls, all of the same length.
    ///
    /// # Panics
    /// If a [`Domain::Made`] makes different numbers of words.
    #[must_use]
    pub fn arguments(domains: &[Domain], calls: u32) -> Vec<Vec<u32>> {
        let all: Vec<Vec<u32>> = (0..calls)
            .map(|call| {
                let mut words = Vec::new();
                for (argument, domain) in (0..).zip(domains) {
                    domain.words(call, argument, &mut words);
                }
                words
            })
            .collect();
        assert!(all.windows(2).all(|w| w[0].len() == w[1].len()), "calls of different lengths");
        all
    }
}
