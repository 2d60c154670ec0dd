//! Tests of kit files: whole documents, partial files, and what is refused.

mod broken;
mod draw;
mod partial;
mod refused;
mod whole;

use crate::kit_document::KitDocument;

/// The document of a text that is accepted.
fn accepted(text: &str) -> KitDocument {
    super::read("my.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The standard kit, changed by what follows.
fn changed(text: &str) -> KitDocument {
    accepted(&format!("format = 1\n{text}"))
}

/// The error of a text: its line, and what it says of it.
fn error(text: &str) -> String {
    let error = super::read("my.toml", text).map(|_| ()).expect_err(text).to_string();
    assert_eq!(error.lines().count(), 1, "{error}");
    error.strip_prefix("my.toml, line ").unwrap_or_else(|| panic!("{error}")).to_owned()
}
