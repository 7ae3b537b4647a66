//! The pane of a weather on a GPU and on the CPU.
#![cfg(feature = "wgpu")]

mod device;

use std::error::Error;

use downpour::gpu::LimitSet;
use downpour::render::camera::Viewpoint;
use downpour::render::glass::{PaneLattice, WetPane};
use downpour::weather::Weather;
use glam::Vec3;

/// Rain for seconds in a wind that grows, a wiper, steps of any length: a pane on a GPU is that of the CPU, to the bit.
#[test]
fn a_pane_on_a_gpu_is_that_of_the_cpu() -> Result<(), Box<dyn Error>> {
    let text = "[rain]\nrate_mm_h = 60\nseed = 5\n[camera]\nposition_m = [0, 1.5, 0]\npitch_deg = 0\n[glass]\nbefore_s = 2\n\
                speed_m_s = [[-2, 0], [0, 8], [1, 3]]\nsize_m = [0.1, 0.08]\n[[glass.wiper]]\npivot_m = [0.05, 0.09]\n\
                length_m = 0.08\nfrom_deg = 20\nto_deg = 160\nperiod_s = 1.3\n";
    let weather = Weather::parse("w.toml", text)?;
    let eye = Viewpoint { eye: Vec3::new(0.0, 1.5, 0.0), forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: 0.87 };
    let Some(gpu) = device::gpu(LimitSet::Adapter) else { return Ok(()) };
    let mut on_cpu = WetPane::new(&weather, &eye, 0.0)?.ok_or("no pane")?;
    let mut on_gpu = WetPane::on_gpu(&gpu, &weather, &eye, 0.0)?.ok_or("no pane")?;
    assert!(matches!(on_gpu.lattice(), PaneLattice::Gpu(_)));
    let dry = on_gpu.state()?.clone();
    for time_s in [-1.99, -0.6, 0.0, 0.31] {
        on_cpu.advance(time_s)?;
        on_gpu.advance(time_s)?;
        assert_eq!(on_gpu.time_s().to_bits(), on_cpu.time_s().to_bits());
        assert!(on_gpu.state()? == on_cpu.state()?, "at {time_s} s");
    }
    let state = on_gpu.state()?;
    assert!(*state != dry && state.mass.iter().filter(|mass| **mass > 0).count() > 20);
    assert!(state.traversal.iter().any(|wet| *wet > 0) && state.motion.iter().any(|word| word[0] != 0));
    assert_eq!(on_gpu.shade()?.is_some(), on_cpu.shade()?.is_some());
    Ok(())
}
