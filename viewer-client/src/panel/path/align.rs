//! Numbers below each other, in a font whose letters are all as wide.

/// A number with this many decimals; anything that rounds to zero has no sign.
pub(super) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(size) if size.chars().all(|c| matches!(c, '0' | '.')) => size.to_owned(),
        _ => text,
    }
}

/// Sets blanks before numbers, so that their decimal points stand below each other.
pub(super) fn aligned(texts: &[String]) -> Vec<String> {
    let whole = |text: &str| text.find(['.', 'e']).map_or(text, |end| &text[..end]).chars().count();
    let widest = texts.iter().map(|text| whole(text)).max().unwrap_or(0);
    let padded = |text: &String| format!("{:width$}{text}", "", width = widest - whole(text));
    texts.iter().map(padded).collect()
}

/// Triples below each other, coordinate by coordinate.
pub(super) fn triples(rows: &[[f64; 3]], decimals: usize) -> Vec<String> {
    let [x, y, z] = [0, 1, 2].map(|axis| {
        let column: Vec<String> = rows.iter().map(|row| fixed(row[axis], decimals)).collect();
        aligned(&column)
    });
    let rows = x.iter().zip(&y).zip(&z);
    rows.map(|((x, y), z)| format!("{x}  {y}  {z}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_and_points_stand_below_each_other() {
        let texts = ["5138", "0.0196", "–", "12.35", "5.013e-4"].map(str::to_owned);
        let expected = ["5138", "   0.0196", "   –", "  12.35", "   5.013e-4"];
        assert_eq!(aligned(&texts), expected, "points");
        let rows = triples(&[[-0.719, 1.9, -0.0001], [12.0, 0.857, -71.0]], 3);
        assert_eq!(rows, ["-0.719  1.900    0.000", "12.000  0.857  -71.000"], "signs");
    }
}
