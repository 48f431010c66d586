//! First steps of a newcomer: examples that pass, commands that decide, failures with their likely causes, progress.

mod causes;
mod console;
mod decides;
mod examples;
mod tutorials;

/// Returns the commands behind a word in a text, without the program's name.
fn commands(text: &str, word: &str) -> Vec<String> {
    let after = text.lines().filter_map(|line| line.split_once(word)).map(|(_, command)| command);
    let own = after.filter_map(|command| command.trim().strip_prefix("trueflight "));
    own.map(str::to_owned).collect()
}
