//! What two viewers wrote of the same things, put together key by key.

use serde_json::{Map, Value};

/// What becomes of `theirs`, which is in the file, when `ours` was `base` at first: what we changed is as
/// we have it, and all else stays as it is.
pub(super) fn merge(base: &Value, ours: &Value, theirs: &Value) -> Value {
    let (Value::Object(ours_map), Value::Object(theirs_map)) = (ours, theirs) else {
        return if ours == base { theirs.clone() } else { ours.clone() };
    };
    let nothing = Map::new();
    let base = base.as_object().unwrap_or(&nothing);
    let mut merged = theirs_map.clone();
    for (key, value) in ours_map {
        let before = base.get(key).unwrap_or(&Value::Null);
        let there = theirs_map.get(key).unwrap_or(&Value::Null);
        match merge(before, value, there) {
            Value::Null => drop(merged.remove(key)),
            both => drop(merged.insert(key.clone(), both)),
        }
    }
    // What we took away goes, unless somebody changed it meanwhile.
    for (key, before) in base {
        if !ours_map.contains_key(key) && theirs_map.get(key) == Some(before) {
            merged.remove(key);
        }
    }
    Value::Object(merged)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn what_was_changed_wins_and_all_else_stays() {
        let base =
            json!({ "theme": "dark", "scale": "100", "list": [1], "map": { "a": 1, "b": 2 } });
        let ours =
            json!({ "theme": "light", "scale": "100", "list": [1], "map": { "a": 1, "c": 3 } });
        let theirs = json!({
            "theme": "dark", "scale": "150", "list": [2], "new": true, "map": { "a": 9, "b": 2 }
        });
        let both = json!({
            "theme": "light", "scale": "150", "list": [2], "new": true, "map": { "a": 9, "c": 3 }
        });
        assert_eq!(merge(&base, &ours, &theirs), both, "key by key");
        assert_eq!(merge(&base, &base, &theirs), theirs, "nothing was changed here");
        assert_eq!(merge(&base, &ours, &base), ours, "nothing was changed there");
        let changed = json!({ "map": { "b": 7 } });
        assert_eq!(merge(&base, &ours, &changed)["map"]["b"], 7, "what they changed is not lost");
    }
}
