//! Triangles in world space.

use crate::error::SceneError;
use crate::warning::Warning;

/// All triangles of a file as one mesh, in world space (meters, +Y up, counter-clockwise front faces).
///
/// Positions are finite and at most [`REACH`](super::REACH) from the origin in each coordinate, normals have
/// length 1, and each index is below the number of positions.
///
/// ```
/// use downpour_scene::gltf::TriangleModel;
/// let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 2.0, -1.0]];
/// let model = TriangleModel { positions, indices: vec![[0, 1, 2]], ..TriangleModel::default() };
/// assert_eq!(model.bounds(), Some(([0.0, 0.0, -1.0], [1.0, 2.0, 0.0])));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleModel {
    /// Name of the file in messages.
    pub name: String,
    /// Vertices, in meters.
    pub positions: Vec<[f32; 3]>,
    /// A unit normal for each position; `None` when the file has no normals at all.
    pub normals: Option<Vec<[f32; 3]>>,
    /// Three indices into `positions` for each triangle.
    pub indices: Vec<[u32; 3]>,
    /// Parts that were dropped or repaired.
    pub warnings: Vec<Warning>,
}

impl TriangleModel {
    /// True if there are no triangles.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.indices.is_empty()
    }

    /// Smallest and largest coordinates of all positions, in meters; `None` without positions.
    #[must_use]
    pub fn bounds(&self) -> Option<([f32; 3], [f32; 3])> {
        let merge = |(low, high): ([f32; 3], [f32; 3]), (l, h): ([f32; 3], [f32; 3])| {
            let pick = |a: [f32; 3], b: [f32; 3], f: fn(f32, f32) -> f32| {
                let ([ax, ay, az], [bx, by, bz]) = (a, b);
                [f(ax, bx), f(ay, by), f(az, bz)]
            };
            (pick(low, l, f32::min), pick(high, h, f32::max))
        };
        self.positions.iter().map(|&position| (position, position)).reduce(merge)
    }

    /// Strict form: the same model, unless geometry was dropped or there is none.
    ///
    /// # Errors
    /// [`SceneError::BadInput`] with the text of the first warning of a loss.
    pub fn strict(self) -> Result<Self, SceneError> {
        match self.warnings.iter().find(|warning| warning.kind.is_loss()) {
            None => Ok(self),
            Some(loss) => {
                let error = SceneError::bad(
                    &loss.location,
                    loss.what.as_str(),
                    "a file of which all geometry is of use",
                );
                Err(error.in_file(&self.name))
            }
        }
    }

    /// Size of the geometry in memory, in bytes.
    pub(super) fn bytes(&self) -> u64 {
        let vectors = self.positions.len().saturating_add(self.normals.as_ref().map_or(0, Vec::len));
        (vectors.saturating_add(self.indices.len()) as u64).saturating_mul(12)
    }
}
