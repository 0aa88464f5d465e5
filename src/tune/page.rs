//! stub
use super::{Findings, TuneError};
/// page
pub fn page(_f: &Findings) -> Result<String, TuneError> { Ok(String::new()) }
