//! Text on pictures, in the font `DejaVu` Sans, which the program carries.

use super::image::Image;
use super::palette::{Rgb, mix};
use ab_glyph::{Font, FontRef, GlyphId, PxScale, ScaleFont, point};

/// Writes text of one size.
pub(super) struct Pen {
    font: FontRef<'static>,
    scale: PxScale,
}

impl Pen {
    /// A pen for lines that are `height` pixels apart; `None` if the font is damaged.
    pub(super) fn new(height: f32) -> Option<Self> {
        let font = FontRef::try_from_slice(dejavu::sans::regular()).ok()?;
        Some(Self { font, scale: PxScale::from(height) })
    }

    /// How wide the text is, in pixels.
    pub(super) fn width(&self, text: &str) -> u32 {
        self.glyphs(text).last().map_or(0.0, |glyph| glyph.2).ceil() as u32
    }

    /// Writes with the left end of the base line at a pixel.
    pub(super) fn write(&self, image: &mut Image, text: &str, [x, y]: [u32; 2], colour: Rgb) {
        let [width, height] = image.size();
        for (id, start, _) in self.glyphs(text) {
            let glyph = id.with_scale_and_position(self.scale, point(x as f32 + start, y as f32));
            let Some(outline) = self.font.outline_glyph(glyph) else { continue };
            let corner = outline.px_bounds().min;
            outline.draw(|dx, dy, coverage| {
                let (x, y) = (corner.x + dx as f32, corner.y + dy as f32);
                if x < 0.0 || y < 0.0 || x >= width as f32 || y >= height as f32 {
                    return;
                }
                let (x, y) = (x as u32, y as u32);
                // Sixteenths: the same on machines that round the last bit in another way.
                let share = f64::from((coverage.clamp(0.0, 1.0) * 16.0).round() / 16.0);
                let mixed = mix(image.get(x, y), colour, share);
                image.set(x, y, mixed);
            });
        }
    }

    /// Each glyph with where it starts and ends.
    fn glyphs(&self, text: &str) -> Vec<(GlyphId, f32, f32)> {
        let font = self.font.as_scaled(self.scale);
        let (mut at, mut last, mut glyphs) = (0.0, None, Vec::new());
        for id in text.chars().map(|c| font.glyph_id(c)) {
            at += last.map_or(0.0, |last| font.kern(last, id));
            let start = at;
            at += font.h_advance(id);
            glyphs.push((id, start, at));
            last = Some(id);
        }
        glyphs
    }
}
