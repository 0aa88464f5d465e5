//! Pixels, and their way into a PNG file.

use super::palette::Rgb;
use std::io::Write;

/// An opaque picture in sRGB.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    width: u32,
    height: u32,
    pixels: Vec<u8>,
}

impl Image {
    /// All of one colour.
    #[must_use]
    pub fn new(width: u32, height: u32, colour: Rgb) -> Self {
        let pixels = colour.repeat(width as usize * height as usize);
        Self { width, height, pixels }
    }

    /// Pixels across and down.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Red, green and blue of each pixel, row by row from the top.
    #[must_use]
    pub fn pixels(&self) -> &[u8] {
        &self.pixels
    }

    /// The colour of a pixel of the picture.
    #[must_use]
    pub fn get(&self, x: u32, y: u32) -> Rgb {
        let at = self.at(x, y);
        [self.pixels[at], self.pixels[at + 1], self.pixels[at + 2]]
    }

    pub(super) fn set(&mut self, x: u32, y: u32, colour: Rgb) {
        let at = self.at(x, y);
        self.pixels[at..at + 3].copy_from_slice(&colour);
    }

    fn at(&self, x: u32, y: u32) -> usize {
        3 * (y as usize * self.width as usize + x as usize)
    }

    /// Puts `other` on this one with its top left corner at that pixel; what is outside is cut.
    pub(super) fn paste(&mut self, other: &Self, [left, top]: [u32; 2]) {
        let columns = other.width.min(self.width.saturating_sub(left));
        for y in 0..other.height.min(self.height.saturating_sub(top)) {
            let (from, to) = (other.at(0, y), self.at(left, top + y));
            let bytes = 3 * columns as usize;
            self.pixels[to..to + bytes].copy_from_slice(&other.pixels[from..from + bytes]);
        }
    }

    /// Fills a rectangle, as far as it is on the picture.
    pub(super) fn fill(&mut self, [left, top]: [u32; 2], [width, height]: [u32; 2], colour: Rgb) {
        self.paste(&Self::new(width, height, colour), [left, top]);
    }

    /// Writes it as PNG.
    pub fn write_png(&self, out: impl Write) -> std::io::Result<()> {
        let mut encoder = png::Encoder::new(out, self.width, self.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::High);
        // Drawings have few colours in long runs: differences of neighbours would only hide that.
        encoder.set_filter(png::Filter::NoFilter);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.pixels)?;
        Ok(writer.finish()?)
    }
}
