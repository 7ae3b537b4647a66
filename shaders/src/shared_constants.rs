//! Constants for both languages, declared once.

/// Declares constants for Rust and the [`Module`](crate::Module) that declares them for WGSL.
///
/// Values are numbers written without digit separators or type suffixes, so that both languages read the
/// same token. A table is `array NAME: [f32; 3] = [1.0, 2.0, 3.0];`.
///
/// ```
/// mod light {
///     use downpour_shaders::{Module, shared_constants};
///     shared_constants! {
///         /// What the optics of the example need.
///         LIGHT_CONSTANTS at "light/constants" {
///             /// Refractive index of water.
///             LIGHT_WATER_INDEX: f32 = 1.333;
///         }
///     }
/// }
/// assert_eq!(light::LIGHT_WATER_INDEX, 1.333);
/// assert_eq!(light::LIGHT_CONSTANTS.wgsl, "const LIGHT_WATER_INDEX: f32 = 1.333;\n");
/// ```
#[macro_export]
macro_rules! shared_constants {
    (
        $(#[$module_doc:meta])*
        $module:ident at $path:literal {
            $( $(#[$doc:meta])* $name:ident : $ty:ident = $value:expr; )*
            $( array $(#[$array_doc:meta])* $array:ident : [$element:ident; $len:literal] = [$($entry:expr),* $(,)?]; )*
        }
    ) => {
        $( $(#[$doc])* pub const $name: $ty = $value; )*
        $( $(#[$array_doc])* pub const $array: [$element; $len] = [$($entry),*]; )*
        $(#[$module_doc])*
        pub static $module: $crate::Module = $crate::Module {
            path: $path,
            wgsl: concat!(
                $( "const ", stringify!($name), ": ", stringify!($ty), " = ", stringify!($value), ";\n", )*
                $( "const ", stringify!($array), " = array<", stringify!($element), ", ", stringify!($len), ">(",
                   $( stringify!($entry), ", ", )* ");\n", )*
            ),
            uses: &[],
        };
    };
}
