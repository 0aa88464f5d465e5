//! A mesh while it is being read: counted, checked, and never larger than what has been read.

use super::{Dropped, ReadFault, ReadOptions};
use crate::mesh::{MeshError, Point, PolyMesh};

/// Coordinates beyond this would overflow where lengths are squared and multiplied.
const LARGEST_COORDINATE: f64 = 1e100;

/// What a reader makes of a file.
#[derive(Debug)]
pub(super) struct Content {
    pub(super) mesh: PolyMesh,
    pub(super) dropped: Dropped,
}

/// How much has been read so far, held against the limits.
#[derive(Debug)]
pub(super) struct Tally<'a> {
    options: &'a ReadOptions,
    pub(super) vertices: usize,
    pub(super) faces: usize,
    corners: usize,
    degree: u32,
}

impl<'a> Tally<'a> {
    pub(super) fn new(options: &'a ReadOptions) -> Self {
        Self { options, vertices: 0, faces: 0, corners: 0, degree: 0 }
    }

    /// What a header announces must be within the limits; no memory is taken for it.
    pub(super) fn announce(&self, vertices: u64, faces: u64) -> Result<(), ReadFault> {
        self.check_vertices(vertices)?;
        self.check_faces(faces)
    }

    /// One more vertex; `text` shows a coordinate as it is written.
    pub(super) fn vertex(
        &mut self,
        point: [f64; 3],
        text: impl Fn(usize) -> String,
    ) -> Result<(), ReadFault> {
        self.vertices += 1;
        self.check_vertices(self.vertices as u64)?;
        let unfit = point.iter().position(|x| x.is_nan() || x.abs() > LARGEST_COORDINATE);
        unfit.map_or(Ok(()), |axis| {
            Err(ReadFault::NotFinite { vertex: self.vertices, text: text(axis) })
        })
    }

    /// One more corner of the face that is being read.
    pub(super) fn corner(&mut self) -> Result<(), ReadFault> {
        self.degree += 1;
        self.corners += 1;
        let limit = self.options.degree;
        if self.degree > limit {
            return Err(ReadFault::TooMany { what: "corners in a face", limit, knob: "degree" });
        }
        if self.corners >= i32::MAX as usize {
            return Err(MeshError::TooLarge { what: "corners", count: self.corners }.into());
        }
        Ok(())
    }

    /// The face is complete.
    pub(super) fn face(&mut self) -> Result<(), ReadFault> {
        self.degree = 0;
        self.faces += 1;
        self.check_faces(self.faces as u64)
    }

    /// Whether the file has what a mesh needs.
    pub(super) fn finish(&self) -> Result<(), ReadFault> {
        match (self.vertices, self.faces) {
            (0, 0) => Err(ReadFault::Empty),
            (vertices, 0) => Err(ReadFault::NoFaces { vertices }),
            _ => Ok(()),
        }
    }

    fn check_vertices(&self, count: u64) -> Result<(), ReadFault> {
        let limit = self.options.vertices;
        let fault = ReadFault::TooMany { what: "vertices", limit, knob: "vertices" };
        if count > u64::from(limit) { Err(fault) } else { Ok(()) }
    }

    fn check_faces(&self, count: u64) -> Result<(), ReadFault> {
        let limit = self.options.faces;
        let fault = ReadFault::TooMany { what: "faces", limit, knob: "faces" };
        if count > u64::from(limit) { Err(fault) } else { Ok(()) }
    }
}

/// The vertex, from 0, that `index` names where numbers begin with `first`.
pub(super) fn vertex_at(index: i64, first: i64, vertices: usize) -> Option<u32> {
    let at = usize::try_from(index.checked_sub(first)?).ok()?;
    (at < vertices).then_some(at as u32)
}

/// Points and faces in the order of the file.
#[derive(Debug)]
pub(super) struct Soup<'a> {
    pub(super) tally: Tally<'a>,
    points: Vec<Point>,
    offsets: Vec<u32>,
    corners: Vec<u32>,
}

impl<'a> Soup<'a> {
    pub(super) fn new(options: &'a ReadOptions) -> Self {
        let (points, offsets, corners) = (Vec::new(), vec![0], Vec::new());
        Self { tally: Tally::new(options), points, offsets, corners }
    }

    /// One more vertex; `text` shows a coordinate as it is written.
    pub(super) fn vertex(
        &mut self,
        point: [f64; 3],
        text: impl Fn(usize) -> String,
    ) -> Result<(), ReadFault> {
        self.tally.vertex(point, text)?;
        self.points.push(Point::from(point));
        Ok(())
    }

    /// One more corner of the face that is being read: the number of one of `vertices`, from 0.
    pub(super) fn corner(&mut self, index: f64, vertices: usize) -> Result<(), ReadFault> {
        self.tally.corner()?;
        // No number of a vertex is beyond what f64 holds exactly.
        let whole = (index.fract() == 0.0).then_some(index as i64);
        let vertex = whole.and_then(|i| vertex_at(i, 0, vertices));
        let fault = || ReadFault::IndexOutOfRange {
            face: self.tally.faces + 1,
            index: index.to_string(),
            first: 0,
            vertices,
        };
        self.corners.push(vertex.ok_or_else(fault)?);
        Ok(())
    }

    /// The face is complete.
    pub(super) fn end_face(&mut self) -> Result<(), ReadFault> {
        self.offsets.push(self.corners.len() as u32);
        self.tally.face()
    }

    /// The mesh, if it is one.
    pub(super) fn finish(self, dropped: Dropped) -> Result<Content, ReadFault> {
        self.tally.finish()?;
        let mesh = PolyMesh::from_rows(self.points, self.offsets, self.corners)?;
        Ok(Content { mesh, dropped })
    }
}
