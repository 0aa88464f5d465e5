//! Reads mesh files for experiments that are not part of the test suite.
//!
//! They run only when asked for and when `QUADMEND_DATA` names a directory of `NAME.obj` and
//! `NAME.ref.obj`.

use std::fs::read_to_string;
use std::path::PathBuf;

use crate::mesh::{Point, PolyMesh};

/// The mesh and the reference called `name`; `None` if there is no such data.
pub(crate) fn pair(name: &str) -> Option<(PolyMesh, PolyMesh)> {
    let directory = PathBuf::from(std::env::var_os("QUADMEND_DATA")?);
    let read = |suffix: &str| {
        read_to_string(directory.join(format!("{name}{suffix}"))).ok().map(|text| parse(&text))
    };
    Some((read(".obj")?, read(".ref.obj")?))
}

/// The names of all pairs there are, in order.
pub(crate) fn names() -> Vec<String> {
    let Some(directory) = std::env::var_os("QUADMEND_DATA") else { return Vec::new() };
    let files = std::fs::read_dir(directory).into_iter().flatten().flatten();
    let mut names: Vec<String> = files
        .filter_map(|f| Some(f.file_name().to_str()?.strip_suffix(".ref.obj")?.to_owned()))
        .collect();
    names.sort();
    names
}

/// Plain `v` and `f` lines of well-formed files.
fn parse(text: &str) -> PolyMesh {
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let x: Vec<f64> = words.take(3).map(|w| w.parse().unwrap()).collect();
                points.push(Point::from_slice(&x));
            }
            Some("f") => {
                let id = |w: &str| w.split('/').next().unwrap().parse::<u32>().unwrap() - 1;
                faces.push(words.map(id).collect::<Vec<u32>>());
            }
            _ => {}
        }
    }
    PolyMesh::new(points, faces).unwrap()
}
