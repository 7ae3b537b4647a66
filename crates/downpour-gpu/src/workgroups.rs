//! Workgroups of any number, and the invocations in them: a row of workgroups is limited, so there are several.

/// Workgroups along a row: fewer than every device allows, and so few that tests have several rows.
const ALONG: u32 = 128;

/// Dispatch of so many workgroups or a few more: no dimension has more than every device allows.
#[must_use]
pub fn workgroups(count: u32) -> [u32; 3] {
    // Rows become longer where there would be too many.
    let along = ALONG.max(count.div_ceil(1 << 15));
    [count.min(along), count.div_ceil(along), 1]
}

/// Dispatch of workgroups of 64 for so many invocations, one workgroup at least: [`invocation_index`] numbers them.
#[must_use]
pub fn workgroups_for(invocations: u32) -> [u32; 3] {
    workgroups(invocations.div_ceil(64).max(1))
}

/// Number of an invocation among all of a dispatch of rows of workgroups of 64, by its global id and the number of workgroups. Twin
/// of the function of this name in `shaders/wgsl/common/invocation.wgsl`.
#[must_use]
pub fn invocation_index(id: [u32; 3], groups: [u32; 3]) -> u32 {
    id[1].wrapping_mul(groups[0]).wrapping_mul(64).wrapping_add(id[0])
}
