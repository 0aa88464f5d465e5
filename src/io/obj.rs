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

use std::io::{self, Write};

use tobj::LoadOptions;

use self::feed::{Feed, bad_number, excerpt};
use self::statements::Statements;
use super::{Format, Loaded, ReadError, ReadFault, Warning, fingerprint};
use crate::mesh::{MeshError, Point, PolyMesh};

/// Coordinates beyond this would overflow where lengths are squared and multiplied.
const LARGEST_COORDINATE: f64 = 1e100;

/// The Wavefront OBJ format.
#[derive(Debug, Clone, Copy, Default)]
pub struct Obj;

impl Format for Obj {
    fn name(&self) -> &'static str {
        "Wavefront OBJ"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["obj"]
    }

    fn read(&self, bytes: &[u8], file: &str) -> Result<Loaded, ReadError> {
        let at = |(line, fault)| ReadError { file: file.to_owned(), line, fault };
        check_text(bytes).map_err(at)?;
        let vertices = count_vertices(bytes);
        if vertices >= i32::MAX as usize {
            let error = MeshError::TooLarge { what: "vertices", count: vertices };
            return Err(at((None, error.into())));
        }
        let mut feed = Feed::new(bytes, vertices);
        let model = load(&mut feed).map_err(at)?;
        let mesh = build(bytes, &mut feed, model).map_err(at)?;
        let warnings = dropped_warning(&feed, file);
        Ok(Loaded { mesh, warnings, sha256: fingerprint(bytes) })
    }

    fn write(&self, mesh: &PolyMesh, out: &mut dyn Write) -> io::Result<()> {
        for point in mesh.points() {
            write_vertex(out, point.iter())?;
        }
        write_faces(mesh, out)
    }

    /// As three more numbers on each `v` line, which Blender, `MeshLab` and others understand.
    fn write_coloured(
        &self,
        mesh: &PolyMesh,
        colours: &[[f64; 3]],
        out: &mut dyn Write,
    ) -> io::Result<()> {
        for (point, colour) in mesh.points().iter().zip(colours) {
            write_vertex(out, point.iter().chain(colour))?;
        }
        write_faces(mesh, out)
    }
}

fn write_vertex<'a>(
    out: &mut dyn Write,
    mut numbers: impl Iterator<Item = &'a f64>,
) -> io::Result<()> {
    out.write_all(b"v")?;
    numbers.try_for_each(|&x| write_number(out, x))?;
    out.write_all(b"\n")
}

/// The faces, with a line where another group begins.
fn write_faces(mesh: &PolyMesh, out: &mut dyn Write) -> io::Result<()> {
    let mut group = None;
    let grouped = mesh.groups().iter().any(|&g| !mesh.group_names()[g as usize].is_empty());
    for (face, &g) in mesh.faces().zip(mesh.groups()) {
        if grouped && group.replace(g) != Some(g) {
            writeln!(out, "{}", group_line(&mesh.group_names()[g as usize]))?;
        }
        out.write_all(b"f")?;
        face.iter().try_for_each(|&v| write!(out, " {}", v + 1))?;
        out.write_all(b"\n")?;
    }
    Ok(())
}

type Located = (Option<usize>, ReadFault);

/// Refuses what is no text at all.
fn check_text(bytes: &[u8]) -> Result<(), Located> {
    if bytes.is_empty() {
        return Err((None, ReadFault::Empty));
    }
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return Err((None, ReadFault::NotUtf8));
    }
    match bytes.iter().position(|&b| b == 0) {
        Some(offset) => Err((None, ReadFault::Binary { offset })),
        None => Ok(()),
    }
}

fn count_vertices(bytes: &[u8]) -> usize {
    Statements::new(bytes).filter(|s| s.keyword() == b"v").count()
}

