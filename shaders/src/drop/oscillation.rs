//! `wgsl/drop/oscillation.wgsl`. Twin: `downpour_drop::oscillation`.

use crate::Module;
use crate::common::RNG;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&OSCILLATION_CONSTANTS, &OSCILLATION];

/// Oscillation of drops.
pub static OSCILLATION: Module = Module {
    path: "drop/oscillation.wgsl",
    wgsl: include_str!("../../wgsl/drop/oscillation.wgsl"),
    uses: &[&OSCILLATION_CONSTANTS, &RNG],
};

shared_constants! {
    /// Constants of the oscillation.
    OSCILLATION_CONSTANTS at "drop/oscillation constants" {
        /// 2^-16: a tick in seconds, and the unit of a frequency in Hz.
        DROP_OSCILLATION_TICK: f32 = 1.5258789e-5;
        /// 2^16 / (2 pi): units of frequency in one radian per second.
        DROP_OSCILLATION_UNITS_PER_RADIAN: f32 = 10430.378;
        /// Largest number that both an f32 and a u32 can hold.
        DROP_OSCILLATION_MAX_FREQUENCY: f32 = 4294967040.0;
        /// 2^-24: a turn has 2^24 parts, the resolution of an f32 in [0, 1).
        DROP_OSCILLATION_TURN_STEP: f32 = 5.9604645e-8;
        /// One turn in radians.
        DROP_OSCILLATION_TURN: f32 = 6.2831855;
        /// The dimension of the random numbers that are used here: modes (2,0) and (3,1).
        DROP_OSCILLATION_DIMENSION: u32 = 2031;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_and_laid_out_as_the_host_has_it() {
        let source = crate::compose(&[&OSCILLATION]);
        let module = naga::front::wgsl::parse_str(&source).expect("the shader parses");
        naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty())
            .validate(&module)
            .expect("the shader is valid");
        for (name, size, offsets) in
            [("DropOscillation", 32, &[0, 8, 16, 24][..]), ("DropOscillationTime", 8, &[0, 4][..])]
        {
            let (_, found) = module
                .types
                .iter()
                .find(|(_, t)| t.name.as_deref() == Some(name))
                .expect("the struct is there");
            let naga::TypeInner::Struct { members, span } = &found.inner else { panic!("not a struct") };
            assert_eq!(*span, size, "{name}");
            assert_eq!(members.iter().map(|m| m.offset).collect::<Vec<_>>(), offsets, "{name}");
        }
    }

    #[test]
    fn constants_are_what_they_say() {
        assert_eq!(DROP_OSCILLATION_TICK * 65536.0, 1.0);
        assert_eq!(DROP_OSCILLATION_TURN_STEP * 16_777_216.0, 1.0);
        assert_eq!(DROP_OSCILLATION_TURN, std::f32::consts::TAU);
        let per_radian = 65536.0 / std::f64::consts::TAU;
        assert_eq!(DROP_OSCILLATION_UNITS_PER_RADIAN, per_radian as f32);
        assert_eq!(DROP_OSCILLATION_MAX_FREQUENCY as u32, u32::MAX - 255);
    }
}
