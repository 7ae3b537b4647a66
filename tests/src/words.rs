//! Arguments and results as 32-bit words, the form in which they travel to a shader and back.

/// Reads the arguments of one call in their order.
#[derive(Debug)]
pub struct Args<'a> {
    words: &'a [u32],
}

impl<'a> Args<'a> {
    /// Starts at the first word.
    #[must_use]
    pub fn new(words: &'a [u32]) -> Self {
        Self { words }
    }

    /// The next word.
    pub fn u32(&mut self) -> u32 {
        let (first, rest) =
            self.words.split_first().expect("the case reads more words than its domains give");
        self.words = rest;
        *first
    }

    /// The next number.
    pub fn f32(&mut self) -> f32 {
        f32::from_bits(self.u32())
    }

    /// The next `N` numbers.
    pub fn f32s<const N: usize>(&mut self) -> [f32; N] {
        std::array::from_fn(|_| self.f32())
    }

    /// The next `N` words.
    pub fn u32s<const N: usize>(&mut self) -> [u32; N] {
        std::array::from_fn(|_| self.u32())
    }

    /// True if all words were read.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.words.is_empty()
    }
}

/// A result of a twin as words.
pub trait IntoWords {
    /// Appends the words.
    fn append(&self, words: &mut Vec<u32>);

    /// The words alone.
    fn words(&self) -> Vec<u32> {
        let mut words = Vec::new();
        self.append(&mut words);
        words
    }
}

impl IntoWords for f32 {
    fn append(&self, words: &mut Vec<u32>) {
        words.push(self.to_bits());
    }
}

impl IntoWords for u32 {
    fn append(&self, words: &mut Vec<u32>) {
        words.push(*self);
    }
}

impl IntoWords for i32 {
    fn append(&self, words: &mut Vec<u32>) {
        words.push(self.cast_unsigned());
    }
}

impl IntoWords for bool {
    fn append(&self, words: &mut Vec<u32>) {
        words.push(u32::from(*self));
    }
}

impl<T: IntoWords, const N: usize> IntoWords for [T; N] {
    fn append(&self, words: &mut Vec<u32>) {
        for item in self {
            item.append(words);
        }
    }
}

impl<A: IntoWords, B: IntoWords> IntoWords for (A, B) {
    fn append(&self, words: &mut Vec<u32>) {
        self.0.append(words);
        self.1.append(words);
    }
}
