//! Advance widths of the figures' font, for layout without the font at hand.

/// The advance of `c` in Libertinus Serif (regular or italic) in units of the font size. Wide
/// guesses for characters that the labels of this program do not use.
pub(super) fn advance(c: char, italic: bool) -> f64 {
    let table = if italic { &ITALIC } else { &REGULAR };
    let ascii = (c as usize).checked_sub(' ' as usize).and_then(|i| table.get(i));
    let thousandths = match (ascii, c) {
        (Some(&width), _) => width,
        (None, '×' | '±' | '−' | '≈' | '≤' | '≥' | '–') => 550,
        (None, '·') => 250,
        (None, 'α'..='ω') => 630,
        (None, 'Α'..='Ω') => 840,
        (None, '\u{c0}'..='\u{2af}' | '\u{370}'..='\u{52f}' | '∞' | '…' | '—') => 790,
        // U+2000 to U+206F: spaces and general punctuation.
        (None, '\u{a0}'..='\u{bf}' | '\u{2000}'..='\u{206f}' | '√') => 565,
        (None, _) => 1130,
    };
    f64::from(thousandths) / 1000.0
}

/// Libertinus Serif Regular 7.051, U+0020 to U+007E, in thousandths of the font size.
const REGULAR: [u16; 95] = [
    250, 288, 336, 465, 465, 637, 705, 190, 298, 298, 369, 550, 220, 338, 220,
    323, // space to /
    465, 465, 465, 465, 465, 465, 465, 465, 465, 465, 236, 236, 550, 550, 550, 435, // 0 to ?
    895, 695, 588, 646, 701, 557, 485, 685, 730, 297, 322, 637, 528, 839, 699, 702, // @ to O
    541, 702, 587, 485, 597, 661, 652, 951, 660, 575, 604, 356, 287, 356, 518, 486, // P to _
    392, 457, 493, 428, 506, 447, 310, 500, 538, 271, 272, 512, 264, 790, 542, 504, // ` to o
    519, 503, 372, 390, 316, 531, 497, 747, 490, 515, 424, 277, 205, 277, 449, // p to ~
];

/// The same for Libertinus Serif Italic 7.051.
const ITALIC: [u16; 95] = [
    250, 227, 336, 438, 438, 637, 705, 190, 306, 313, 433, 527, 219, 333, 219,
    291, // space to /
    444, 444, 444, 444, 445, 444, 444, 444, 444, 444, 219, 219, 487, 527, 487, 405, // 0 to ?
    829, 667, 557, 616, 667, 526, 457, 664, 673, 280, 414, 637, 519, 804, 666, 668, // @ to O
    499, 668, 555, 454, 544, 634, 597, 909, 628, 552, 578, 334, 321, 334, 518, 486, // P to _
    392, 486, 478, 389, 489, 401, 314, 477, 519, 276, 259, 486, 266, 783, 518, 447, // ` to o
    489, 491, 357, 353, 307, 521, 472, 688, 475, 503, 436, 273, 205, 273, 449, // p to ~
];
