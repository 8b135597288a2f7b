//! Comparing structs that both sides write: a test needs no device.

use crate::library::plain;
use crate::naga::{Module, TypeInner};

/// Size of a WGSL struct and the offsets of its members by name, or none if `module` has no
/// struct of this name.
pub fn of(module: &Module, name: &str) -> Option<(u32, Vec<(String, u32)>)> {
    module.types.iter().find_map(|(_, ty)| {
        let found = plain(ty.name.as_deref()?);
        match &ty.inner {
            TypeInner::Struct { members, span } if found == name => {
                let each = members
                    .iter()
                    .map(|m| (m.name.clone().unwrap_or_default(), m.offset));
                Some((*span, each.collect()))
            }
            _ => None,
        }
    })
}
