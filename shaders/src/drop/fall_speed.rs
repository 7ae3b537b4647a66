//! `wgsl/drop/fall_speed.wgsl`. Twin: `downpour_drop::fall_speed`.

use crate::Module;

/// Every module of this file.
pub const MODULES: &[&Module] = &[&FALL_SPEED_CONSTANTS, &FALL_SPEED_TABLES, &FALL_SPEED];

/// Terminal speed of a drop by every model, and relaxation toward it. Twin: `downpour_drop::fall_speed`.
pub static FALL_SPEED: Module = Module {
    path: "drop/fall_speed.wgsl",
    wgsl: include_str!("../../wgsl/drop/fall_speed.wgsl"),
    uses: &[&FALL_SPEED_CONSTANTS, &FALL_SPEED_TABLES],
};

shared_constants! {
    /// Numbers of the models of terminal speed.
    FALL_SPEED_CONSTANTS at "drop/fall_speed constants" {
        /// Standard gravity, m/s^2.
        FALL_SPEED_GRAVITY: f32 = 9.80665;

        /// Number of the model Beard 1976.
        FALL_SPEED_MODEL_BEARD_1976: u32 = 0;
        /// Number of the model Gunn & Kinzer 1949.
        FALL_SPEED_MODEL_GUNN_KINZER_1949: u32 = 1;
        /// Number of the model Rousseau 2006.
        FALL_SPEED_MODEL_ROUSSEAU_2006: u32 = 2;
        /// Number of the model Atlas 1973.
        FALL_SPEED_MODEL_ATLAS_1973: u32 = 3;
        /// Number of the model Atlas & Ulbrich 1977.
        FALL_SPEED_MODEL_ATLAS_ULBRICH_1977: u32 = 4;
        /// Number of the model Brandes 2002.
        FALL_SPEED_MODEL_BRANDES_2002: u32 = 5;
        /// Number of the model van Dijk 2002.
        FALL_SPEED_MODEL_VAN_DIJK_2002: u32 = 6;
        /// Number of the model Lhermitte 1988.
        FALL_SPEED_MODEL_LHERMITTE_1988: u32 = 7;

        /// Beard 1976: diameter, mm, below which the flow is Stokes' with slip.
        FALL_SPEED_BEARD_STOKES_MM: f32 = 0.019;
        /// Beard 1976: diameter, mm, from which a drop is no longer a sphere.
        FALL_SPEED_BEARD_SPHERE_MM: f32 = 1.07;
        /// Beard 1976: largest diameter of the law, mm; the speed is constant beyond.
        FALL_SPEED_BEARD_MAX_MM: f32 = 7.0;

        /// van Dijk 2002: diameter, mm, beyond which the speed is constant, as the cubic diverges.
        FALL_SPEED_VAN_DIJK_MAX_MM: f32 = 6.0;
    }
}

shared_tables! {
    /// Coefficients and tables of the models of terminal speed.
    FALL_SPEED_TABLES at "drop/fall_speed tables" {
    /// Beard 1976, spheres: ln(Re / slip correction) as a polynomial of `ln N_Da`, lowest power first.
    FALL_SPEED_BEARD_SPHERE: [f32; 7] =
        [-3.18657, 0.992696, -1.53193e-3, -9.87059e-4, -5.78878e-4, 8.55176e-5, -3.27815e-6];
    /// Beard 1976, flattened drops: `ln(Re / N_P^(1/6))` as a polynomial of `ln(Bo N_P^(1/6)) - 5`. As published, but
    /// about the middle of its range: about 0 its terms of either sign would cost f32 a digit.
    FALL_SPEED_BEARD_FLATTENED: [f32; 6] =
        [2.8973436, 0.70401125, -0.0814025, -0.0142215, 0.00533035, 0.00238449];
    /// Brandes 2002: coefficients in m/s and mm, lowest power first.
    FALL_SPEED_BRANDES: [f32; 5] = [-0.1021, 4.932, -0.9551, 0.07934, -0.002362];
    /// van Dijk 2002: coefficients in m/s and mm, lowest power first.
    FALL_SPEED_VAN_DIJK: [f32; 4] = [-0.254, 5.03, -0.912, 0.0561];
    /// Gunn & Kinzer 1949, table 2: diameters in micrometers. Whole numbers, so that they are exact.
    FALL_SPEED_GUNN_KINZER_DIAMETERS_UM: [f32; 35] = [
        78.0, 100.0, 200.0, 300.0, 400.0, 500.0, 600.0, 700.0, 800.0, 900.0, 1000.0, 1200.0,
        1400.0, 1600.0, 1800.0, 2000.0, 2200.0, 2400.0, 2600.0, 2800.0, 3000.0, 3200.0, 3400.0,
        3600.0, 3800.0, 4000.0, 4200.0, 4400.0, 4600.0, 4800.0, 5000.0, 5200.0, 5400.0, 5600.0,
        5800.0
    ];
    /// Gunn & Kinzer 1949, table 2: speeds in cm/s.
    FALL_SPEED_GUNN_KINZER_SPEEDS_CM_S: [f32; 35] = [
        18.0, 27.0, 72.0, 117.0, 162.0, 206.0, 247.0, 287.0, 327.0, 367.0, 403.0, 464.0,
        517.0, 565.0, 609.0, 649.0, 690.0, 727.0, 757.0, 782.0, 806.0, 826.0, 844.0,
        860.0, 872.0, 883.0, 892.0, 898.0, 903.0, 907.0, 909.0, 912.0, 914.0, 916.0,
        917.0
    ];
    /// Rousseau 2006, table 2 (twice its radii): diameters in micrometers, spherical and ellipsoidal drops.
    FALL_SPEED_ROUSSEAU_DIAMETERS_UM: [f32; 23] = [
        200.0, 300.0, 400.0, 500.0, 600.0, 700.0, 800.0, 900.0,
        1000.0, 1500.0, 2000.0, 2500.0, 3000.0, 3500.0, 4000.0, 4500.0,
        5000.0, 5500.0, 6000.0, 6500.0, 7000.0, 7500.0, 8000.0
    ];
    /// Rousseau 2006, table 2: speeds in cm/s.
    FALL_SPEED_ROUSSEAU_SPEEDS_CM_S: [f32; 23] = [
        72.0, 117.0, 162.0, 206.0, 247.0, 287.0, 327.0, 367.0,
        400.0, 543.0, 659.0, 746.0, 810.0, 858.0, 891.0, 911.0,
        920.0, 923.0, 923.0, 923.0, 923.0, 923.0, 923.0
    ];
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn tables_rise_with_the_diameter() {
        for pair in super::FALL_SPEED_GUNN_KINZER_DIAMETERS_UM.windows(2) {
            assert!(pair[0] < pair[1]);
        }
        for pair in super::FALL_SPEED_ROUSSEAU_DIAMETERS_UM.windows(2) {
            assert!(pair[0] < pair[1]);
        }
    }
}
