//! Portable float maps, `PF` in colour and `Pf` in grey.

use common::Rgb;
use host::picture::Picture;

/// The longest side in pixels.
const MAX_SIDE: usize = 16_384;

/// Reads a picture, whose rows a file has from the bottom up.
pub(super) fn read(bytes: &[u8]) -> Result<Picture, &'static str> {
    let mut rest = bytes;
    let mut word = || {
        let end = rest.iter().position(u8::is_ascii_whitespace)?;
        let (word, behind) = rest.split_at(end);
        rest = behind.get(1..)?;
        std::str::from_utf8(word).ok()
    };
    let channels = match word() {
        Some("PF") => 3,
        Some("Pf") => 1,
        _ => return Err("a float map begins with PF or Pf"),
    };
    let sides = [word(), word()].map(|word| word?.parse::<usize>().ok());
    let scale = word().map(str::parse::<f64>).transpose().ok().flatten();
    let ([Some(width @ 1..=MAX_SIDE), Some(height @ 1..=MAX_SIDE)], Some(scale)) = (sides, scale)
    else {
        return Err("a float map tells its width, its height and its order of bytes");
    };
    let number = if scale < 0.0 { f32::from_le_bytes } else { f32::from_be_bytes };
    let (quads, _) = rest.as_chunks();
    let numbers: Vec<f32> = quads.iter().map(|&quad| number(quad)).collect();
    if numbers.len() < channels * width * height {
        return Err("the float map ends before its last pixel");
    }
    let rows = numbers.chunks_exact(channels * width).take(height).rev();
    let pixel = |values: &[f32]| match *values {
        [r, g, b] => Rgb::from([r, g, b]),
        _ => Rgb::grey(values.first().copied().unwrap_or_default().into()),
    };
    let pixels = rows.flat_map(|row| row.chunks_exact(channels).map(pixel)).collect();
    Ok(Picture { width, height, pixels })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_come_from_the_bottom_up() {
        let numbers = |order: fn(f32) -> [u8; 4]| [1.0, 2.0, 3.0, 4.0].into_iter().flat_map(order);
        let mut little = b"Pf\n2 2\n-1\n".to_vec();
        little.extend(numbers(f32::to_le_bytes));
        let mut big = b"Pf 2 2 1.0\n".to_vec();
        big.extend(numbers(f32::to_be_bytes));
        for bytes in [&little, &big] {
            let picture = read(bytes).expect("a picture");
            let greys: Vec<f64> = picture.pixels.iter().map(|pixel| pixel.g).collect();
            assert_eq!((picture.width, picture.height, greys), (2, 2, vec![3.0, 4.0, 1.0, 2.0]));
        }
        for bad in [&b""[..], b"PF\n", b"Pf\n0 1\n-1\n", b"Pf\n9999999 1\n-1\n", &little[..20]] {
            assert!(read(bad).is_err(), "{bad:?}");
        }
    }
}
