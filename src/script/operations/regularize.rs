//! Refilling disks with as few irregular elements as their rims allow.

use super::Operation;
use crate::moves::MoveRefusal;
use crate::moves::regularize::{Refusal, Regularized, around, faces};
use crate::script::address::{Address, Select};
use crate::script::error::Trouble;
use crate::script::run::Done;
use crate::script::session::Session;
use crate::watch::Watch;
use serde::Deserialize;

/// Regularises a disk around each element, or the one that a set of faces is.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Regularize {
    at: Option<Address>,
    #[serde(default)]
    faces: Vec<Address>,
    /// Most faces of a disk.
    #[serde(default = "patch")]
    most: usize,
}

fn patch() -> usize {
    60
}

impl Operation for Regularize {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        match (&self.at, &self.faces[..]) {
            (Some(at), []) => self.around(session, at),
            (None, set @ [_, ..]) => {
                let mut disk = Vec::new();
                for address in set {
                    disk.extend(address.find(session, Select::Faces)?);
                }
                let made = faces(session.mesh_mut(), &disk, self.most);
                made.map(done).map_err(refused)
            }
            _ => Err(Trouble::other("a disk is either `at` an element or a list of `faces`")),
        }
    }
}

impl Regularize {
    /// Of several elements, those stay that are as regular as can be.
    fn around(&self, session: &mut Session, at: &Address) -> Result<Done, Trouble> {
        let about = at.selects().unwrap_or(Select::Elements);
        let elements = at.find(session, Select::Irregular)?;
        let several = elements.len() > 1;
        let made = session.each(&elements, about, |session, v| {
            match around(session.mesh_mut(), v, self.most) {
                Ok(made) => Ok(done(made)),
                Err(_) if several => Ok(Done::default()),
                Err(refusal) => Err(refused(refusal)),
            }
        })?;
        let words = format!("{} of {} disks refilled", made.refills.len(), elements.len());
        Ok(Done { words, ..made })
    }
}

fn done(Regularized { refill, delta }: Regularized) -> Done {
    let words = format!("{} elements fewer", -delta);
    Done { words, refills: vec![refill], ..Done::default() }
}

/// The refusal as a trouble, which names elements as the file does.
fn refused(refusal: Refusal) -> Trouble {
    match refusal {
        Refusal::Gone(v) => MoveRefusal::Gone(v).into(),
        _ => Trouble::other(refusal.to_string()),
    }
}
