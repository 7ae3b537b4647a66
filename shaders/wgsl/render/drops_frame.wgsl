// The picture as the drops' kernels know it: its camera, its capture, its masks.
// Twin: downpour_render::rain::drops_frame.

struct DropsFrame {
    // Not read: a software driver makes the kernel again for each value of the first word of a block that it reads.
    unread: u32,
    // Drops of the list.
    count: u32,
    // Classes, from the first, whose means are made before a drop asks for them.
    made_classes: u32,
    // Multiple of the light that a drop takes out and gives: 1 is what physics gives.
    visibility: f32,
    camera: RenderCamera,
    // Axes of the capture in the papers' form: the whole of it at distance 1.
    capture_right: vec3f,
    // Texels along an edge of the capture.
    capture_size: u32,
    capture_up: vec3f,
    // The coarsest level of the capture.
    capture_last: u32,
    capture_forward: vec3f,
    // Angle of a texel of the capture.
    capture_texel: f32,
    // The form of refraction: DROPS_DIRECTION or DROPS_SHIFT.
    form: u32,
    // Texels along an edge of a mask.
    mask_size: u32,
    // Number under which means of classes stay from picture to picture; 0: each picture finds its own.
    known: u32,
    // Terms of the formula of Rousseau 2006 for the light of lamps: DROP_LIGHT_EXTERNAL, DROP_LIGHT_INTERNAL, or both.
    light_terms: u32,
    // Samples along the chord of a streak that is averaged by a loop.
    streak_samples: u32,
    // The color of streaks: STREAK_REFRACTED, or STREAK_WHITE.
    streak_color: u32,
    // Rows of light of each drop besides its mean: glints, or streaks of the atlas.
    glints: u32,
    // First word of the atlas behind the masks; 0: there is none.
    atlas: u32,
}

@group(0) @binding(0) var<uniform> drops_frame: DropsFrame;
