//! Cache of what the CPU works out for a case, for the next run of it: twins do not change from mutant to mutant.

use std::any::Any;
use std::collections::HashMap;
use std::fmt::{Debug, Write as _};
use std::hash::{DefaultHasher, Hasher as _};
use std::sync::{Arc, Mutex, PoisonError};

type Values = HashMap<String, Arc<dyn Any + Send + Sync>>;

static VALUES: Mutex<Option<Values>> = Mutex::new(None);

/// Keeps values from now on. Without this call nothing is kept: a test runs each case once.
pub fn keep() {
    VALUES.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_default();
}

/// The value of a key, which names all that the value depends on: kept, or made now.
///
/// # Panics
/// If two types of values have the same key.
pub fn kept<T: Send + Sync + 'static>(key: &str, make: impl FnOnce() -> T) -> Arc<T> {
    let found = {
        let values = VALUES.lock().unwrap_or_else(PoisonError::into_inner);
        values.as_ref().map(|values| values.get(key).cloned())
    };
    match found {
        None => Arc::new(make()),
        Some(Some(value)) => value.downcast().expect("one type for each key"),
        Some(None) => {
            let made = Arc::new(make());
            let value: Arc<dyn Any + Send + Sync> = made.clone();
            if let Some(values) = VALUES.lock().unwrap_or_else(PoisonError::into_inner).as_mut() {
                values.insert(key.to_owned(), value);
            }
            made
        }
    }
}

/// A number of all that a value prints as, for keys: equal values have the same.
#[must_use]
pub fn digest(value: &impl Debug) -> u64 {
    let mut text = Text(DefaultHasher::new());
    // Hashing does not fail.
    let _ = write!(text, "{value:?}");
    text.0.finish()
}

struct Text(DefaultHasher);

impl std::fmt::Write for Text {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        self.0.write(text.as_bytes());
        Ok(())
    }
}
