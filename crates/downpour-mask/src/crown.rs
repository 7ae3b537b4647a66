//! Crown of a splash as a closed mesh.

use downpour_drop::splash::crown;

use crate::{ClosedMesh, MaskError};

impl ClosedMesh {
    /// Crown of a splash at a stage, 0 to 1, in its largest radii: the middle of its height is at the origin, as
    /// [`crown::middle`] has it, and not its centroid.
    ///
    /// ```
    /// use downpour_mask::ClosedMesh;
    /// assert!(ClosedMesh::crown(0.125)?.positions.iter().all(|[_, y, _]| y.abs() < 0.5));
    /// # Ok::<(), downpour_mask::MaskError>(())
    /// ```
    ///
    /// # Errors
    /// As [`ClosedMesh::new`], for a stage that is no number.
    pub fn crown(stage: f64) -> Result<Self, MaskError> {
        let crown = crown::mesh(stage);
        let closed = Self::new(&crown.positions, None, &crown.triangles)?;
        let middle = crown::middle(stage) as f32;
        let positions = crown.positions.iter().map(|[x, y, z]| [*x, y - middle, *z]).collect();
        Ok(Self { positions, ..closed })
    }
}
