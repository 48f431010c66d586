//! Verdicts on draws, as they are printed.

use super::{Arguments, Judged, Shown, worst};
use crate::cli::{Console, output};
use crate::report::judge as report;

impl Arguments {
    /// Prints one verdict by itself, several with what they come to.
    pub(super) fn show(&self, judged: &[Judged], console: &Console) -> anyhow::Result<()> {
        match self.format {
            Shown::Table if console.quiet || judged.is_empty() => Ok(()),
            Shown::Table => {
                let width = output::pen(console).width;
                let blocks: Vec<String> = judged
                    .iter()
                    .map(|found| report::block(&found.judgement, &found.name(), width))
                    .collect();
                output::print(&(blocks.join("\n") + &self.together(judged)))
            }
            Shown::Json if judged.is_empty() => Ok(()),
            Shown::Json => output::print(&(self.json(judged)? + "\n")),
        }
    }

    /// The channels of each file.
    fn by_file(judged: &[Judged]) -> Vec<&[Judged]> {
        judged
            .chunk_by(|a, b| a.file == b.file && !b.channel.is_empty() && a.channel != b.channel)
            .collect()
    }

    /// Summary of several verdicts.
    fn together(&self, judged: &[Judged]) -> String {
        let verdicts = judged.iter().map(|found| &found.judgement);
        let files = Self::by_file(judged);
        let of = match (&files[..], self.files.len()) {
            ([[_]], 1) => return String::new(),
            ([channels], 1) => {
                let names: Vec<&str> = channels.iter().map(|found| &*found.channel).collect();
                format!(
                    "of {} channels of {} ({})",
                    names.len(),
                    channels[0].file,
                    names.join(", ")
                )
            }
            _ if judged.len() == files.len() => format!("of {} files", judged.len()),
            _ => format!("of {} channels of {} files", judged.len(), files.len()),
        };
        report::together(&verdicts, &of, worst(&verdicts), self.alpha)
    }

    /// All of it as JSON has it.
    fn json(&self, judged: &[Judged]) -> serde_json::Result<String> {
        match (judged, self.files.len()) {
            ([one], 1) if one.channel.is_empty() => serde_json::to_string_pretty(&one.judgement),
            _ => serde_json::to_string_pretty(&self.object(judged)),
        }
    }

    fn object(&self, judged: &[Judged]) -> serde_json::Value {
        let of_file = |channels: &[Judged]| match channels {
            [one] if one.channel.is_empty() => serde_json::json!({ "judgement": one.judgement }),
            _ => {
                let verdict = worst(&channels.iter().map(|found| &found.judgement));
                let channels = channels.iter().map(|found| {
                    serde_json::json!({ "channel": found.channel, "judgement": found.judgement })
                });
                let channels: Vec<serde_json::Value> = channels.collect();
                serde_json::json!({ "verdict": verdict, "channels": channels })
            }
        };
        let files = Self::by_file(judged);
        if let ([channels], 1) = (&files[..], self.files.len()) {
            return with(of_file(channels), "alpha", serde_json::json!(self.alpha));
        }
        let files: Vec<serde_json::Value> = files
            .into_iter()
            .map(|channels| with(of_file(channels), "file", serde_json::json!(channels[0].file)))
            .collect();
        let verdict = worst(&judged.iter().map(|found| &found.judgement));
        serde_json::json!({ "verdict": verdict, "alpha": self.alpha, "files": files })
    }
}

/// The object with one entry more.
fn with(mut object: serde_json::Value, key: &str, value: serde_json::Value) -> serde_json::Value {
    object[key] = value;
    object
}
