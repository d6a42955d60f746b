//! Heckbert's class of a path as a key.

use std::fmt;

use super::Path;

/// Letters that a key holds; longer paths share the key of their lens end.
const LETTERS: usize = 25;
/// Bits of a letter.
const BITS: usize = 5;

/// A path's class, such as `LDSE`, in one number: five bits a letter, the lens lowest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ClassKey(u128);

impl ClassKey {
    /// The class of a path.
    pub fn of(path: &Path) -> Self {
        Self::of_letters(path.vertices().iter().map(|v| v.kind.letter()))
    }

    /// The class that reads as these capital letters.
    pub fn of_letters(letters: impl Iterator<Item = char>) -> Self {
        const ALL: u128 = (1 << (BITS * LETTERS)) - 1;
        let letter = |c: char| u128::from(c as u32 & 31);
        Self(letters.fold(0, |key, c| (key << BITS | letter(c)) & ALL))
    }
}

impl fmt::Display for ClassKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let letters = (0..LETTERS).rev().map(|place| (self.0 >> (BITS * place)) as u8 & 31);
        for letter in letters.skip_while(|&letter| letter == 0) {
            write!(f, "{}", char::from(letter + 64))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_read_as_classes() {
        let key = |class: &str| ClassKey::of_letters(class.chars());
        for class in ["LE", "LDSE", "LDDDDDDSDE"] {
            assert_eq!(key(class).to_string(), class);
        }
        assert_ne!(key("LDE"), key("LDDE"), "two classes have two keys");
        let long = format!("L{}SE", "D".repeat(60));
        assert_eq!(key(&long).to_string(), &long[long.len() - LETTERS..], "the lens end stays");
    }
}
