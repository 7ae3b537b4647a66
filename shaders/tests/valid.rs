//! Every module is valid WGSL together with what it uses.

#[test]
fn modules_are_valid() {
    for module in downpour_shaders::modules() {
        let text = downpour_shaders::compose(&[module]);
        let parsed = naga::front::wgsl::parse_str(&text)
            .unwrap_or_else(|error| panic!("{}: {}", module.path, error.emit_to_string(&text)));
        let flags = naga::valid::ValidationFlags::all();
        naga::valid::Validator::new(flags, naga::valid::Capabilities::empty())
            .validate(&parsed)
            .unwrap_or_else(|error| panic!("{}: {}", module.path, error.emit_to_string(&text)));
    }
}
