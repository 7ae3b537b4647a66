//! Shaders that are wrong on purpose: the third kind of negative control.
//!
//! Each breaks one thing that a slip of the hand could break, in a constant or in the text, and has to be seen by
//! the case that covers it.

use downpour_shaders::compose;

use crate::FunctionCase;
use crate::relay::Swap;

/// One wrong shader.
#[derive(Clone, Copy, Debug)]
pub struct Broken {
    /// The function whose case has to go red.
    pub function: &'static str,
    /// Correct text in the shader.
    pub right: &'static str,
    /// Wrong text that replaces it.
    pub wrong: &'static str,
}

/// Changes that only the run of a whole kernel shows: each with the case that has to see it.
pub const BROKEN_KERNELS: &[(&str, Broken)] = &[
    (
        "main_glass_decide: a strip, whose drops run along its sides",
        Broken {
            function: "glass_decide_weight",
            right: "var affinity = 128u;",
            wrong: "var affinity = 127u;",
        },
    ),
    (
        "main_trace: water on a bank",
        Broken { function: "puddle_water_find", right: "upward > 0.7;", wrong: "upward > 0.72;" },
    ),
    (
        "main_tone: edges of lights, glow",
        Broken {
            function: "tone_edges",
            right: "let beyond = tone_seen(at + way * 2);",
            wrong: "let beyond = tone_seen(at + way);",
        },
    ),
];

