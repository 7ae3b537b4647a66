//! `wgsl/drop/shape.wgsl`. Twin: `downpour_drop::shape`.

use crate::Module;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&SHAPE];

/// The equilibrium shape of a falling drop.
pub static SHAPE: Module =
    Module { path: "drop/shape.wgsl", wgsl: include_str!("../../wgsl/drop/shape.wgsl"), uses: &[] };

#[cfg(test)]
mod tests {
    use super::*;

    /// The host's struct is three vectors of 16 bytes.
    #[test]
    fn valid_and_laid_out_as_the_host_has_it() {
        let source = crate::compose(&[&SHAPE]);
        let module = naga::front::wgsl::parse_str(&source).expect("the shader parses");
        naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty())
            .validate(&module)
            .expect("the shader is valid");
        let (_, found) = module
            .types
            .iter()
            .find(|(_, t)| t.name.as_deref() == Some("DropShapeCoefficients"))
            .expect("the struct is there");
        let naga::TypeInner::Struct { members, span } = &found.inner else { panic!("not a struct") };
        assert_eq!(*span, 48);
        assert_eq!(members.iter().map(|m| m.offset).collect::<Vec<_>>(), [0, 16, 32]);
    }
}
