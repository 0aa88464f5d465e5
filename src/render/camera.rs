//! Where a picture is seen from: orthographic, fitted to a box, so that lengths can be compared.

use crate::mesh::{Point, Vector};
use std::str::FromStr;

/// A direction to look from, in degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Around the vertical axis, from the front to the right.
    pub azimuth_deg: f64,
    /// Above the horizon.
    pub elevation_deg: f64,
}

/// Directions with a name.
pub const VIEWS: &[(&str, View)] = &[
    ("corner", View::new(35.0, 25.0)),
    ("behind", View::new(215.0, 25.0)),
    ("front", View::new(0.0, 0.0)),
    ("right", View::new(90.0, 0.0)),
    ("back", View::new(180.0, 0.0)),
    ("left", View::new(270.0, 0.0)),
    ("top", View::new(0.0, 90.0)),
    ("bottom", View::new(0.0, -90.0)),
];

impl View {
    const fn new(azimuth_deg: f64, elevation_deg: f64) -> Self {
        Self { azimuth_deg, elevation_deg }
    }
}

impl FromStr for View {
    type Err = String;

    /// A name of [`VIEWS`], or azimuth and elevation: `35,25`.
    fn from_str(text: &str) -> Result<Self, String> {
        if let Some((_, view)) = VIEWS.iter().find(|(name, _)| *name == text) {
            return Ok(*view);
        }
        let names = || VIEWS.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
        let wrong = || format!("a view is {}, or AZIMUTH,ELEVATION in degrees", names());
        let (azimuth, elevation) = text.split_once(',').ok_or_else(wrong)?;
        let angle = |t: &str| t.trim().parse().ok().filter(|a: &f64| a.is_finite());
        let elevation_deg = angle(elevation).filter(|e| e.abs() <= 90.0);
        let (Some(azimuth_deg), Some(elevation_deg)) = (angle(azimuth), elevation_deg) else {
            return Err(format!("{}; elevation is -90 to 90", wrong()));
        };
        Ok(Self { azimuth_deg, elevation_deg })
    }
}

/// The axis that points up in a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Up {
    /// y, usual for models that are to be looked at; the front looks along −z.
    #[default]
    Y,
    /// z, usual for models that are to be made; the front looks along y.
    Z,
}

/// Maps points of the scene to pixels and depth.
#[derive(Debug, Clone)]
pub(super) struct Camera {
    right: Vector,
    up: Vector,
    /// Towards the eye.
    toward: Vector,
    centre: Point,
    /// Pixels for a unit of length.
    pub(super) scale: f64,
    middle: [f64; 2],
}

impl Camera {
    /// Looks from `view` at the box so that all `points` are on a panel of that size, with a margin.
    pub(super) fn fit(view: View, up: Up, points: &[Point], size: [u32; 2], margin: f64) -> Self {
        let (azimuth, elevation) = (view.azimuth_deg.to_radians(), view.elevation_deg.to_radians());
        let [right, up, toward] = frame(azimuth, elevation).map(|v| turned(v, up));
        let mut camera =
            Self { right, up, toward, centre: Point::origin(), scale: 1.0, middle: [0.0; 2] };
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for [x, y, _] in points.iter().map(|p| camera.project(p)) {
            low = [low[0].min(x), low[1].min(y)];
            high = [high[0].max(x), high[1].max(y)];
        }
        let size = size.map(f64::from);
        let room = |i: usize| (size[i] - 2.0 * margin).max(1.0) / (high[i] - low[i]).max(1e-300);
        let scale = room(0).min(room(1));
        let middle = |i: usize| 0.5 * (low[i] + high[i]);
        // A single point, or none, has no extent to fit.
        camera.scale = if scale.is_finite() && scale < 1e290 { scale } else { 1.0 };
        if low[0].is_finite() {
            camera.centre += camera.right * middle(0) - camera.up * middle(1);
        }
        camera.middle = size.map(|s| 0.5 * s);
        camera
    }

    /// Pixel coordinates (y down) and depth, larger for what is nearer, in pixels as well.
    pub(super) fn project(&self, point: &Point) -> [f64; 3] {
        let arm = point - self.centre;
        [
            self.middle[0] + self.scale * arm.dot(&self.right),
            self.middle[1] - self.scale * arm.dot(&self.up),
            self.scale * arm.dot(&self.toward),
        ]
    }

    /// The part of a normal along each axis of the picture: right, up, towards the eye.
    pub(super) fn facing(&self, normal: &Vector) -> [f64; 3] {
        [self.right, self.up, self.toward].map(|axis| normal.dot(&axis))
    }
}

/// Right, up and towards the eye, with y up.
fn frame(azimuth: f64, elevation: f64) -> [Vector; 3] {
    let ((sa, ca), (se, ce)) = (azimuth.sin_cos(), elevation.sin_cos());
    [
        Vector::new(ca, 0.0, -sa),
        Vector::new(-sa * se, ce, -ca * se),
        Vector::new(sa * ce, se, ca * ce),
    ]
}

/// The same direction where z is up: y becomes z, and what was the front (z) becomes −y.
fn turned(v: Vector, up: Up) -> Vector {
    match up {
        Up::Y => v,
        Up::Z => Vector::new(v.x, -v.z, v.y),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_have_names_and_angles() {
        assert_eq!("front".parse(), Ok(View::new(0.0, 0.0)));
        assert_eq!("-30, 12.5".parse(), Ok(View::new(-30.0, 12.5)));
        for wrong in ["iso", "1", "1,two", "0,91", "nan,0", "inf,0"] {
            assert!(wrong.parse::<View>().unwrap_err().contains("corner"), "{wrong}");
        }
    }

    #[test]
    fn what_is_up_is_up_and_what_is_near_is_near() {
        for (up, top, near) in
            [(Up::Y, [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]), (Up::Z, [0.0, 0.0, 1.0], [0.0, -1.0, 0.0])]
        {
            let corners = [[-1.0; 3], [1.0; 3]].map(Point::from);
            let camera = Camera::fit("front".parse().unwrap(), up, &corners, [100, 100], 10.0);
            let [x, y, depth] = camera.project(&Point::from(top));
            assert!((x - 50.0).abs() < 1e-9 && (y - 10.0).abs() < 1e-9 && depth.abs() < 1e-9);
            assert!(camera.project(&Point::from(near))[2] > 39.0);
        }
    }
}
