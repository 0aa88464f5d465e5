//! Scatter plots as SVG that takes its colours from the style of the page.

use crate::report::escaped;
use std::fmt::Write;

/// Space for words left of and below the plot.
const LEFT: f64 = 52.0;
const RIGHT: f64 = 10.0;
const TOP: f64 = 10.0;
const BOTTOM: f64 = 40.0;
/// Room between the outermost points and the frame, as a share.
const ROOM: f64 = 0.05;

/// An axis: what it says, its range, and whether ratios count.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Axis {
    words: String,
    low: f64,
    high: f64,
    log: bool,
}

impl Axis {
    /// An axis that shows all the values.
    pub(super) fn around(words: &str, values: impl Iterator<Item = f64>, log: bool) -> Self {
        let (low, high) = values
            .filter(|v| v.is_finite() && (!log || *v > 0.0))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let (low, high) = if low <= high { (low, high) } else { (1.0, 1.0) };
        let (low, high) = if high - low > 1e-9 * high.abs() {
            (low, high)
        } else {
            (low - 0.05 * low.abs() - 1e-9, high + 0.05 * high.abs() + 1e-9)
        };
        Self::from_to(words, (low, high), log)
    }

    /// An axis from the first number to the second.
    pub(super) fn from_to(words: &str, (low, high): (f64, f64), log: bool) -> Self {
        Self { words: words.to_owned(), low, high, log: log && low > 0.0 }
    }

    /// From 0 to 1 inside the frame.
    fn share(&self, value: f64) -> f64 {
        let share = if self.log {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        };
        ROOM + (1.0 - 2.0 * ROOM) * share
    }

    /// Round numbers inside, about four.
    fn ticks(&self) -> Vec<f64> {
        let inside = |v: &f64| *v >= self.low * (1.0 - 1e-9) && *v <= self.high * (1.0 + 1e-9);
        if self.log && self.high / self.low > 5.0 {
            let (from, to) = (self.low.log10().floor() as i32, self.high.log10().ceil() as i32);
            let steps: &[f64] = if to - from > 2 { &[1.0] } else { &[1.0, 3.0] };
            let all = (from..=to).flat_map(|p| steps.iter().map(move |s| s * 10.0_f64.powi(p)));
            return all.filter(inside).collect();
        }
        let rough = (self.high - self.low) / 4.0;
        let power = 10.0_f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|s| *s >= rough);
        let step = step.unwrap_or(rough);
        let first = (self.low / step).ceil() as i64;
        (first..first + 12).map(|i| i as f64 * step).take_while(|v| *v <= self.high).collect()
    }
}

/// What a point stands for; later ones are drawn over earlier ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Mark {
    Trial,
    Front,
    Start,
    Best,
}

impl Mark {
    /// The mark alone, for keys; shapes differ, not only colours.
    pub(super) fn sign(self, [x, y]: [f64; 2], title: &str) -> String {
        let title = format!("<title>{}</title>", escaped(title));
        match self {
            Self::Trial => format!(
                "<circle class=\"trial\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.5\">{title}</circle>"
            ),
            Self::Front => format!(
                "<circle class=\"front\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"5\">{title}</circle>"
            ),
            Self::Start => format!(
                "<rect class=\"start\" x=\"{:.1}\" y=\"{:.1}\" width=\"9\" height=\"9\">{title}</rect>",
                x - 4.5,
                y - 4.5
            ),
            Self::Best => format!(
                "<path class=\"best\" d=\"M{x:.1} {:.1}l6.5 6.5l-6.5 6.5l-6.5 -6.5z\">{title}</path>",
                y - 6.5
            ),
        }
    }
}

/// A point with what the pointer is told there.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Dot {
    pub(super) at: [f64; 2],
    pub(super) mark: Mark,
    pub(super) title: String,
}

/// A plot of dots, and of a line of steps through others if there are any.
#[derive(Debug, Clone)]
pub(super) struct Plot<'a> {
    pub(super) label: &'a str,
    pub(super) size: [f64; 2],
    pub(super) axes: [Axis; 2],
    pub(super) dots: Vec<Dot>,
    pub(super) steps: Vec<[f64; 2]>,
}

