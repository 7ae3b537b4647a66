//! `downpour adapters`: GPUs and their capabilities.

use clap::Args;

use crate::failure::Failure;

/// List the GPUs, the one that is taken by default first.
#[derive(Debug, Args)]
pub(crate) struct AdaptersArguments {
    /// Write JSON: an array of objects.
    #[arg(long)]
    json: bool,
}

#[cfg(not(feature = "gpu"))]
impl AdaptersArguments {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        if self.json {
            crate::stream::print("[]\n")?;
        }
        Err(crate::backend::no_support())
    }
}

#[cfg(feature = "gpu")]
impl AdaptersArguments {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        use downpour::gpu::adapter::adapters;
        use downpour::gpu::{AdapterChoice, Gpu};
        use serde_json::Value;

        let found = adapters();
        if self.json {
            let list = found.iter().map(gpu::json).collect();
            crate::stream::print(&format!("{:#}\n", Value::Array(list)))?;
        } else {
            let texts: Vec<String> = found.iter().map(gpu::text).collect();
            crate::stream::print(&texts.join("\n"))?;
        }
        if found.is_empty() {
            // The error of opening one names the drivers that were tried.
            Gpu::open(&AdapterChoice::Auto)?;
        }
        Ok(())
    }
}

#[cfg(feature = "gpu")]
mod gpu {
    use downpour::gpu::AdapterDescription;
    use serde_json::{Value, json};

    pub(super) fn json(a: &AdapterDescription) -> Value {
        json!({
            "name": a.name,
            "driver": a.driver,
            "driver_info": a.driver_info,
            "backend": a.backend,
            "kind": a.kind,
            "software": a.is_software(),
            "timestamps": a.timestamps,
            "float32_filterable": a.float32_filterable,
            "shader_f16": a.shader_f16,
            "subgroups": a.subgroups,
            "max_texture_2d": a.max_texture_2d,
            "max_texture_layers": a.max_texture_layers,
            "max_buffer_bytes": a.max_buffer_bytes,
            "max_storage_binding_bytes": a.max_storage_binding_bytes,
            "max_invocations_per_workgroup": a.max_invocations_per_workgroup,
        })
    }

    pub(super) fn text(a: &AdapterDescription) -> String {
        let mebibytes = |bytes: u64| format!("{} MiB", bytes >> 20);
        let can: Vec<&str> = [
            ("timestamps", a.timestamps),
            ("filtered 32-bit float textures", a.float32_filterable),
            ("16-bit floats in shaders", a.shader_f16),
            ("subgroups", a.subgroups),
        ]
        .iter()
        .filter_map(|&(name, has)| has.then_some(name))
        .collect();
        let lines = [
            ("kind", format!("{}, by {}", a.kind, a.backend)),
            ("driver", format!("{} {}", a.driver, a.driver_info)),
            ("can", can.join(", ")),
            ("textures", format!("up to {0} x {0}, {1} layers", a.max_texture_2d, a.max_texture_layers)),
            ("buffers", format!("up to {}", mebibytes(a.max_buffer_bytes))),
            ("seen by a shader", format!("up to {}", mebibytes(a.max_storage_binding_bytes))),
            ("workgroups", format!("up to {} invocations", a.max_invocations_per_workgroup)),
        ];
        let lines: String = lines.iter().map(|(label, value)| format!("  {label:<16}  {value}\n")).collect();
        format!("{}\n{lines}", a.name)
    }
}
