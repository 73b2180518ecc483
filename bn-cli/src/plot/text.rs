//! Labels with italics, subscripts and superscripts.

use std::fmt::Write as _;

use super::text_width::advance;

/// How far a run stands off the baseline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Level {
    Base,
    Subscript,
    Superscript,
}

impl Level {
    /// Downward shift and size in units of the font size.
    fn shift_and_scale(self) -> (f64, f64) {
        match self {
            Self::Base => (0.0, 1.0),
            Self::Subscript => (0.18, 0.7),
            Self::Superscript => (-0.36, 0.7),
        }
    }
}

/// A stretch of characters in one style.
#[derive(Clone, Debug, PartialEq)]
struct Run {
    text: String,
    italic: bool,
    level: Level,
}

/// One line of text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Text {
    runs: Vec<Run>,
}

impl Text {
    /// The characters as they are: for file names and whatever else a user typed. What XML cannot
    /// hold becomes U+FFFD, other control characters a space.
    pub fn plain(text: &str) -> Self {
        let mut made = Self::default();
        text.chars().for_each(|c| made.push(c, false, Level::Base));
        made
    }

    /// Markup for labels written in the program: `*…*` is italic, `_{…}` a subscript, `^{…}` a
    /// superscript; anything else stands for itself. What is left open ends with the text.
    pub fn math(markup: &str) -> Self {
        let mut made = Self::default();
        let (mut italic, mut level) = (false, Level::Base);
        let mut chars = markup.chars().peekable();
        while let Some(c) = chars.next() {
            match (c, chars.peek()) {
                ('*', _) => italic = !italic,
                ('_', Some('{')) => (level, _) = (Level::Subscript, chars.next()),
                ('^', Some('{')) => (level, _) = (Level::Superscript, chars.next()),
                ('}', _) if level != Level::Base => level = Level::Base,
                _ => made.push(c, italic, level),
            }
        }
        made
    }

    /// Two texts as one line.
    #[must_use]
    pub fn followed_by(mut self, other: Self) -> Self {
        for run in other.runs {
            run.text.chars().for_each(|c| self.push(c, run.italic, run.level));
        }
        self
    }

    /// Whether there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        self.runs.is_empty()
    }

    /// The characters without their style.
    pub fn characters(&self) -> String {
        self.runs.iter().map(|run| run.text.as_str()).collect()
    }

    /// Width at font size `size`: the sum of the advances of Libertinus Serif without kerning and
    /// ligatures, which only make it narrower; an estimate for characters off the built-in table.
    pub fn width(&self, size: f64) -> f64 {
        let run_width = |run: &Run| {
            let (_, scale) = run.level.shift_and_scale();
            scale * run.text.chars().map(|c| advance(c, run.italic)).sum::<f64>()
        };
        size * self.runs.iter().map(run_width).sum::<f64>()
    }

    /// The text, cut and ended with … if it is wider than `width`.
    #[must_use]
    pub fn shortened(self, size: f64, width: f64) -> Self {
        if self.width(size) <= width {
            return self;
        }
        let room = width / size - advance('…', false);
        let mut made = Self::default();
        let mut used = 0.0;
        for (c, run) in self.styled_characters() {
            used += run.level.shift_and_scale().1 * advance(c, run.italic);
            if used > room {
                break;
            }
            made.push(c, run.italic, run.level);
        }
        made.push('…', false, Level::Base);
        made
    }

    /// The text broken at spaces into lines at most `width` wide (a longer word stays whole).
    pub fn wrapped(&self, size: f64, width: f64) -> Vec<Self> {
        let mut lines = vec![];
        let mut line = Self::default();
        for word in self.words() {
            let longer = if line.is_empty() {
                word.clone()
            } else {
                line.clone().followed_by(Self::plain(" ")).followed_by(word.clone())
            };
            if longer.width(size) <= width || line.is_empty() {
                line = longer;
            } else {
                lines.push(std::mem::replace(&mut line, word));
            }
        }
        if !line.is_empty() {
            lines.push(line);
        }
        lines
    }

    /// The content of an SVG text element at font size `size`.
    pub(super) fn to_tspans(&self, size: f64) -> String {
        let mut xml = String::new();
        let mut height = 0.0;
        for run in &self.runs {
            let (shift, scale) = run.level.shift_and_scale();
            let mut attributes = String::new();
            if shift != height {
                // Writing to a string cannot fail.
                let _ = write!(attributes, " dy=\"{:.2}\"", (shift - height) * size);
                height = shift;
            }
            if scale != 1.0 {
                let _ = write!(attributes, " font-size=\"{:.2}\"", scale * size);
            }
            if run.italic {
                attributes.push_str(" font-style=\"italic\"");
            }
            let content = escape(&run.text);
            if attributes.is_empty() {
                xml.push_str(&content);
            } else {
                let _ = write!(xml, "<tspan{attributes}>{content}</tspan>");
            }
        }
        xml
    }

    fn push(&mut self, c: char, italic: bool, level: Level) {
        let c = printable(c);
        match self.runs.last_mut() {
            Some(run) if run.italic == italic && run.level == level => run.text.push(c),
            _ => self.runs.push(Run { text: c.to_string(), italic, level }),
        }
    }

    fn styled_characters(&self) -> impl Iterator<Item = (char, &Run)> {
        self.runs.iter().flat_map(|run| run.text.chars().map(move |c| (c, run)))
    }

    fn words(&self) -> Vec<Self> {
        let mut words = vec![Self::default()];
        for (c, run) in self.styled_characters() {
            if c == ' ' {
                words.push(Self::default());
            } else if let Some(word) = words.last_mut() {
                word.push(c, run.italic, run.level);
            }
        }
        words.retain(|word| !word.is_empty());
        words
    }
}

