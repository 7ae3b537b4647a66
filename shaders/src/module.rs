//! Shader modules, and their composition into the text of a pipeline.

/// One WGSL file and the modules whose names it uses.
#[derive(Debug)]
pub struct Module {
    /// Path of the text below `shaders/wgsl` (or below `shaders/src` for shared constants).
    pub path: &'static str,
    /// WGSL text.
    pub wgsl: &'static str,
    /// Modules whose functions, types or constants the text names directly.
    pub uses: &'static [&'static Module],
}

/// A compute entry point.
#[derive(Debug)]
pub struct Kernel {
    /// Name of the entry point: `main_<stem>`.
    pub entry: &'static str,
    /// Module that contains the entry point.
    pub module: &'static Module,
    /// Workgroup size, as written in the WGSL (a test compares the two).
    pub workgroup: [u32; 3],
}

impl Kernel {
    /// Complete WGSL text of the kernel.
    #[must_use]
    pub fn source(&self) -> String {
        compose(&[self.module])
    }
}

/// Concatenates `roots` and all modules that they use, each once and after the modules that it uses.
///
/// Modules are identified by [`Module::path`]. The order depends on the modules only, so the same
/// roots give the same text.
#[must_use]
pub fn compose(roots: &[&'static Module]) -> String {
    let mut order: Vec<&'static Module> = Vec::new();
    for root in roots {
        visit(root, &mut order);
    }
    let mut text = String::with_capacity(order.iter().map(|m| m.wgsl.len() + m.path.len() + 16).sum());
    for module in order {
        text.push_str("// ---- ");
        text.push_str(module.path);
        text.push('\n');
        text.push_str(module.wgsl);
        if !module.wgsl.ends_with('\n') {
            text.push('\n');
        }
    }
    text
}

fn visit(module: &'static Module, order: &mut Vec<&'static Module>) {
    if order.iter().any(|m| m.path == module.path) {
        return;
    }
    for used in module.uses {
        visit(used, order);
    }
    // A module that is reached again through its own uses was added by the inner visit.
    if !order.iter().any(|m| m.path == module.path) {
        order.push(module);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    static BASE: Module = Module { path: "base", wgsl: "const A = 1;", uses: &[] };
    static LEFT: Module = Module { path: "left", wgsl: "const B = A;", uses: &[&BASE] };
    static RIGHT: Module = Module { path: "right", wgsl: "const C = A;", uses: &[&BASE] };
    static TOP: Module = Module { path: "top", wgsl: "const D = B + C;", uses: &[&LEFT, &RIGHT] };

    #[test]
    fn a_diamond_is_written_once_and_in_order() {
        let text = compose(&[&TOP, &LEFT]);
        let at = |name: &str| text.find(name).unwrap();
        assert_eq!(text.matches("const A").count(), 1);
        assert_eq!(text.matches("const B").count(), 1);
        assert!(at("const A") < at("const B") && at("const B") < at("const D"));
        assert!(at("const C") < at("const D"));
    }
}
