//! Triangles, lines and discs through a depth buffer, at several times the resolution.
//!
//! A pixel belongs to a shape if its centre is inside; averaging [`OVERSAMPLING`]² of them for one
//! pixel of the picture is what smooths edges. (Pineda, *A parallel algorithm for polygon
//! rasterization*, 1988.)

use super::image::Image;
use super::palette::Rgb;

/// Pixels across for one pixel of the picture.
pub(super) const OVERSAMPLING: u32 = 3;

/// x, y (down) in pixels, and depth, larger for what is nearer.
pub(super) type Place = [f64; 3];

/// A picture in the making.
#[derive(Debug)]
pub(super) struct Canvas {
    width: i64,
    height: i64,
    depth: Vec<f32>,
    colour: Vec<Rgb>,
}

impl Canvas {
    /// Nothing but background.
    pub(super) fn new(width: u32, height: u32, background: Rgb) -> Self {
        let pixels = width as usize * height as usize;
        Self {
            width: i64::from(width),
            height: i64::from(height),
            depth: vec![f32::NEG_INFINITY; pixels],
            colour: vec![background; pixels],
        }
    }

    /// Fills a triangle; `shade` gives the colour for the weights of its corners.
    pub(super) fn triangle(&mut self, [a, b, c]: [Place; 3], shade: impl Fn([f64; 3]) -> Rgb) {
        let area = cross(a, b, c);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        self.each([a, b, c], 0.0, |x, y| {
            let p = [x, y, 0.0];
            let weights = [cross(b, c, p) / area, cross(c, a, p) / area, cross(a, b, p) / area];
            if weights.iter().any(|&w| w < 0.0) {
                return None;
            }
            let depth = weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2];
            Some((depth, shade(weights)))
        });
    }

    /// A line with round ends, `lift` nearer than it is so that it shows on its faces.
    pub(super) fn line(&mut self, [a, b]: [Place; 2], width: f64, lift: f64, colour: Rgb) {
        let along = [b[0] - a[0], b[1] - a[1]];
        let squared = along[0] * along[0] + along[1] * along[1];
        let reach = 0.25 * width * width;
        self.each([a, b], 0.5 * width, |x, y| {
            let arm = [x - a[0], y - a[1]];
            let inner = arm[0] * along[0] + arm[1] * along[1];
            let share = if squared > 0.0 { (inner / squared).clamp(0.0, 1.0) } else { 0.0 };
            let off = [arm[0] - share * along[0], arm[1] - share * along[1]];
            let inside = off[0] * off[0] + off[1] * off[1] <= reach;
            inside.then(|| (a[2] + share * (b[2] - a[2]) + lift, colour))
        });
    }

    /// A ring from `inner` to `outer` radius that faces the eye; a disc if `inner` is 0.
    pub(super) fn ring(&mut self, at: Place, [inner, outer]: [f64; 2], lift: f64, colour: Rgb) {
        self.each([at], outer, |x, y| {
            let squared = (x - at[0]).powi(2) + (y - at[1]).powi(2);
            let inside = squared <= outer * outer && squared >= inner * inner;
            inside.then_some((at[2] + lift, colour))
        });
    }

    /// Whether a place on a surface is to be seen: nothing is nearer at its pixel or next to it.
    pub(super) fn shows(&self, [x, y, depth]: Place) -> bool {
        let near = |at: f64, size: i64| (at as i64 - 1).max(0)..(at as i64 + 2).min(size);
        let nearest = (depth + f64::from(OVERSAMPLING)) as f32;
        near(y, self.height).any(|y| {
            near(x, self.width).any(|x| self.depth[(y * self.width + x) as usize] <= nearest)
        })
    }

    /// Offers every pixel around `places` to `cover`, which gives depth and colour if it is inside.
    fn each<const N: usize>(
        &mut self,
        places: [Place; N],
        margin: f64,
        cover: impl Fn(f64, f64) -> Option<(f64, Rgb)>,
    ) {
        let range = |axis: usize, size: i64| {
            let of = places.iter().map(|p| p[axis]);
            let low = of.clone().fold(f64::INFINITY, f64::min) - margin;
            let high = of.fold(f64::NEG_INFINITY, f64::max) + margin;
            (low.floor() as i64).max(0)..(high.ceil() as i64 + 1).min(size)
        };
        for y in range(1, self.height) {
            for x in range(0, self.width) {
                let Some((depth, colour)) = cover(x as f64 + 0.5, y as f64 + 0.5) else { continue };
                let pixel = (y * self.width + x) as usize;
                if depth as f32 > self.depth[pixel] {
                    self.depth[pixel] = depth as f32;
                    self.colour[pixel] = colour;
                }
            }
        }
    }

    /// The picture: each pixel the mean of its parts.
    pub(super) fn resolve(&self) -> Image {
        let times = i64::from(OVERSAMPLING);
        let (width, height) = (self.width / times, self.height / times);
        let mut image = Image::new(width as u32, height as u32, [0; 3]);
        for y in 0..height {
            for x in 0..width {
                let mut sum = [0_u32; 3];
                for part in 0..times * times {
                    let (dx, dy) = (part % times, part / times);
                    let at = (y * times + dy) * self.width + x * times + dx;
                    for (s, c) in sum.iter_mut().zip(self.colour[at as usize]) {
                        *s += u32::from(c);
                    }
                }
                let parts = OVERSAMPLING * OVERSAMPLING;
                image.set(x as u32, y as u32, sum.map(|s| ((s + parts / 2) / parts) as u8));
            }
        }
        image
    }
}

/// Twice the signed area of a triangle on the picture.
fn cross(a: Place, b: Place, c: Place) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    const RED: Rgb = [255, 0, 0];
    const BLUE: Rgb = [0, 0, 255];

    #[test]
    fn the_nearer_shape_wins_in_any_order() {
        let triangle =
            |depth: f64| [[0.0, 0.0], [30.0, 0.0], [0.0, 30.0]].map(|[x, y]| [x, y, depth]);
        for order in [[0, 1], [1, 0]] {
            let mut canvas = Canvas::new(9, 9, [255; 3]);
            for i in order {
                canvas.triangle(triangle([1.0, 2.0][i]), |_| [RED, BLUE][i]);
            }
            assert_eq!(canvas.resolve().get(0, 0), BLUE);
        }
    }

    #[test]
    fn edges_are_smooth_and_shapes_may_leave_the_picture() {
        let mut canvas = Canvas::new(9, 9, [255; 3]);
        canvas.line([[-50.0, 4.5, 0.0], [50.0, 4.5, 0.0]], 1.5, 0.0, [0; 3]);
        canvas.ring([1e12, 1e12, 0.0], [0.0, 5.0], 0.0, RED);
        let image = canvas.resolve();
        assert_eq!(
            (image.get(1, 0), image.get(1, 1), image.get(1, 2)),
            ([255; 3], [170; 3], [255; 3])
        );
    }
}
