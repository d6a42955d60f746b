//! The throughput at a vertex as one byte.

/// Says that nothing is known of the throughput at a vertex.
pub const THROUGHPUT_UNKNOWN: u8 = 0;

/// Codes a stop.
const CODES_PER_STOP: f32 = 8.0;
/// The stop (log2) of code 1; what is darker has the same code.
const LOWEST: f32 = -28.0;

/// A throughput as a byte: eighths of a stop from 2^-28 to 2^3.75. What is not a number, or
/// negative, has no throughput that is known.
pub fn encode_throughput(throughput: f32) -> u8 {
    if !(throughput >= 0.0) {
        return THROUGHPUT_UNKNOWN;
    }
    let stops = throughput.max(f32::MIN_POSITIVE).log2();
    (1.0 + (stops - LOWEST) * CODES_PER_STOP).round().clamp(1.0, 255.0) as u8
}

/// The stops (log2 of the throughput) that a byte stands for, where they are known.
pub fn decode_throughput(code: u8) -> Option<f32> {
    (code != THROUGHPUT_UNKNOWN).then(|| (f32::from(code) - 1.0) / CODES_PER_STOP + LOWEST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_byte_is_off_by_a_sixteenth_of_a_stop_at_most() {
        for i in -160..=36 {
            let stops = i as f32 / 10.0;
            let read = decode_throughput(encode_throughput(stops.exp2())).expect("known");
            assert!((read - stops).abs() <= 1.0 / 16.0 + 1e-4, "{stops} became {read}");
        }
        assert_eq!(decode_throughput(encode_throughput(0.0)), Some(LOWEST), "black is darkest");
        assert_eq!(encode_throughput(f32::INFINITY), 255, "and no more than brightest");
        assert_eq!(decode_throughput(encode_throughput(f32::NAN)), None, "no number");
        assert_eq!(decode_throughput(encode_throughput(-1.0)), None, "no throughput");
    }
}
