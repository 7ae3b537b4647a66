//! Constants shared by Rust and WGSL, declared once.

/// Declares constants for Rust and the [`Module`](crate::Module) that declares them for WGSL.
///
/// Values are numbers written without digit separators or type suffixes, so that both languages read the
/// same token. Tables are declared by [`shared_tables!`](crate::shared_tables).
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
        }
    ) => {
        $( $(#[$doc])* pub const $name: $ty = $value; )*
        $(#[$module_doc])*
        pub static $module: $crate::Module = $crate::Module {
            path: $path,
            wgsl: concat!(
                $( "const ", stringify!($name), ": ", stringify!($ty), " = ", stringify!($value), ";\n", )*
            ),
            uses: &[],
        };
    };
}

/// Declares tables of f32 for Rust and the [`Module`](crate::Module) that declares them for WGSL.
///
/// ```
/// mod light {
///     downpour_shaders::shared_tables! {
///         /// What the example looks up.
///         LIGHT_TABLES at "light/tables" {
///             /// Wavelengths in nanometers.
///             LIGHT_WAVELENGTHS: [f32; 3] = [611.0, 549.0, 464.0];
///         }
///     }
/// }
/// assert_eq!(light::LIGHT_WAVELENGTHS[1], 549.0);
/// assert_eq!(light::LIGHT_TABLES.wgsl, "const LIGHT_WAVELENGTHS = array<f32, 3>(611.0, 549.0, 464.0, );\n");
/// ```
#[macro_export]
macro_rules! shared_tables {
    (
        $(#[$module_doc:meta])*
        $module:ident at $path:literal {
            $( $(#[$doc:meta])* $name:ident : [f32; $len:literal] = [$($entry:expr),* $(,)?]; )*
        }
    ) => {
        $( $(#[$doc])* pub const $name: [f32; $len] = [$($entry),*]; )*
        $(#[$module_doc])*
        pub static $module: $crate::Module = $crate::Module {
            path: $path,
            wgsl: concat!(
                $( "const ", stringify!($name), " = array<f32, ", stringify!($len), ">(",
                   $( stringify!($entry), ", ", )* ");\n", )*
            ),
            uses: &[],
        };
    };
}
