//! Colours, chosen to be told apart with any colour vision (after Okabe & Ito, *Color Universal
//! Design*, 2008). The report has the same ones.

/// Red, green, blue, 0 to 255.
pub type Rgb = [u8; 3];

/// Background.
pub const PAPER: Rgb = [255, 255, 255];
/// Text.
pub const INK: Rgb = [33, 37, 41];
/// Text of less weight.
pub const FAINT: Rgb = [96, 103, 112];
/// Regular faces.
pub const FACE: Rgb = [238, 240, 243];
/// Faces seen from behind.
pub const BACK: Rgb = [203, 190, 184];
/// Edges.
pub const EDGE: Rgb = [92, 99, 107];
/// Index +1: valence or degree 3.
pub const PLUS: Rgb = [86, 160, 222];
/// Index +2 and more.
pub const PLUS_MORE: Rgb = [0, 63, 136];
/// Index −1: valence or degree 5.
pub const MINUS: Rgb = [246, 214, 51];
/// Index −2 and less.
pub const MINUS_MORE: Rgb = [178, 110, 0];
/// The ring around the hanging vertex of a T-junction.
pub const T_JUNCTION: Rgb = [204, 51, 17];
/// Sharp features.
pub const SHARP: Rgb = [0, 0, 0];
/// Boundaries.
pub const BOUNDARY: Rgb = [0, 128, 96];
/// Where a field is undefined.
pub const UNDEFINED: Rgb = [190, 190, 190];

/// The colour of an element of this index.
#[must_use]
pub fn index(index: i32) -> Rgb {
    match index {
        0 => FACE,
        1 => PLUS,
        2.. => PLUS_MORE,
        -1 => MINUS,
        _ => MINUS_MORE,
    }
}

/// Viridis (van der Walt & Smith, 2015) at nine even places, dark to light: also in grey, lighter
/// is more.
const VIRIDIS: [Rgb; 9] = [
    [68, 1, 84],
    [71, 44, 122],
    [59, 81, 139],
    [44, 113, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];

/// The colour of a value between 0 and 1 in a heat map.
#[must_use]
pub fn heat(value: f64) -> Rgb {
    if value.is_nan() {
        return UNDEFINED;
    }
    let place = value.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let below = (place.floor() as usize).min(VIRIDIS.len() - 2);
    mix(VIRIDIS[below], VIRIDIS[below + 1], place - below as f64)
}

/// `share` of `b` and the rest of `a`.
#[must_use]
pub fn mix(a: Rgb, b: Rgb, share: f64) -> Rgb {
    let one = |i: usize| f64::from(a[i]) + share * (f64::from(b[i]) - f64::from(a[i]));
    [0, 1, 2].map(|i| one(i).round().clamp(0.0, 255.0) as u8)
}
