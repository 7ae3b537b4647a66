//! The effects: which weather file, and which of its keys.

/// An effect off and on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effect {
    pub(super) name: &'static str,
    pub(super) title: &'static str,
    /// A weather file of the street.
    pub(super) base: &'static str,
    /// Time of the picture, s.
    pub(super) time_s: &'static str,
    /// Tables of it that are left out in both.
    pub(super) without: &'static [&'static str],
    /// Changes of both.
    pub(super) both: &'static str,
    /// Changes without the effect, and with it.
    pub(super) off: &'static str,
    pub(super) on: &'static str,
}

/// A view of cars along the street.
const CARS: &str = "[camera]\nposition_m = [-0.4, 1.35, -7.5]\nlook_at_m = [2.5, 0.9, -16]\nfov_deg = 32\n";

/// A view of a hollow of the road.
const HOLLOW_VIEW: &str =
    "[camera]\nposition_m = [0.9, 0.9, -15.6]\nlook_at_m = [0.95, 0.02, -18.2]\nfov_deg = 40\n";

/// All of them.
pub(super) const EFFECTS: [Effect; 19] = [
    Effect {
        name: "rain",
        title: "Drops, streaks and unresolved rain",
        base: "night.toml",
        time_s: "1",
        without: &[],
        both: "",
        off: "[look]\nvisibility = 0\n",
        on: "[look]\nvisibility = 1\n",
    },
    Effect {
        name: "lamps",
        title: "Light of lamps on the rain",
        base: "night.toml",
        time_s: "1",
        without: &[],
        both: "[camera]\nlook_at_m = [-2.5, 3.3, -20]\nfov_deg = 24\n",
        off: "[rain]\ndrop_light = \"none\"\n",
        on: "[rain]\ndrop_light = \"traced\"\n",
    },
    Effect {
        name: "layers",
        title: "Image-space rainfall (section 3.1)",
        base: "night.toml",
        time_s: "1",
        without: &[],
        both: "",
        off: "[rain]\nrate_mm_h = 0\n",
        on: "[rain]\nlayers = \"tatarchuk-2006\"\n",
    },
    Effect {
        name: "wetness",
        title: "Wet materials",
        base: "day.toml",
        time_s: "1",
        without: &[],
        both: "",
        off: "[wetness]\nenabled = false\n",
        on: "[wetness]\nenabled = true\n",
    },
    Effect {
        name: "reflections",
        title: "Streaky reflections by impostors (section 6.3)",
        base: "night.toml",
        time_s: "1",
        without: &[],
        both: "[rain]\nrate_mm_h = 8\n",
        off: "[wetness]\nreflections = \"rays\"\n",
        on: "[wetness]\nreflections = \"tatarchuk-2006\"\n",
    },
    Effect {
        name: "puddles",
        title: "Puddles",
        base: "day.toml",
        time_s: "1",
        without: &["puddle"],
        both: HOLLOW_VIEW,
        off: "",
        on: "[[puddle]]\nposition_m = [0.96, 0.05, -18.38]\nsize_m = [1.73, 3.60]\nfill = 1\nrelief_mm = 1.2\n",
    },
    Effect {
        name: "ripples",
        title: "Ripples of the drops that fall",
        base: "day.toml",
        time_s: "1",
        without: &["puddle"],
        both: HOLLOW_VIEW,
        off: "[[puddle]]\nposition_m = [0.96, 0.05, -18.38]\nsize_m = [1.73, 3.60]\nfill = 1\nrelief_mm = 1.2\nripple_influence = 0\n",
        on: "[[puddle]]\nposition_m = [0.96, 0.05, -18.38]\nsize_m = [1.73, 3.60]\nfill = 1\nrelief_mm = 1.2\n",
    },
    Effect {
        name: "wakes",
        title: "Waves behind wheels",
        base: "drive.toml",
        time_s: "5.8",
        without: &["puddle"],
        both: "[rain]\nrate_mm_h = 0\n[wetness]\nwetness = 1\n\
               [camera]\nposition_m = [-2.3, 1.1, -8.2]\nlook_at_m = [-0.8, 0.1, -12.6]\nfov_deg = 40\n",
        off: "[[puddle]]\nposition_m = [-0.95, 0.05, -12]\nsize_m = [3.4, 9]\nmask = \"pavement_puddle.png\"\ndepth_mm = 15\nripple_influence = 0\n",
        on: "[[puddle]]\nposition_m = [-0.95, 0.05, -12]\nsize_m = [3.4, 9]\nmask = \"pavement_puddle.png\"\ndepth_mm = 15\n",
    },
    Effect {
        name: "splashes",
        title: "Splashes",
        base: "storm.toml",
        time_s: "1",
        without: &["lightning", "wind"],
        both: "[camera]\nposition_m = [-0.6, 0.5, -8]\nlook_at_m = [0.3, 0.02, -10.5]\nfov_deg = 34\nshutter_s = 0.004\n",
        off: "[splashes]\nenabled = false\n",
        on: "[splashes]\nenabled = true\n",
    },
    Effect {
        name: "splatter",
        title: "Splashes on cars",
        base: "storm.toml",
        time_s: "1.2",
        without: &["camera"],
        both: "[camera]\nposition_m = [0.9, 1.45, -7.6]\nlook_at_m = [1.7, 0.95, -9.2]\nfov_deg = 30\nshutter_s = 0.0167\n\
               exposure_ev = -0.9\n",
        off: "[splashes]\nenabled = false\n",
        on: "[splashes]\nenabled = true\n",
    },
    Effect {
        name: "drips",
        title: "Drips off an awning",
        base: "storm.toml",
        time_s: "1",
        without: &["lightning", "wind"],
        both: "[camera]\nposition_m = [-1.8, 1.6, -5.5]\nlook_at_m = [-4.6, 2.0, -9.5]\nfov_deg = 42\nshutter_s = 0.004\n",
        off: "[drips]\nenabled = false\n",
        on: "[drips]\nenabled = true\n",
    },
    Effect {
        name: "spray",
        title: "Spray: misty halos of objects (section 3.4)",
        base: "storm.toml",
        time_s: "1",
        without: &["lightning"],
        both: CARS,
        off: "[spray]\nenabled = false\n",
        on: "[spray]\nenabled = true\n",
    },
    Effect {
        name: "lightning",
        title: "Lightning",
        base: "storm.toml",
        time_s: "0.5333",
        without: &["lightning"],
        both: "",
        off: "",
        on: "[lightning]\nper_minute = 20\nseed = 14\ndistance_m = [500, 1500]\nbrightness = 20\n",
    },
    Effect {
        name: "fog",
        title: "Fog",
        base: "night.toml",
        time_s: "1",
        without: &[],
        both: "",
        off: "",
        on: "[fog]\nvisibility_m = 300\n",
    },
    Effect {
        name: "glow",
        title: "Glow around lights",
        base: "night.toml",
        time_s: "1",
        without: &[],
        both: "",
        off: "[glow]\nglare = 0\ndiffraction = false\n",
        on: "[glow]\nglare = 0.05\n",
    },
    Effect {
        name: "glass",
        title: "Droplets on glass",
        base: "windshield.toml",
        time_s: "0.7",
        without: &["glass"],
        both: "",
        off: "",
        on: "[glass]\ndistance_m = 0.34\ntilt_deg = 60\nsize_m = [0.5, 0.37]\ncell_mm = 0.85\nspeed_m_s = 8\nfocus = \"glass\"\naperture_mm = 6\n\
             before_s = 60.45\n",
    },
    Effect {
        name: "rivulets",
        title: "Rivulets on a window in heavy rain",
        base: "window.toml",
        time_s: "0.5",
        without: &["glass"],
        both: "[rain]\nrate_mm_h = 50\n\n[glass]\ndistance_m = 0.6992\nsize_m = [1.16, 0.72]\ncell_mm = 0.8\nspeed_m_s = 9\n\
               before_s = 40\nfocus = \"glass\"\naperture_mm = 4\n",
        off: "film_um = 0\n",
        on: "film_um = 8\n",
    },
    Effect {
        name: "panes",
        title: "Rain on shop windows",
        base: "day.toml",
        time_s: "2",
        without: &[],
        both: "[[wind]]\nuniform = { speed_m_s = 4, towards_deg = 0 }\n[camera]\nposition_m = [4.9, 1.5, -41.3]\nlook_at_m = [8.0, 1.5, -42.0]\n\
               fov_deg = 45\n",
        off: "",
        on: "[[pane]]\nmaterial = \"glass\"\n",
    },
    Effect {
        name: "wipers",
        title: "Wipers",
        base: "windshield.toml",
        time_s: "0.7",
        without: &["glass"],
        both: "[glass]\ndistance_m = 0.34\ntilt_deg = 60\nsize_m = [0.5, 0.37]\ncell_mm = 0.85\nspeed_m_s = 8\nfocus = \"glass\"\naperture_mm = 6\n\
               before_s = 60.45\n",
        off: "",
        on: "[[glass.wiper]]\npivot_m = [0.25, 0.41]\nlength_m = 0.36\nfrom_deg = 10\nto_deg = 170\nperiod_s = 3\n",
    },
];