/// Lets `tobj` read the feed: one model whose first face is the anchor.
fn load(feed: &mut Feed<'_>) -> Result<tobj::Mesh, Located> {
    let no_materials = |_: &std::path::Path| Err(tobj::LoadError::OpenFileFailed);
    let loaded = tobj::load_obj_buf(feed, &LoadOptions::default(), no_materials);
    if let Some((line, fault)) = feed.fault.take() {
        return Err((Some(line), fault));
    }
    match loaded {
        Ok((models, _)) => Ok(models.into_iter().next().map(|m| m.mesh).unwrap_or_default()),
        Err(_) => Err(refused_by_tobj(feed)),
    }
}

/// The fault of the line that `tobj` was given last.
fn refused_by_tobj(feed: &Feed<'_>) -> Located {
    let Some(statement) = &feed.current else { return (None, ReadFault::Empty) };
    let is_number = |w: &[u8]| std::str::from_utf8(w).is_ok_and(|w| w.parse::<f64>().is_ok());
    let fault = match statement.words().skip(1).take(3).find(|w| !is_number(w)) {
        Some(word) if statement.keyword() == b"v" => bad_number(word),
        _ => ReadFault::Syntax {
            reason: "a line that cannot be understood",
            text: excerpt(&statement.text),
            advice: "correct or remove the line",
        },
    };
    (Some(statement.line), fault)
}

/// The mesh behind the anchor, after the checks that `tobj` does not make.
fn build(bytes: &[u8], feed: &mut Feed<'_>, model: tobj::Mesh) -> Result<PolyMesh, Located> {
    let vertices = model.positions.len() / 3;
    if feed.groups.is_empty() {
        let fault = if vertices == 0 { ReadFault::Empty } else { ReadFault::NoFaces { vertices } };
        return Err((None, fault));
    }
    let out_of_bounds = |x: &f64| x.is_nan() || x.abs() > LARGEST_COORDINATE;
    if let Some(at) = model.positions.iter().position(out_of_bounds) {
        return Err(not_finite(bytes, at / 3, at % 3));
    }
    let points = model.positions.chunks_exact(3).map(|p| Point::new(p[0], p[1], p[2])).collect();
    let offsets = offsets(&model.face_arities, feed.groups.len());
    let mut corners = model.indices;
    corners.drain(..vertices);
    let mesh = PolyMesh::from_rows(points, offsets, corners).map_err(|e| (None, e.into()))?;
    let (groups, names) = (std::mem::take(&mut feed.groups), std::mem::take(&mut feed.group_names));
    Ok(mesh.with_groups(groups, names))
}

/// Where each face begins. Without arities everything is a triangle, the anchor in front too.
fn offsets(arities: &[u32], faces: usize) -> Vec<u32> {
    let mut end = 0_u32;
    let ends = (1..=faces).map(|f| {
        // More corners than fit are refused where the mesh is built.
        end = end.wrapping_add(arities.get(f).map_or(3, |&d| d));
        end
    });
    std::iter::once(0).chain(ends).collect()
}

/// Names the line of a coordinate; only errors pay for the search.
fn not_finite(bytes: &[u8], vertex: usize, axis: usize) -> Located {
    let statement = Statements::new(bytes).filter(|s| s.keyword() == b"v").nth(vertex);
    let text = statement.as_ref().and_then(|s| s.words().nth(axis + 1)).map(excerpt);
    let fault = ReadFault::NotFinite { vertex: vertex + 1, text: text.unwrap_or_default() };
    (statement.map(|s| s.line), fault)
}

fn dropped_warning(feed: &Feed<'_>, file: &str) -> Vec<Warning> {
    let first = feed.dropped.iter().map(|&(_, line)| line).min();
    let what = feed.dropped.iter().map(|&(what, _)| what).collect();
    let warning = |line| Warning::Dropped { file: file.to_owned(), what, line };
    first.map(warning).into_iter().collect()
}

/// Writes a space and the shortest decimal that reads back as `x`.
fn write_number(out: &mut dyn Write, x: f64) -> io::Result<()> {
    if x == 0.0 || (1e-5..1e16).contains(&x.abs()) {
        write!(out, " {x}")
    } else {
        write!(out, " {x:e}")
    }
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
