//! What the colours mean, in a strip below the panels.

use super::heat::HeatRange;
use super::image::Image;
use super::palette::{self, Rgb};
use super::panel::Subject;
use super::raster::{Canvas, OVERSAMPLING};
use super::text::Pen;
use crate::metrics::FaceField;

/// The sign before the words.
enum Sign {
    Disc(Rgb),
    Ring(Rgb),
    Line(Rgb),
    Square(Rgb),
    /// All colours of the heat map.
    Scale,
}

struct Entry {
    sign: Sign,
    words: String,
}

/// Draws the strip, as wide as the sheet and as high as it needs to be.
pub(super) fn draw(
    subjects: &[Subject],
    heat: Option<(&FaceField, HeatRange)>,
    (pen, height): (&Pen, u32),
    width: u32,
) -> Image {
    let entries = entries(subjects, heat);
    let (gap, line) = (height, height * 8 / 5);
    // Where each entry goes: next to the last one, or on a new line.
    let (mut x, mut rows, mut places) = (gap, 0, Vec::new());
    for entry in &entries {
        let extent = sign_width(&entry.sign, height) + height / 2 + pen.width(&entry.words);
        if x > gap && x + extent + gap > width {
            (x, rows) = (gap, rows + 1);
        }
        places.push([x, rows]);
        x += extent + gap * 3 / 2;
    }
    let mut image = Image::new(width, (rows + 1) * line + gap, palette::PAPER);
    for (entry, [x, row]) in entries.iter().zip(places) {
        let top = gap / 2 + row * line;
        let after = x + sign_width(&entry.sign, height) + height / 2;
        image.paste(&sign(&entry.sign, height), [x, top + line / 2 - height / 2]);
        let base = top + line / 2 + height * 7 / 20;
        pen.write(&mut image, &entry.words, [after, base], palette::INK);
    }
    image
}

fn entries(subjects: &[Subject], heat: Option<(&FaceField, HeatRange)>) -> Vec<Entry> {
    let mut entries = match heat {
        Some((field, range)) => heat_entries(subjects, field, range),
        None => index_entries(subjects),
    };
    let any = |of: fn(&Subject) -> bool| subjects.iter().any(of);
    if any(|s| !s.elements.sharp_edges.is_empty()) {
        entries.push(Entry { sign: Sign::Line(palette::SHARP), words: "sharp feature".into() });
    }
    if any(|s| !s.elements.boundary_edges.is_empty()) {
        entries.push(Entry { sign: Sign::Line(palette::BOUNDARY), words: "boundary".into() });
    }
    entries
}

/// The kinds of index: a specimen of each, and words. Others of the same colour are of its kind.
const KINDS: [(i32, &str); 4] = [
    (2, "index ≥ +2"),
    (1, "+1: valence or degree 3"),
    (-1, "−1: valence or degree 5"),
    (-2, "≤ −2"),
];

/// Only what occurs, so that small pictures are not all legend.
fn index_entries(subjects: &[Subject]) -> Vec<Entry> {
    let occurs = |colour: Rgb| {
        let of = |s: &Subject| {
            let mut elements = s.elements.vertices.iter().chain(&s.elements.faces);
            elements.any(|e| palette::index(e.index) == colour)
        };
        subjects.iter().any(of)
    };
    let kinds = KINDS.iter().map(|&(index, words)| (palette::index(index), words));
    let mut entries: Vec<Entry> = kinds
        .filter(|&(colour, _)| occurs(colour))
        .map(|(colour, words)| Entry { sign: Sign::Disc(colour), words: words.into() })
        .collect();
    if subjects.iter().any(|s| !s.elements.t_junctions.is_empty()) {
        entries.push(Entry { sign: Sign::Ring(palette::T_JUNCTION), words: "T-junction".into() });
    }
    if entries.is_empty() {
        entries.push(Entry { sign: Sign::Square(palette::FACE), words: "all regular".into() });
    }
    entries
}

fn heat_entries(subjects: &[Subject], field: &FaceField, range: HeatRange) -> Vec<Entry> {
    let unit = if field.unit.is_empty() { String::new() } else { format!(" {}", field.unit) };
    let words = format!("{}, {} to {}{unit}", field.label, short(range.low), short(range.high));
    let mut entries = vec![Entry { sign: Sign::Scale, words }];
    let undefined = |s: &Subject| s.heat.is_some_and(|v| v.iter().any(|v| v.is_nan()));
    if subjects.iter().any(undefined) {
        let words = "not a quad".to_owned();
        entries.push(Entry { sign: Sign::Square(palette::UNDEFINED), words });
    }
    entries
}

/// Three significant digits.
fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = (2.0 - value.abs().log10().floor()).clamp(0.0, 8.0) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

fn sign_width(sign: &Sign, height: u32) -> u32 {
    match sign {
        Sign::Scale => 8 * height,
        Sign::Line(_) => 2 * height,
        Sign::Disc(_) | Sign::Ring(_) | Sign::Square(_) => height,
    }
}

fn sign(sign: &Sign, height: u32) -> Image {
    let (width, times) = (sign_width(sign, height), OVERSAMPLING);
    let mut canvas = Canvas::new(width * times, height * times, palette::PAPER);
    let [w, h] = [width * times, height * times].map(f64::from);
    let (centre, radius, rim) = ([0.5 * w, 0.5 * h, 0.0], 0.36 * h, 0.07 * h);
    match *sign {
        Sign::Disc(colour) => {
            canvas.ring(centre, [0.0, radius + rim], 0.0, palette::INK);
            canvas.ring(centre, [0.0, radius], 1.0, colour);
        }
        Sign::Ring(colour) => canvas.ring(centre, [radius - 2.0 * rim, radius], 0.0, colour),
        Sign::Line(colour) => {
            canvas.line(
                [[0.1 * h, 0.5 * h, 0.0], [w - 0.1 * h, 0.5 * h, 0.0]],
                0.16 * h,
                0.0,
                colour,
            );
        }
        Sign::Square(colour) => {
            canvas.line([[0.5 * w, 0.0, 0.0], [0.5 * w, h, 0.0]], w, 0.0, colour);
        }
        Sign::Scale => return scale(width, height),
    }
    canvas.resolve()
}

fn scale(width: u32, height: u32) -> Image {
    let mut image = Image::new(width, height, palette::PAPER);
    for x in 0..width {
        let colour = palette::heat(f64::from(x) / f64::from(width.max(2) - 1));
        image.fill([x, height / 8], [1, height * 3 / 4], colour);
    }
    image
}

#[cfg(test)]
mod tests {
    use super::short;

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            [0.0, 1.0, 12.345, 0.012_34, -0.5, 1234.5].map(short),
            ["0", "1", "12.3", "0.0123", "-0.5", "1234"]
        );
    }
}
