//! `downpour schema`: the JSON schema of weather files.

use crate::failure::Failure;
use crate::stream;

pub(super) fn run() -> Result<(), Failure> {
    stream::print(&format!("{:#}\n", downpour::weather::json_schema()))
}
