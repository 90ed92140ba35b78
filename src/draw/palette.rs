//! Colours that stay ordered for every eye: lightness falls from the first colour to the last.

/// A sequential palette, from "good" (light) to "bad" (dark).
///
/// All are safe under the common colour vision deficiencies because their order is carried by
/// lightness alone (SPEC G3). None contains the red of highlights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Palette {
    /// Pale yellow over green to dark blue (Cynthia Brewer's `YlGnBu`): leaves sound meshes light.
    #[default]
    YlGnBu,
    /// Matplotlib's viridis, light end first.
    Viridis,
    /// Cividis (Nuñez, Anderton, Renslow 2018), light end first.
    Cividis,
    /// Greys, for print.
    Grey,
}

/// The first eight of the nine stops of Brewer's `YlGnBu`: on the ninth, black lines vanish.
const YL_GN_BU: [u32; 8] =
    [0xff_ffd9, 0xed_f8b1, 0xc7_e9b4, 0x7f_cdbb, 0x41_b6c4, 0x1d_91c0, 0x22_5ea8, 0x25_3494];
/// Ten evenly spaced stops of viridis, reversed.
const VIRIDIS: [u32; 10] = [
    0xfd_e725, 0xb5_de2b, 0x6e_ce58, 0x35_b779, 0x1f_9e89, 0x26_828e, 0x31_688e, 0x3e_4989,
    0x48_2878, 0x44_0154,
];
/// Ten evenly spaced stops of cividis, reversed.
const CIVIDIS: [u32; 10] = [
    0xff_ea46, 0xe4_cf5b, 0xc4_b56c, 0xa6_9d75, 0x8a_8779, 0x70_7173, 0x57_5c6d, 0x39_486b,
    0x00_336f, 0x00_204d,
];
const GREY: [u32; 2] = [0xf4_f4f4, 0x22_2222];

impl Palette {
    /// Every palette.
    pub const ALL: [Self; 4] = [Self::YlGnBu, Self::Viridis, Self::Cividis, Self::Grey];

    /// What it is called.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::YlGnBu => "YlGnBu",
            Self::Viridis => "viridis",
            Self::Cividis => "cividis",
            Self::Grey => "grey",
        }
    }

    /// The colour at `t` in [0, 1], 0 the light end, as `0xRRGGBB`; `t` outside is clamped.
    #[must_use]
    pub fn colour(self, t: f64) -> u32 {
        let stops = self.stops();
        let last = stops.len() - 1;
        let at = t.clamp(0.0, 1.0) * last as f64;
        let low = (at as usize).min(last - 1);
        mix(stops[low], stops[low + 1], at - low as f64)
    }

    /// The colours it blends, as `0xRRGGBB`, evenly spaced from the light end.
    pub(super) fn stops(self) -> &'static [u32] {
        match self {
            Self::YlGnBu => &YL_GN_BU,
            Self::Viridis => &VIRIDIS,
            Self::Cividis => &CIVIDIS,
            Self::Grey => &GREY,
        }
    }
}

/// Blends channel by channel; `t` in [0, 1].
pub(super) fn mix(from: u32, to: u32, t: f64) -> u32 {
    let channel = |shift: u32| {
        let (a, b) = (f64::from(from >> shift & 0xff), f64::from(to >> shift & 0xff));
        ((a + (b - a) * t).round() as u32) << shift
    };
    channel(16) | channel(8) | channel(0)
}

impl std::str::FromStr for Palette {
    type Err = ParsePaletteError;

    /// Reads a palette's name, in any case.
    fn from_str(text: &str) -> Result<Self, ParsePaletteError> {
        Self::ALL
            .into_iter()
            .find(|p| p.name().eq_ignore_ascii_case(text))
            .ok_or_else(|| ParsePaletteError { text: text.to_owned() })
    }
}

/// Why a text names no [`Palette`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no palette '{text}'; there are YlGnBu, viridis, cividis and grey")]
pub struct ParsePaletteError {
    text: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// CIE L* of an sRGB colour.
    fn lightness(colour: u32) -> f64 {
        let linear = |c: u32| {
            let c = f64::from(c) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) }
        };
        let (r, g, b) = (linear(colour >> 16), linear(colour >> 8 & 0xff), linear(colour & 0xff));
        let y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
        116.0 * libm::cbrt(y) - 16.0
    }

    // spec: G3
    #[test]
    fn lightness_falls_strictly_along_every_palette() {
        for palette in Palette::ALL {
            let levels: Vec<f64> =
                (0..=64).map(|i| lightness(palette.colour(f64::from(i) / 64.0))).collect();
            assert!(levels.windows(2).all(|w| w[1] < w[0]), "{palette:?}: {levels:?}");
            assert!(levels[0] - levels[64] > 60.0, "{palette:?} spans too little");
        }
    }

    #[test]
    fn ends_are_the_first_and_last_stop_and_outside_is_clamped() {
        for palette in Palette::ALL {
            let stops = palette.stops();
            assert_eq!(palette.colour(0.0), stops[0]);
            assert_eq!(palette.colour(1.0), stops[stops.len() - 1]);
            assert_eq!(palette.colour(-3.0), stops[0]);
            assert_eq!(palette.colour(f64::INFINITY), stops[stops.len() - 1]);
        }
    }

    #[test]
    fn palettes_are_read_by_name_and_unknown_ones_are_named() {
        for palette in Palette::ALL {
            assert_eq!(palette.name().to_uppercase().parse(), Ok(palette));
        }
        let error = "jet".parse::<Palette>().expect_err("no such palette").to_string();
        let named = Palette::ALL.iter().all(|p| error.contains(p.name()));
        assert!(error.contains("'jet'") && named, "{error}");
    }
}
