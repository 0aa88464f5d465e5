//! The single numbers that tables, limits and comparisons speak of, one line each.

use super::{Degenerate, Metrics};

/// Which direction is an improvement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Better {
    /// Smaller values.
    Lower,
    /// Larger values.
    Higher,
    /// Neither: a change is worth a look, not a judgement.
    Neither,
}

/// How a number is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A whole number.
    Count,
    /// A number with four significant digits.
    Real,
    /// A share or relative length, 1 = 100 %, written as a percentage.
    Share,
    /// 0 or 1, written as no or yes.
    Flag,
}

/// One number of [`Metrics`] with what is needed to show and judge it.
#[derive(Debug, Clone, Copy)]
pub struct Metric {
    /// Unique name; where the JSON summary has the number, the name it has there.
    pub key: &'static str,
    /// Heading under which it is listed.
    pub group: &'static str,
    /// Name for people.
    pub label: &'static str,
    /// Unit for people; empty for counts and flags.
    pub unit: &'static str,
    /// Which direction is an improvement.
    pub better: Better,
    /// How it is written.
    pub kind: Kind,
    /// Whether it is only worth a line where it is not 0.
    pub quiet: bool,
    /// The number; `None` where it is undefined or was not measured.
    pub value: fn(&Metrics) -> Option<f64>,
}

/// The metric called `key`.
#[must_use]
pub fn metric(key: &str) -> Option<&'static Metric> {
    METRICS.iter().find(|m| m.key == key)
}

use Better::{Higher, Lower, Neither};
use Kind::{Count, Flag, Real, Share};

/// All of them, in the order in which they are listed.
pub const METRICS: &[Metric] = &[
    size("V", "vertices", |m| count(m.summary.vertices)),
    size("E", "edges", |m| count(m.summary.edges)),
    size("F", "faces", |m| count(m.summary.faces)),
    size("chi", "Euler characteristic", |m| signed(m.summary.chi)),
    size("components", "components", |m| count(m.summary.components)),
    size("genus", "genus", |m| signed(m.summary.genus)),
    size("boundary_loops", "boundary loops", |m| count(m.summary.boundary_loops)),
    flag("manifold", "manifold", |m| yes(m.summary.manifold)),
    flag("oriented", "consistently oriented", |m| yes(m.summary.oriented)),
    flag("gauss_bonnet_exact", "Gauss-Bonnet exact", |m| yes(m.summary.gauss_bonnet_exact)),
    fault("nonmanifold_edges", "non-manifold edges", |m| {
        count(m.topology.connectivity.nonmanifold_edges)
    }),
    fault("nonmanifold_vertices", "non-manifold vertices", |m| {
        count(m.topology.connectivity.nonmanifold_vertices)
    }),
    fault("duplicate_faces", "duplicate faces", |m| count(degenerate(m).duplicate_faces)),
    fault("faces_repeated_vertex", "faces that repeat a vertex", |m| {
        count(degenerate(m).faces_repeated_vertex)
    }),
    fault("face_pairs_sharing_2plus_edges", "face pairs sharing edges twice", |m| {
        count(degenerate(m).face_pairs_sharing_2plus_edges)
    }),
    fault("doublets_valence2_interior", "doublets", |m| {
        count(degenerate(m).doublets_valence2_interior)
    }),
    fault("valence1_interior", "valence-1 vertices", |m| count(degenerate(m).valence1_interior)),
    fault("zero_area_faces", "faces without area", |m| count(m.quality.zero_area_faces)),
    irregular("irregular_elements", "irregular elements E", |m| {
        count(m.summary.irregular_elements)
    }),
    irregular("irregular_vertices", "irregular vertices", |m| {
        count(m.topology.irregularity.irregular.irregular_vertices)
    }),
    irregular("irregular_faces", "irregular faces", |m| {
        count(m.topology.irregularity.irregular.irregular_faces)
    }),
    irregular("t_junctions", "T-junctions", |m| count(m.summary.t_junctions)),
    Metric {
        better: Neither,
        ..irregular("lower_bound", "lower bound of E", |m| signed(m.summary.lower_bound))
    },
    Metric {
        kind: Share,
        better: Higher,
        ..irregular("quad_share", "share of quads", |m| Some(m.topology.irregularity.quad_share))
    },
    angle("fig10_mean", "angle deviation, mean", |m| m.summary.fig10_mean),
    angle("fig10_max", "angle deviation, worst face", |m| {
        m.quality.angles.fig10_face_angle_deviation_deg.max
    }),
    angle("angle_dev_mean", "quad angles off 90°, mean", |m| m.summary.angle_dev_mean),
    shape("scaled_jacobian_mean", "scaled Jacobian, mean", Higher, |m| {
        m.summary.scaled_jacobian_mean
    }),
    shape("scaled_jacobian_min", "scaled Jacobian, worst", Higher, |m| {
        m.summary.scaled_jacobian_min
    }),
    Metric {
        kind: Count,
        quiet: true,
        ..shape("inverted_quads", "inverted quads", Lower, |m| {
            m.quality.scaled_jacobian_quads.and_then(|j| count(j.count_below_0))
        })
    },
    shape("planarity_mean", "planarity, mean", Lower, |m| {
        m.quality.planarity_quads.and_then(|p| p.mean)
    }),
    shape("edge_cv", "edge length variation", Lower, |m| m.summary.edge_cv),
    distance("hausdorff", "Hausdorff, two-way", |m| m.summary.hausdorff),
    distance("rms", "RMS, two-way", |m| m.summary.rms),
    distance("mesh_to_ref_hausdorff", "Hausdorff, mesh to reference", |m| {
        m.reference.as_ref().map(|r| r.mesh_to_ref.surface.hausdorff)
    }),
    distance("ref_to_mesh_hausdorff", "Hausdorff, reference to mesh", |m| {
        m.reference.as_ref().map(|r| r.ref_to_mesh.hausdorff)
    }),
    distance("feature_distance_mean", "sharp edges to mesh edges, mean", |m| {
        m.reference.as_ref().and_then(|r| r.features.to_any_mesh_edge).map(|d| d.mean)
    }),
    Metric {
        kind: Real,
        unit: "°",
        ..distance("normal_deviation_mean", "normal deviation, mean", |m| {
            m.reference.as_ref().and_then(|r| r.orientation.normal_deviation_deg.mean)
        })
    },
    Metric {
        kind: Count,
        unit: "",
        ..distance("flipped_faces", "flipped faces", |m| m.summary.flipped_faces.and_then(count))
    },
];

