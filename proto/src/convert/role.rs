//! What a viewer may do.

use common::Role;

use crate::v1;

impl From<Role> for v1::Role {
    fn from(role: Role) -> Self {
        match role {
            Role::Observer => Self::Observer,
            Role::Driver => Self::Driver,
        }
    }
}

/// A role; one of a later version may at least observe.
pub(super) fn role(code: i32) -> Role {
    match v1::Role::try_from(code) {
        Ok(v1::Role::Driver) => Role::Driver,
        Ok(v1::Role::Observer | v1::Role::Unspecified) | Err(_) => Role::Observer,
    }
}
