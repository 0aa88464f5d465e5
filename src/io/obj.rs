//! Wavefront OBJ: `v` and `f` lines, faces of any degree, groups.
//!
//! Read through the crate `tobj`, which is given one checked line at a time (see `feed`), written
//! here. Coordinates are written with the fewest digits that read back as the same number.
//! Format: Wavefront Technologies, *Advanced Visualizer Manual*, appendix B1, 1992.
//!
//! *Invariant:* vertices and faces keep the order of the file; a mesh that is written and read
//! again is the same mesh, to the last bit.

mod feed;
mod statements;

use std::io::{self, BufRead, Write};

use tobj::LoadOptions;

use self::feed::Feed;
use self::statements::Statements;
use super::fault::{Located, whole};
use super::soup::{Content, Tally};
use super::text::{Lines, excerpt, write_number, write_rows};
use super::{Colour, Format, ReadFault, ReadOptions};
use crate::mesh::{Point, PolyMesh};

/// The Wavefront OBJ format.
pub const OBJ: Format =
    Format { name: "obj", extensions: &["obj"], starts: &[], read, write: Some(write) };

fn read(source: &mut dyn BufRead, options: &ReadOptions) -> Result<Content, Located> {
    let lines = Lines::new(source).map_err(whole)?;
    let mut feed = Feed::new(Statements::new(lines), Tally::new(options));
    let model = load(&mut feed)?;
    feed.tally.finish().map_err(whole)?;
    let mesh = build(&mut feed, model).map_err(whole)?;
    Ok(Content { mesh, dropped: feed.dropped })
}

/// Lets `tobj` read the feed: one model whose last face is the anchor.
fn load(feed: &mut Feed<'_>) -> Result<tobj::Mesh, Located> {
    let no_materials = |_: &std::path::Path| Err(tobj::LoadError::OpenFileFailed);
    let loaded = tobj::load_obj_buf(feed, &LoadOptions::default(), no_materials);
    if let Some(fault) = feed.fault.take() {
        return Err(fault);
    }
    // Everything in the lines has been checked, so this refuses nothing that we know of.
    let refused = |_| ReadFault::Syntax {
        reason: "a line that cannot be understood",
        text: excerpt(&feed.current.text),
        advice: "correct or remove the line",
    };
    let (models, _) = loaded.map_err(|e| (Some(feed.current.line), refused(e)))?;
    Ok(models.into_iter().next().map(|m| m.mesh).unwrap_or_default())
}

/// The mesh before the anchor, its vertices in the order of the file again.
fn build(feed: &mut Feed<'_>, model: tobj::Mesh) -> Result<PolyMesh, ReadFault> {
    let mut corners = model.indices;
    let anchor = corners.split_off(corners.len().saturating_sub(feed.tally.vertices));
    let point = |&v: &u32| {
        let at = 3 * v as usize;
        Point::new(model.positions[at], model.positions[at + 1], model.positions[at + 2])
    };
    let points: Vec<Point> = anchor.iter().map(point).collect();
    let mut in_file = vec![0; points.len()];
    for (v, &moved) in (0_u32..).zip(&anchor) {
        in_file[moved as usize] = v;
    }
    for v in &mut corners {
        *v = in_file[*v as usize];
    }
    let offsets = offsets(&model.face_arities, feed.groups.len());
    let mesh = PolyMesh::from_rows(points, offsets, corners)?;
    let (groups, names) = (std::mem::take(&mut feed.groups), std::mem::take(&mut feed.group_names));
    Ok(mesh.with_groups(groups, names))
}

/// Where each face begins. Without arities everything is a triangle.
fn offsets(arities: &[u32], faces: usize) -> Vec<u32> {
    let mut end = 0;
    let ends = (0..faces).map(|f| {
        end += arities.get(f).map_or(3, |&d| d);
        end
    });
    std::iter::once(0).chain(ends).collect()
}

/// Colours are three more numbers on each `v` line, which Blender, `MeshLab` and others understand.
fn write(mesh: &PolyMesh, colours: Option<&[Colour]>, out: &mut dyn Write) -> io::Result<()> {
    write_rows(out, mesh.vertex_count(), |v, out| {
        out.write_all(b"v")?;
        let mut numbers = mesh.points()[v].iter().chain(colours.map_or(&[][..], |c| &c[v]));
        numbers.try_for_each(|&x| write_number(out, x))?;
        out.write_all(b"\n")
    })?;
    write_faces(mesh, out)
}

/// The faces, with a line where another group begins.
fn write_faces(mesh: &PolyMesh, out: &mut dyn Write) -> io::Result<()> {
    let groups = mesh.groups();
    let grouped = groups.iter().any(|&g| !mesh.group_names()[g as usize].is_empty());
    write_rows(out, mesh.face_count(), |f, out| {
        if grouped && (f == 0 || groups[f] != groups[f - 1]) {
            writeln!(out, "{}", group_line(&mesh.group_names()[groups[f] as usize]))?;
        }
        out.write_all(b"f")?;
        mesh.face(f).iter().try_for_each(|&v| write!(out, " {}", v + 1))?;
        out.write_all(b"\n")
    })
}

/// The line that opens a group. What would not read back as part of a name is replaced.
fn group_line(name: &str) -> String {
    let mut line = String::from("g");
    for word in name.split(|c: char| c.is_whitespace() || c.is_control()) {
        if !word.is_empty() {
            line.push(' ');
            line.push_str(&word.replacen('#', "_", usize::from(word.starts_with('#'))));
        }
    }
    if line.ends_with('\\') {
        line.pop();
        line.push('_');
    }
    line
}