const BLANK: Metric = Metric {
    key: "",
    group: "",
    label: "",
    unit: "",
    better: Neither,
    kind: Count,
    quiet: false,
    value: |_| None,
};

type Value = fn(&Metrics) -> Option<f64>;

const fn size(key: &'static str, label: &'static str, value: Value) -> Metric {
    Metric { key, group: "connectivity", label, value, ..BLANK }
}

const fn flag(key: &'static str, label: &'static str, value: Value) -> Metric {
    Metric { kind: Flag, better: Higher, ..size(key, label, value) }
}

const fn fault(key: &'static str, label: &'static str, value: Value) -> Metric {
    Metric { better: Lower, quiet: true, ..size(key, label, value) }
}

const fn irregular(key: &'static str, label: &'static str, value: Value) -> Metric {
    Metric { key, group: "irregularity", label, better: Lower, value, ..BLANK }
}

const fn shape(key: &'static str, label: &'static str, better: Better, value: Value) -> Metric {
    Metric { key, group: "quality", label, better, kind: Real, value, ..BLANK }
}

const fn angle(key: &'static str, label: &'static str, value: Value) -> Metric {
    Metric { unit: "°", ..shape(key, label, Lower, value) }
}

/// Relative to the bounding-box diagonal of the reference.
const fn distance(key: &'static str, label: &'static str, value: Value) -> Metric {
    let unit = "of diagonal";
    Metric {
        key,
        group: "distance to the reference",
        label,
        unit,
        better: Lower,
        kind: Share,
        value,
        ..BLANK
    }
}

// A count is always there; the `Option` lets it stand beside numbers that are not.
#[allow(clippy::unnecessary_wraps)]
fn count(n: usize) -> Option<f64> {
    Some(n as f64)
}

#[allow(clippy::unnecessary_wraps)]
fn signed(n: i64) -> Option<f64> {
    Some(n as f64)
}

#[allow(clippy::unnecessary_wraps)]
fn yes(flag: bool) -> Option<f64> {
    Some(f64::from(u8::from(flag)))
}

fn degenerate(m: &Metrics) -> &Degenerate {
    &m.topology.degenerate
}
