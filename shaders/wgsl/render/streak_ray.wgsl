// A ray of the profile of a streak, as streak_rays.wgsl makes it.
// Host type: downpour_render::rain::StreakRay.

struct StreakRay {
    // Directions in which its light leaves, octahedral, two numbers of 16 bits each: reflected outside, then the exits from inside.
    exits: vec4u,
    // Their fractions, two numbers of 16 bits each.
    fractions: vec2u,
    // Interfaces passed up to there, 8 bits each; 0: there is no such exit.
    interfaces: u32,
    unused: u32,
}
