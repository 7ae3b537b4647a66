//! Every WGSL function has a case, and every case a function.

use std::collections::BTreeSet;

use downpour_shaders::{kernels, modules};
use downpour_tests::kernel::OWN_ENTRY;
use downpour_tests::signature::all_functions;
use downpour_tests::{cases, mean_errors};

/// Functions that function-level cases name, and those that the kernels of kernel-level cases call according to naga.
fn covered() -> BTreeSet<String> {
    let named = cases::functions().into_iter().map(|case| case.function.to_owned());
    let called = cases::kernels().into_iter().flat_map(|case| case.reaches());
    named.chain(called).filter(|name| name != OWN_ENTRY).collect()
}

#[test]
fn every_function_has_a_case() {
    let allowed: BTreeSet<String> = cases::ALLOWED.iter().map(|(name, _)| (*name).to_owned()).collect();
    let covered = covered();
    let missing: Vec<_> =
        all_functions().into_iter().filter(|f| !covered.contains(f) && !allowed.contains(f)).collect();
    assert!(missing.is_empty(), "WGSL functions without a parity case: {missing:?}");
}

#[test]
fn every_case_has_a_function() {
    let all = all_functions();
    let stale: Vec<_> = covered().into_iter().filter(|f| !all.contains(f)).collect();
    assert!(stale.is_empty(), "cases for functions that are not in any shader: {stale:?}");
}

#[test]
fn the_allow_list_is_short_and_honest() {
    let (all, covered) = (all_functions(), covered());
    for (name, reason) in cases::ALLOWED {
        assert!(all.contains(*name), "{name} is allowed but does not exist");
        assert!(!covered.contains(*name), "{name} is allowed but has a case");
        assert!(reason.len() > 20, "{name}: a reason is a sentence");
    }
}

#[test]
fn every_kernel_has_a_case() {
    let cases = cases::kernels();
    for kernel in kernels() {
        assert!(
            cases.iter().any(|case| {
                case.entry() == kernel.entry || case.with.iter().any(|with| with.entry == kernel.entry)
            }),
            "kernel {} has no parity case",
            kernel.entry
        );
    }
}

#[test]
fn names_carry_their_stem() {
    for module in modules() {
        let Some(stem) = module.path.strip_suffix(".wgsl").and_then(|p| p.rsplit('/').next()) else {
            continue;
        };
        let folder = module.path.split('/').next().unwrap_or_default();
        for line in module.wgsl.lines() {
            let Some(rest) = line.strip_prefix("fn ") else { continue };
            let name = rest.split('(').next().unwrap_or_default();
            let fits = name == stem
                || name.starts_with(&format!("{stem}_"))
                || name.starts_with(&format!("{folder}_{stem}_"))
                || name == format!("main_{stem}")
                || name.starts_with(&format!("main_{stem}_"))
                || name.starts_with(&format!("main_{folder}_{stem}"));
            assert!(fits, "{}: function {name} does not carry its stem", module.path);
        }
    }
}

#[test]
fn every_tolerance_has_a_reason() {
    for case in cases::functions() {
        assert!(case.tol.why.len() > 10, "{}", case.function);
        assert!(case.calls >= 256, "{}", case.function);
    }
}

#[test]
fn every_kernel_case_has_a_mean_error() {
    let measured = mean_errors::measured();
    let missing: Vec<_> =
        cases::kernels().iter().map(|case| case.name).filter(|name| !measured.contains_key(name)).collect();
    assert!(
        missing.is_empty(),
        "not measured (run the parity test, then `cargo xtask mean-errors`): {missing:?}"
    );
}
