//! Numbers for people.

/// The value to six significant digits, without zeros at the end: what any machine agrees on.
pub fn number(value: f64) -> String {
    const DIGITS: i32 = 6;
    let size = value.abs();
    if size == 0.0 || !size.is_finite() {
        return value.abs().to_string();
    }
    let leading = size.log10().floor() as i32;
    if !(-4..=9).contains(&leading) {
        return format!("{value:.5e}");
    }
    let decimals = (DIGITS - 1 - leading).clamp(0, 9) as usize;
    let text = format!("{value:.decimals$}");
    let short =
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    short.replace('-', "−")
}

/// Several values; of many of them the first three and the last.
pub fn numbers(values: &[f64]) -> String {
    const MOST: usize = 5;
    let texts: Vec<String> = values.iter().map(|&value| number(value)).collect();
    match &texts[..] {
        [first, second, third, .., last] if texts.len() > MOST => {
            format!("{first}, {second}, {third}, …, {last}")
        }
        all => all.join(", "),
    }
}
