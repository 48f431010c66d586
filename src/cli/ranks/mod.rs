//! One run drawn by many processes, its ranks, that `mpirun` has begun.
//!
//! ```text
//! rank 0   plans, deals pieces to all ranks and to itself, keeps and merges what they give, looks, judges, writes
//! others   plan the same, and draw what they are dealt
//! ```
//!
//! Blocks are found by their addresses and merged in the order of these, so that results do not depend on the
//! number of ranks. Looks are decided on rank 0 only: what it deals next tells the others. MPI itself ends all ranks
//! where one dies; what rank 0 was given by then is in its file of blocks.

mod link;
mod team;

use anyhow::bail;
use serde::{Deserialize, Serialize};

use self::link::Link;
use self::team::Team;
use super::{Console, journal, mpirun, output, run};
use crate::baseline::fingerprint;
use crate::harness::draw::Block;
use crate::harness::share::{Header, Piece};
use crate::harness::workers::Drawing;
use crate::harness::{Catalogue, Plan};
use crate::numeric::parallel;

/// What rank 0 says to another.
#[derive(Debug, Serialize, Deserialize)]
enum Order {
    /// The words that ask for the run.
    Plan(Vec<String>),
    /// Pieces, each with its number among all that are dealt; so many of them are answered together.
    Draw { pieces: Vec<(usize, Piece)>, each: usize },
    /// Nothing more is to be drawn.
    End,
}

/// What another answers.
#[derive(Debug, Serialize, Deserialize)]
enum Answer {
    /// What it would draw, on so many threads; or why it cannot.
    Planned(Result<(Header, usize), String>),
    /// What it drew of pieces, each by its number.
    Drawn(Vec<(usize, Vec<Option<Block>>)>),
}

/// Draws what is asked for as a rank among others.
pub fn main(
    arguments: &run::Arguments,
    catalogue: &Catalogue,
    console: &Console,
) -> anyhow::Result<u8> {
    let (universe, link) = link::join()?;
    if link.size != mpirun::ranks() {
        bail!(
            "{} processes were begun, but MPI knows of {}: mpirun is not that of the MPI library of this build",
            mpirun::ranks(),
            link.size
        );
    }
    // As many as processors, like that of other codes under MPI, would be as many for each rank.
    let mut arguments = arguments.clone();
    arguments.selection.threads.get_or_insert(1);
    let done = if link.rank > 0 {
        Ok(serve(&link, &arguments, catalogue, console))
    } else {
        lead(Team::new(link), &arguments, catalogue, console)
    };
    // All ranks wait here for each other.
    drop(universe);
    done
}

/// Has all ranks draw what is asked for, and judges it.
fn lead(
    team: Team,
    arguments: &run::Arguments,
    catalogue: &Catalogue,
    console: &Console,
) -> anyhow::Result<u8> {
    let asked = arguments.resumed()?;
    if asked.shard.is_some() {
        bail!("a share is drawn by one process: leave out mpirun, or --shard");
    }
    if !console.quiet {
        // MPI ends rank 0 with any other, and leaves it no time to say so then.
        let (ranks, again) = (team.size(), journal::resume(&asked.out));
        output::note(&format!(
            "{ranks} ranks draw; should one of them die, {again} under mpirun goes on"
        ));
    }
    team.plan(&asked.words());
    run::draw(&asked, Box::new(team), catalogue, console)
}

/// Draws what rank 0 deals, to its end. What goes wrong is told to rank 0, which tells the user.
fn serve(link: &Link, arguments: &run::Arguments, catalogue: &Catalogue, console: &Console) -> u8 {
    let Order::Plan(words) = order(link) else { return 0 };
    let drawn = run::Arguments::of(&words).and_then(|asked| {
        let selection = asked.selection.clone().on_threads_of(&arguments.selection);
        let cases = selection.read(catalogue, console)?;
        selection.with_plan(&cases, &asked.options()?, |plan| {
            let header = Header::new(plan, &fingerprint()?, &words, None);
            draw(link, plan, header);
            Ok(())
        })
    });
    if let Err(error) = drawn {
        answer(link, &Answer::Planned(Err(format!("{error:#}"))));
        order(link);
    }
    0
}

fn draw(link: &Link, plan: &Plan, header: Header) {
    answer(link, &Answer::Planned(Ok((header, rayon::current_num_threads()))));
    let threads = rayon::current_num_threads();
    let is_over = || link.is_stopped();
    let drawing = Drawing::new(plan, &is_over);
    while let Order::Draw { pieces, each } = order(link) {
        let together: Vec<&[(usize, Piece)]> = pieces.chunks(each.max(1)).collect();
        parallel::map(&together, |pieces| {
            let drawn = pieces.iter().map(|(number, piece)| (*number, drawing.draw(piece)));
            let answer = encoded(&Answer::Drawn(drawn.collect()));
            // Two portions, with one answer of each thread, are all that rank 0 deals before it has heard.
            if !link.post(0, &answer, 2 * threads + 2) {
                link.send(0, &answer);
            }
        });
    }
}

/// The next order of rank 0.
fn order(link: &Link) -> Order {
    link.read(&link.wait())
}

fn answer(link: &Link, answer: &Answer) {
    link.send(0, &encoded(answer));
}

/// Never empty: every message can be encoded.
fn encoded(message: &impl Serialize) -> Vec<u8> {
    postcard::to_stdvec(message).unwrap_or_default()
}
