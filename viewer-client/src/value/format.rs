//! Numbers as people read them.

/// A count with at most four digits and a unit: `950`, `12.3 k`, `4.57 M`.
pub fn count(value: f64) -> String {
    if !value.is_finite() {
        return "?".to_owned();
    }
    for (unit, suffix) in [(1e12, "T"), (1e9, "G"), (1e6, "M"), (1e3, "k")] {
        // 999.95 would be rounded to 1000.
        if value.abs() >= 0.99995 * unit {
            return format!("{} {suffix}", digits(value / unit));
        }
    }
    if value.fract() == 0.0 { format!("{value:.0}") } else { digits(value) }
}

/// Three significant digits.
fn digits(value: f64) -> String {
    match value.abs() {
        v if v >= 99.95 => format!("{value:.0}"),
        v if v >= 9.995 => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    }
}

/// A measured value in few letters: `0.25`, `12`, `5.0e-4`.
pub fn value(value: f32) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        v if (0.01..10_000.0).contains(&v) => {
            let text = format!("{value:.3}");
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        }
        _ => format!("{value:.1e}"),
    }
}

/// A measured value with four significant digits: `0.2500`, `12.35`, `5.013e-4`.
pub fn exact(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    if !(0.01..9999.5).contains(&size) {
        return format!("{value:.3e}");
    }
    let before = if size < 1.0 { 0 } else { 1 + size.log10().floor() as usize };
    format!("{value:.*}", 4_usize.saturating_sub(before))
}

/// Bytes in binary units: `512 B`, `1.50 KiB`, `12.0 MiB`.
pub fn bytes(value: u64) -> String {
    let value = value as f64;
    for (power, suffix) in [(30, "GiB"), (20, "MiB"), (10, "KiB")] {
        let unit = f64::from(1_u32 << power);
        if value >= unit {
            return format!("{} {suffix}", digits(value / unit));
        }
    }
    format!("{value:.0} B")
}

/// A share in percent, or a dash where there is nothing to share.
pub fn percent(part: f64, whole: f64) -> String {
    if whole > 0.0 { format!("{:.1} %", 100.0 * part / whole) } else { "–".to_owned() }
}

/// A message with a capital, as it stands alone: errors begin without one, to be joined.
pub fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(char::to_uppercase);
    first.into_iter().flatten().chain(letters).collect()
}

/// A number of steps: `1 step`, `12.3 k steps`.
pub fn steps(number: u64) -> String {
    if number == 1 { "1 step".to_owned() } else { format!("{} steps", count(number as f64)) }
}

/// A time span: `42 s`, `3:07 min`, `2:05 h`.
pub fn duration(seconds: f64) -> String {
    let whole = seconds.max(0.0) as u64;
    match whole {
        0..60 => format!("{whole} s"),
        60..3600 => format!("{}:{:02} min", whole / 60, whole % 60),
        _ => format!("{}:{:02} h", whole / 3600, whole / 60 % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        let cases = [
            (0.0, "0"),
            (7.0, "7"),
            (0.1234, "0.12"),
            (999.0, "999"),
            (1000.0, "1.00 k"),
            (12_345.0, "12.3 k"),
            (999_960.0, "1.00 M"),
            (4_567_890.0, "4.57 M"),
            (1.5e9, "1.50 G"),
            (f64::NAN, "?"),
        ];
        for (value, text) in cases {
            assert_eq!(count(value), text, "{value}");
        }
        for (number, text) in
            [(0.0, "0"), (0.25, "0.25"), (100.0, "100"), (5e-4, "5.0e-4"), (1e6, "1.0e6")]
        {
            assert_eq!(value(number), text, "{number}");
        }
        for (number, text) in [
            (0.0, "0"),
            (0.25, "0.2500"),
            (1.0, "1.000"),
            (12.345, "12.35"),
            (9876.4, "9876"),
            (5.0128e-4, "5.013e-4"),
            (123_456.0, "1.235e5"),
        ] {
            assert_eq!(exact(number), text, "{number}");
        }
        assert_eq!(bytes(1023), "1023 B", "bytes");
        assert_eq!(bytes(1536), "1.50 KiB", "kibibytes");
        assert_eq!(bytes(300 << 20), "300 MiB", "mebibytes");
        assert_eq!(percent(1.0, 3.0), "33.3 %", "a share");
        assert_eq!(percent(1.0, 0.0), "–", "no whole");
        assert_eq!(duration(59.9), "59 s", "seconds");
        assert_eq!(duration(187.0), "3:07 min", "minutes");
        assert_eq!(duration(7500.0), "2:05 h", "hours");
    }
}
