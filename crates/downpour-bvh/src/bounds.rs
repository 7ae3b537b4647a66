//! Bounding boxes.

/// A box along the axes.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) low: [f32; 3],
    pub(crate) high: [f32; 3],
}

impl Bounds {
    /// The bounds of nothing.
    pub(crate) const NONE: Self = Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] };

    /// With a point.
    pub(crate) fn with(self, point: [f32; 3]) -> Self {
        Self {
            low: std::array::from_fn(|k| self.low[k].min(point[k])),
            high: std::array::from_fn(|k| self.high[k].max(point[k])),
        }
    }

    /// With all of another box.
    pub(crate) fn union(self, other: Self) -> Self {
        self.with(other.low).with(other.high)
    }

    /// The intersection of two boxes, which may be flat.
    pub(crate) fn common(self, other: &Self) -> Option<Self> {
        let low: [f32; 3] = std::array::from_fn(|k| self.low[k].max(other.low[k]));
        let high: [f32; 3] = std::array::from_fn(|k| self.high[k].min(other.high[k]));
        (0..3).all(|k| low[k] <= high[k]).then_some(Self { low, high })
    }
}
