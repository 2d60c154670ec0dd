//! Tables as typed values, with the path of what does not fit.
//!
//! Serde's own deserializer for TOML values forgets where it is, and says in prose what it accepts. This one keeps both, for
//! messages that name the field and its units.

mod mistake;

use serde::de::value::BorrowedStrDeserializer;
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, Error as _, MapAccess, SeqAccess, Visitor,
};
use serde::forward_to_deserialize_any;
use toml::{Table, Value};

use super::error::Fault;
use super::source::Origins;

use mistake::{Mistake, unexpected};

/// Reads a typed value that stands at a path, with the names of further fields that are accepted there.
pub(super) fn read<T: DeserializeOwned>(
    value: &Value,
    path: &str,
    further: &[&str],
    origins: &Origins,
) -> Result<T, Fault> {
    T::deserialize(At(value)).map_err(|mistake| mistake.located(value, path, further, origins))
}

/// A value to be read.
struct At<'de>(&'de Value);

impl<'de> At<'de> {
    fn wrong<T>(&self, visitor: &impl Visitor<'de>) -> Result<T, Mistake> {
        Err(Mistake::invalid_type(unexpected(self.0), visitor))
    }

    fn map<V: Visitor<'de>>(table: &'de Table, visitor: V) -> Result<V::Value, Mistake> {
        visitor.visit_map(Entries { entries: table.iter(), value: None })
    }
}

impl<'de> Deserializer<'de> for At<'de> {
    type Error = Mistake;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mistake> {
        match self.0 {
            Value::String(text) => visitor.visit_borrowed_str(text),
            Value::Integer(whole) => visitor.visit_i64(*whole),
            Value::Float(number) => visitor.visit_f64(*number),
            Value::Boolean(yes) => visitor.visit_bool(*yes),
            Value::Table(table) => At::map(table, visitor),
            // Arrays are asked for by their length; elsewhere Serde would take one for the fields of a table in order.
            Value::Array(_) | Value::Datetime(_) => self.wrong(&visitor),
        }
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, Mistake> {
        match self.0 {
            Value::Array(array) if array.len() == length => {
                visitor.visit_seq(Elements { elements: array.iter().enumerate() })
            }
            Value::Array(array) => Err(Mistake::invalid_length(array.len(), &visitor)),
            _ => self.wrong(&visitor),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        _fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Mistake> {
        match self.0 {
            Value::Table(table) => At::map(table, visitor),
            _ => self.wrong(&visitor),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        _variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Mistake> {
        match self.0 {
            Value::String(text) => visitor.visit_enum(Name(text)),
            _ => self.wrong(&visitor),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mistake> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        visitor: V,
    ) -> Result<V::Value, Mistake> {
        visitor.visit_newtype_struct(self)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct seq
        tuple_struct map identifier ignored_any
    }
}

/// The name of a variant without content.
struct Name<'de>(&'de str);

impl<'de> EnumAccess<'de> for Name<'de> {
    type Error = Mistake;
    type Variant = <BorrowedStrDeserializer<'de, Mistake> as EnumAccess<'de>>::Variant;

    fn variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<(T::Value, Self::Variant), Mistake> {
        EnumAccess::variant_seed(BorrowedStrDeserializer::new(self.0), seed)
    }
}

struct Entries<'de> {
    entries: toml::map::Iter<'de, String, Value>,
    value: Option<(&'de str, &'de Value)>,
}

impl<'de> MapAccess<'de> for Entries<'de> {
    type Error = Mistake;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Mistake> {
        let Some((key, value)) = self.entries.next() else { return Ok(None) };
        self.value = Some((key, value));
        seed.deserialize(BorrowedStrDeserializer::new(key)).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Mistake> {
        let (key, value) = self.value.take().ok_or_else(|| Mistake::custom("a value without a key"))?;
        seed.deserialize(At(value)).map_err(|mistake| mistake.inside(key))
    }
}

struct Elements<'de> {
    elements: std::iter::Enumerate<std::slice::Iter<'de, Value>>,
}

impl<'de> SeqAccess<'de> for Elements<'de> {
    type Error = Mistake;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Mistake> {
        let Some((index, value)) = self.elements.next() else { return Ok(None) };
        seed.deserialize(At(value)).map(Some).map_err(|mistake| mistake.inside(index.to_string()))
    }
}