/// All that a function-level case has to see.
pub const BROKEN: &[Broken] = &[
    Broken {
        function: "rng_pcg4d",
        right: "RNG_PCG_MULTIPLIER: u32 = 1664525",
        wrong: "RNG_PCG_MULTIPLIER: u32 = 1664527",
    },
    Broken { function: "rng_draw", right: "seed.y, 0u, 0u, dimension", wrong: "seed.y, 0u, 0u, 0u" },
    Broken { function: "packing_octahedral_decode", right: "max(-z, 0.0)", wrong: "max(z, 0.0)" },
    Broken {
        function: "optics_fresnel_tatarchuk",
        right: "OPTICS_TATARCHUK_BASE: f32 = 0.05",
        wrong: "OPTICS_TATARCHUK_BASE: f32 = 0.0501",
    },
    Broken { function: "fall_speed_brandes_2002", right: "0.07934", wrong: "0.07935" },
    Broken { function: "fall_speed_beard_flattened", right: "0.00533035", wrong: "0.00533135" },
    Broken {
        function: "mask_trace_meet",
        right: "MASK_TRACE_STEPS: u32 = 4",
        wrong: "MASK_TRACE_STEPS: u32 = 1",
    },
    Broken {
        function: "mask_trace_through",
        right: "1.0 / traced.index).xyz",
        wrong: "1.0 / (traced.index + 0.001)).xyz",
    },
    Broken {
        function: "mask_silhouette_cut",
        right: "MASK_EDGE_DEPTH: f32 = 0.1",
        wrong: "MASK_EDGE_DEPTH: f32 = 0.3",
    },
    Broken {
        function: "puddle_water_albedo",
        right: "PUDDLE_WATER_INSIDE: f32 = 0.4745906",
        wrong: "PUDDLE_WATER_INSIDE: f32 = 0.4645906",
    },
    Broken {
        function: "puddle_water_refracted",
        right: "normal * (eta * cosine - inner)",
        wrong: "normal * (cosine - inner)",
    },
    Broken { function: "atlas_light", right: "cross(y, view)", wrong: "cross(view, y)" },
    Broken { function: "atlas_map", right: "abs(direction.x)", wrong: "direction.x" },
    Broken { function: "atlas_position", right: "- high) * high_inverse", wrong: "- high) * low_inverse" },
    Broken { function: "atlas_corner", right: "(corner & 2u) == 2u", wrong: "(corner & 1u) == 1u" },
    Broken { function: "atlas_cell", right: "vec2f(cells - 1.0)", wrong: "vec2f(cells)" },
    Broken { function: "atlas_draw", right: "id, which, ATLAS", wrong: "id, 0u, ATLAS" },
    Broken { function: "specimen_lamp", right: "apart) < lamp.reach", wrong: "apart) > lamp.reach" },
    Broken { function: "specimen_wobble_surface", right: "- 15.0 * state.y", wrong: "- 14.0 * state.y" },
    Broken {
        function: "specimen_wobble_cross",
        right: "found = side * at_b.x > 0.0",
        wrong: "found = at_b.x > 0.0",
    },
    Broken {
        function: "specimen_streak_passage",
        right: "level / streak.inverse_tall",
        wrong: "level / streak.inverse_wide",
    },
    Broken { function: "puddle_laplacian", right: "(nw + ne) + (sw + se)", wrong: "(nw + ne) + (sw + sw)" },
    Broken {
        function: "puddle_corner",
        right: "links, bits.y), links, bits.x)",
        wrong: "links, bits.x), links, bits.y)",
    },
    Broken { function: "puddle_normal_slopes", right: "2.0 * (e - w)", wrong: "2.0 * (w - e)" },
    Broken { function: "wind_primitive_updraft", right: "along - height", wrong: "along + height" },
    Broken {
        function: "wind_primitive_lamb_oseen",
        right: "WIND_PRIMITIVE_SERIES: f32 = 0.25",
        wrong: "WIND_PRIMITIVE_SERIES: f32 = 1.5",
    },
    Broken { function: "wind_turbulence_wave", right: "8.3333333e-3", wrong: "8.3343333e-3" },
    Broken {
        function: "collision_depths",
        right: "above = max(above, texel.depths[k]",
        wrong: "above = max(0.0, texel.depths[k]",
    },
    Broken {
        function: "collision_column",
        right: "if !collision_solid(texel.surfaces[layer])",
        wrong: "if collision_solid(texel.surfaces[layer])",
    },
    Broken { function: "glass_motion_slide", right: "if size <= hold", wrong: "if size > hold" },
    Broken {
        function: "glass_motion_turn",
        right: "(v * 3 + along) / 4",
        wrong: "(v * 3 + along) >> vec2u(2u)",
    },
    Broken { function: "streak_span", right: "* (1.0 - ratio) / ratio", wrong: "* (ratio - 1.0) / ratio" },
    Broken { function: "streak_cell_weight", right: "5.0 / 12.0", wrong: "4.0 / 12.0" },
    Broken { function: "drop_glint_pixel", right: "(1.0 - offset.x)", wrong: "(0.9 - offset.x)" },
    Broken { function: "drop_glint_angle", right: "0.25 - octant", wrong: "0.25 + octant" },
    Broken { function: "drop_glint_rousseau", right: "across * (1.0 + lit)", wrong: "across * (1.0 - lit)" },
    Broken { function: "streak_weight", right: "(weights.y - weights.x)", wrong: "(weights.y + weights.x)" },
    Broken { function: "drop_light_mean", right: "- towards * sqrt", wrong: "+ towards * sqrt" },
    Broken { function: "glass_picture_water_cap", right: "+ l.y * (2.0 * x * y)", wrong: "+ l.y * (x * y)" },
    Broken { function: "glass_picture_water_leave", right: "side == 2", wrong: "side == 1" },
    Broken { function: "glass_picture_spline", right: "0.75 - t * t", wrong: "0.75 + t * t" },
    Broken {
        function: "wind_field_mix",
        right: "(c10 - c00) * fraction.y",
        wrong: "(c10 - c00) * fraction.x",
    },
];

impl Broken {
    /// The change as a relay makes it.
    #[must_use]
    pub fn swap(&self) -> Swap {
        let [function, right, wrong] = [self.function, self.right, self.wrong].map(str::to_owned);
        Swap { function, right, wrong }
    }

    /// The case, and the wrong text of its shader.
    ///
    /// # Panics
    /// If there is no such case, or the right text is not in its shader.
    #[must_use]
    pub fn shader(&self, cases: &[FunctionCase]) -> (FunctionCase, String) {
        let case = cases.iter().find(|case| case.function == self.function);
        let case = case.unwrap_or_else(|| panic!("no case for {}", self.function)).clone();
        let right = compose(&[case.module]);
        assert!(right.contains(self.right), "\"{}\" is not in the shader of {}", self.right, self.function);
        let wrong = right.replace(self.right, self.wrong);
        (case, wrong)
    }
}
