//! `clean --pictures`: the mesh before and after, from the same places.

use std::path::Path;

use super::failure::Failure;
use super::look::{Heat, Look, NamedView, Shown};
use super::output;

/// The views if none are asked for.
const VIEWS: &[&str] = &["corner", "behind"];

/// Writes into a folder that is there a picture of each mesh from each view, and one more with the heat map if there is one.
pub(super) fn write(folder: &Path, look: &Look, meshes: &[Shown; 2]) -> Result<(), Failure> {
    let heat = look.range(meshes);
    for view in look.views_or(VIEWS) {
        pair(folder, look, meshes, &view, None)?;
        if heat.is_some() {
            pair(folder, look, meshes, &view, heat)?;
        }
    }
    Ok(())
}

fn pair(
    folder: &Path,
    look: &Look,
    meshes: &[Shown; 2],
    view: &NamedView,
    heat: Heat,
) -> Result<(), Failure> {
    let field = heat.map(|(field, _)| format!("-{}", field.key)).unwrap_or_default();
    let images = look.draw_apart(meshes, view, heat)?;
    for (when, image) in ["before", "after"].iter().zip(images) {
        output::picture(&folder.join(format!("{when}-{}{field}.png", view.name)), &image)?;
    }
    Ok(())
}