impl Plot<'_> {
    fn x(&self, value: f64) -> f64 {
        LEFT + self.axes[0].share(value) * (self.size[0] - LEFT - RIGHT)
    }

    fn y(&self, value: f64) -> f64 {
        TOP + (1.0 - self.axes[1].share(value)) * (self.size[1] - TOP - BOTTOM)
    }

    /// The drawing.
    pub(super) fn svg(&self) -> String {
        let [width, height] = self.size;
        let label = escaped(self.label);
        let mut svg =
            format!("<svg viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{label}\">");
        self.draw_frame(&mut svg);
        self.draw_steps(&mut svg);
        let mut dots: Vec<&Dot> = self.dots.iter().collect();
        dots.sort_by_key(|d| d.mark);
        for dot in dots {
            svg += &dot.mark.sign([self.x(dot.at[0]), self.y(dot.at[1])], &dot.title);
        }
        svg + "</svg>"
    }

    // Writing to a string cannot fail.
    fn draw_frame(&self, svg: &mut String) {
        let ([width, height], [x, y]) = (self.size, &self.axes);
        let (right, bottom) = (width - RIGHT, height - BOTTOM);
        for value in y.ticks() {
            let at = self.y(value);
            let _ = write!(
                svg,
                "<line class=\"grid\" x1=\"{LEFT}\" x2=\"{right}\" y1=\"{at:.1}\" y2=\"{at:.1}\"/>\
                 <text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                LEFT - 6.0,
                at + 4.0,
                number(value)
            );
        }
        for value in x.ticks() {
            let at = self.x(value);
            let _ = write!(
                svg,
                "<line class=\"grid\" x1=\"{at:.1}\" x2=\"{at:.1}\" y1=\"{TOP}\" y2=\"{bottom}\"/>\
                 <text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                bottom + 16.0,
                number(value)
            );
        }
        let (middle, side) = (f64::midpoint(LEFT, right), f64::midpoint(TOP, bottom));
        let _ = write!(
            svg,
            "<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">{}</text>\
             <text x=\"12\" y=\"{side}\" text-anchor=\"middle\" \
             transform=\"rotate(-90 12 {side})\">{}</text>",
            height - 6.0,
            escaped(&x.words),
            escaped(&y.words)
        );
    }

    fn draw_steps(&self, svg: &mut String) {
        let Some((first, rest)) = self.steps.split_first() else { return };
        let _ = write!(
            svg,
            "<path class=\"steps\" d=\"M{:.1} {:.1}",
            self.x(first[0]),
            self.y(first[1])
        );
        for [x, y] in rest {
            let _ = write!(svg, "H{:.1}V{:.1}", self.x(*x), self.y(*y));
        }
        *svg += "\"/>";
    }
}

/// A number with as many digits as it needs, at most four.
pub(super) fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    rounded.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let axis = |low, high, log| Axis::from_to("", (low, high), log).ticks();
        assert_eq!(axis(0.0, 8.0, false), [0.0, 2.0, 4.0, 6.0, 8.0]);
        assert_eq!(axis(0.02, 2.0, true), [0.1, 1.0]);
        assert_eq!(axis(0.9, 1.0, true).len(), 3);
        assert_eq!(axis(1.0, 1e6, true).len(), 7);
    }

    #[test]
    fn an_axis_has_room_for_what_is_all_the_same() {
        for value in [0.0, 1.0, -3.0] {
            let axis = Axis::around("", [value, value].into_iter(), false);
            assert!((axis.share(value) - 0.5).abs() < 1e-6, "{axis:?}");
        }
        assert!(Axis::around("", std::iter::empty(), true).share(1.0).is_finite());
    }

    #[test]
    fn titles_are_text() {
        let dot = Dot { at: [1.0, 1.0], mark: Mark::Best, title: "<a> & b".to_owned() };
        let axes = [(); 2].map(|()| Axis::from_to("x", (0.0, 2.0), false));
        let plot =
            Plot { label: "a \"b\"", size: [100.0, 100.0], axes, dots: vec![dot], steps: vec![] };
        let svg = plot.svg();
        assert!(svg.contains("&lt;a> &amp; b") && svg.contains("a &quot;b&quot;"), "{svg}");
    }
}
