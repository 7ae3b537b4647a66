//! `downpour schema`: the JSON schema of weather files.

use clap::Args;

use crate::failure::Failure;
use crate::stream;

/// Print the JSON schema of weather files, for editors.
#[derive(Debug, Args)]
pub(crate) struct SchemaArguments {}

impl SchemaArguments {
    #[expect(clippy::unused_self, reason = "as the other commands")]
    pub(crate) fn run(&self) -> Result<(), Failure> {
        stream::print(&format!("{:#}\n", downpour::weather::json_schema()))
    }
}