/// The character, or a stand-in for what an XML document or a line of text cannot hold.
fn printable(c: char) -> char {
    match c {
        '\u{fffe}' | '\u{ffff}' => '\u{fffd}',
        c if c.is_control() => ' ',
        c => c,
    }
}

/// `text` as XML character data or attribute value.
pub(crate) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\n' => escaped.push(c),
            c => escaped.push(printable(c)),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_makes_runs() {
        let text = Text::math("*ν*_{eff}/√*n* = 10^{−3}");
        assert_eq!(text.characters(), "νeff/√n = 10−3");
        assert_eq!(text.runs.iter().filter(|r| r.italic).count(), 2);
        let xml = text.to_tspans(10.0);
        assert!(xml.contains("<tspan dy=\"1.80\" font-size=\"7.00\">eff</tspan>"), "{xml}");
        assert!(xml.contains("<tspan dy=\"-3.60\" font-size=\"7.00\">−3</tspan>"), "{xml}");
    }

    #[test]
    fn unfinished_markup_and_literals_survive() {
        assert_eq!(Text::math("a_{b").characters(), "ab");
        assert_eq!(Text::math("a_b ^c }").characters(), "a_b ^c }");
        assert_eq!(Text::math("*").characters(), "");
        assert_eq!(Text::plain("fpo_{1}*.txt").characters(), "fpo_{1}*.txt");
    }

    #[test]
    fn escapes_what_xml_reserves_or_forbids() {
        assert_eq!(
            Text::plain("<&\">\u{0}\u{ffff}").to_tspans(8.0),
            "&lt;&amp;&quot;&gt; \u{fffd}"
        );
    }

    #[test]
    fn fits_into_a_width() {
        let long = Text::plain(&"wide words ".repeat(50));
        let cut = long.clone().shortened(9.0, 100.0);
        assert!(cut.width(9.0) <= 100.0 && cut.width(9.0) > 80.0);
        assert!(cut.characters().ends_with('…'));
        let lines = long.wrapped(9.0, 100.0);
        assert!(lines.len() > 10 && lines.iter().all(|line| line.width(9.0) <= 100.0));
        let joined: Vec<String> = lines.iter().map(Text::characters).collect();
        assert_eq!(joined.join(" "), long.characters().trim_end());
        assert_eq!(Text::plain("unbreakable").wrapped(9.0, 3.0).len(), 1);
    }
}
