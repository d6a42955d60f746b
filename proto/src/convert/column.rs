//! Columns: arrays of little-endian numbers without padding.

use prost::bytes::Bytes;

use super::WireError;

/// A number, or a fixed tuple of numbers, that columns are made of.
pub(super) trait Entry: Copy {
    /// Bytes of one entry.
    const SIZE: usize;

    /// Appends the entry.
    fn put(self, out: &mut Vec<u8>);

    /// Reads an entry from exactly `SIZE` bytes.
    fn get(bytes: &[u8]) -> Self;
}

macro_rules! number_entry {
    ($($number:ty),*) => {$(
        impl Entry for $number {
            const SIZE: usize = size_of::<Self>();

            fn put(self, out: &mut Vec<u8>) {
                out.extend_from_slice(&self.to_le_bytes());
            }

            fn get(bytes: &[u8]) -> Self {
                let mut number = [0; size_of::<Self>()];
                number.copy_from_slice(bytes);
                Self::from_le_bytes(number)
            }
        }
    )*};
}

number_entry!(u8, u16, i16, u32, u64, f32);

impl<T: Entry, const N: usize> Entry for [T; N] {
    const SIZE: usize = N * T::SIZE;

    fn put(self, out: &mut Vec<u8>) {
        for number in self {
            number.put(out);
        }
    }

    fn get(bytes: &[u8]) -> Self {
        std::array::from_fn(|i| T::get(&bytes[i * T::SIZE..(i + 1) * T::SIZE]))
    }
}

/// The column of `values`.
pub(super) fn encode<T: Entry>(values: &[T]) -> Bytes {
    let mut out = Vec::with_capacity(values.len() * T::SIZE);
    for &value in values {
        value.put(&mut out);
    }
    out.into()
}

/// The entries of a column that must hold `count` of them.
pub(super) fn decode<T: Entry>(
    column: &'static str,
    bytes: &[u8],
    count: usize,
) -> Result<Vec<T>, WireError> {
    let expected = count.saturating_mul(T::SIZE);
    if bytes.len() != expected {
        return Err(WireError::ColumnLength { column, found: bytes.len(), expected });
    }
    Ok(bytes.chunks_exact(T::SIZE).map(T::get).collect())
}
