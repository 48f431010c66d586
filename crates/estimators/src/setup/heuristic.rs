//! The setting `heuristic` of estimators that combine techniques.
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `heuristic` | `"balance"` or `"power"` | `"balance"` |

use media::catalogue::Settings;
use theory::light::Heuristic;

/// Reads `heuristic`.
pub fn read(settings: &Settings) -> Option<Heuristic> {
    let word = settings.word_or("heuristic", &["balance", "power"], "balance")?;
    Some(if word == "power" { Heuristic::Power } else { Heuristic::Balance })
}
