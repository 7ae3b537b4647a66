//! Counting bins: lists of numbered items by the bins that they touch.

/// Lists of items, bin by bin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bins {
    /// Index in `items` at which the list of each bin begins, and the end of the last one.
    pub starts: Vec<u32>,
    /// Numbers of the items, bin by bin; within a bin they rise.
    pub items: Vec<u32>,
}

impl Bins {
    /// Lists of the items 0 to `item_count - 1`. `touched` calls its second argument with each bin that an item touches, below
    /// `bin_count`, and is asked twice for each item.
    ///
    /// ```
    /// use downpour_math::bins::Bins;
    /// let reach = [[0, 1], [1, 2], [0, 2]];
    /// let bins = Bins::new(3, 3, |item, bin| (reach[item as usize][0]..=reach[item as usize][1]).for_each(bin));
    /// assert_eq!((bins.starts, bins.items), (vec![0, 2, 5, 7], vec![0, 2, 0, 1, 2, 1, 2]));
    /// ```
    ///
    /// # Panics
    /// If a bin is not below `bin_count`.
    #[must_use]
    pub fn new(bin_count: usize, item_count: u32, touched: impl Fn(u32, &mut dyn FnMut(usize))) -> Self {
        let mut starts = vec![0u32; bin_count + 1];
        for item in 0..item_count {
            touched(item, &mut |bin| starts[bin + 1] += 1);
        }
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        let mut next = starts.clone();
        let mut items = vec![0; sum as usize];
        for item in 0..item_count {
            touched(item, &mut |bin| {
                items[next[bin] as usize] = item;
                next[bin] += 1;
            });
        }
        Self { starts, items }
    }
}
