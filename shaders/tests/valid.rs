//! Every module is valid WGSL together with what it uses.

#[test]
fn modules_are_valid() {
    for module in downpour_shaders::modules() {
        let text = downpour_shaders::compose(&[module]);
        let parsed = naga::front::wgsl::parse_str(&text)
            .unwrap_or_else(|error| panic!("{}: {}", module.path, error.emit_to_string(&text)));
        let flags = naga::valid::ValidationFlags::all();
        // WGSL has `pack2x16float` everywhere; naga counts it apart.
        let halves = naga::valid::Capabilities::SHADER_FLOAT16_IN_FLOAT32;
        naga::valid::Validator::new(flags, halves)
            .validate(&parsed)
            .unwrap_or_else(|error| panic!("{}: {}", module.path, error.emit_to_string(&text)));
    }
}
