//! The [JSON Schema](https://json-schema.org) of traces, in `docs/trace.schema.json`. Its tests hold it against every
//! line, and every key of every line, that is written: `cargo test -p trace-schema`.

use boon::{Compiler, SchemaIndex, Schemas};
use serde_json::Value;

const SOURCE: &str = include_str!("../../docs/trace.schema.json");

/// The schema of the lines of a trace.
pub struct Schema {
    schemas: Schemas,
    index: SchemaIndex,
    document: Value,
}

/// Why the document is not a schema.
pub type SchemaError = Box<dyn std::error::Error>;

impl Schema {
    /// The schema in the documents.
    ///
    /// # Errors
    /// When the document is no JSON, or no schema.
    pub fn new() -> Result<Self, SchemaError> {
        let document: Value = serde_json::from_str(SOURCE)?;
        let (mut schemas, mut compiler) = (Schemas::new(), Compiler::new());
        compiler.add_resource("trace.json", document.clone()).map_err(|error| error.to_string())?;
        let index =
            compiler.compile("trace.json", &mut schemas).map_err(|error| error.to_string())?;
        Ok(Schema { schemas, index, document })
    }

    /// What is wrong with a line; `None` if it is as the schema says.
    #[must_use]
    pub fn complaint(&self, line: &Value) -> Option<String> {
        self.schemas.validate(line, self.index).err().map(|error| error.to_string())
    }

    /// Whether the schema of this kind of line names all of its keys.
    #[must_use]
    pub fn describes(&self, line: &Value) -> bool {
        let name = if line["type"] == "event" { &line["event"] } else { &line["type"] };
        let (Some(name), Some(line)) = (name.as_str(), line.as_object()) else { return false };
        let known = &self.document["$defs"][name]["properties"];
        line.keys().all(|key| !known[key].is_null())
    }
}
