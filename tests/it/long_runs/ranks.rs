//! Runs drawn by many ranks under `mpirun`: the same bytes as one process, and a rank that dies loses few draws.
//!
//! They need the program of `bindings/mpi`, and its path in `TRUEFLIGHT_MPI`: `.ci/mpi` builds it.

use std::fs;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use super::place::{Place, said};

/// Returns `mpirun` with a number of ranks in a folder; containers have few processors and one user.
fn mpirun(place: &Place, ranks: usize) -> Command {
    let mut command = Command::new("mpirun");
    command.current_dir(place.path("")).env("OMPI_ALLOW_RUN_AS_ROOT", "1");
    command
        .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
        .env("OMPI_MCA_rmaps_base_oversubscribe", "1");
    command.args(["-n", &ranks.to_string(), &program()]);
    command
}

fn program() -> String {
    std::env::var("TRUEFLIGHT_MPI").expect("the path of a program with MPI")
}

fn say(place: &Place, ranks: usize, arguments: &str) -> Output {
    mpirun(place, ranks).args(arguments.split_whitespace()).output().expect("mpirun")
}

/// Returns the processes that draw, by the folder that they write.
fn drawing(folder: &str) -> Vec<u32> {
    let mut list = Command::new("pgrep");
    list.args(["-f", &format!("^{} .*--out {folder}", program())]);
    let list = list.output().expect("pgrep").stdout;
    String::from_utf8(list).expect("numbers").lines().filter_map(|line| line.parse().ok()).collect()
}

#[test]
#[ignore = "needs mpirun and trueflight-mpi"]
fn any_number_of_ranks_makes_the_bytes_of_one_process() {
    let place = Place::with(&program());
    for ranks in 1..=4 {
        let folder = format!("ranks-{ranks}");
        let output = say(&place, ranks, &Place::asked(&format!("--out {folder}")));
        assert!(output.status.success(), "{ranks} ranks: {}", said(&output));
        assert_eq!(place.difference(&folder), None, "{ranks} ranks");
    }
    let output = say(&place, 2, &Place::asked("--out two-threads --threads 2"));
    assert!(output.status.success(), "{}", said(&output));
    assert_eq!(place.difference("two-threads"), None);
}

#[test]
#[ignore = "needs mpirun and trueflight-mpi"]
fn a_rank_that_dies_ends_the_run_which_can_be_gone_on_with() {
    let place = Place::with(&program());
    // Rank 0 draws, keeps and judges; the others only draw.
    for victim in [0, 2] {
        let folder = format!("dead-{victim}");
        let asked = "run ray.toml --draws 3e8 --fixed-draws";
        let mut run = mpirun(&place, 3);
        run.args(asked.split_whitespace()).args(["--out", &folder]);
        let run = run.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("mpirun");
        let blocks = place.path(&format!("{folder}/blocks.bin"));
        let begin = Instant::now();
        while fs::metadata(&blocks).map_or(0, |file| file.len()) < 300_000 {
            assert!(begin.elapsed() < Duration::from_secs(60), "nothing is drawn");
            std::thread::sleep(Duration::from_millis(5));
        }
        let mut ranks: Vec<u32> =
            drawing(&folder).into_iter().filter(|&id| id != run.id()).collect();
        ranks.sort_unstable();
        assert_eq!(ranks.len(), 3, "{ranks:?}");
        let killed = Command::new("kill").args(["-9", &ranks[victim].to_string()]).status();
        assert!(killed.expect("kill").success());
        let output = run.wait_with_output().expect("it ends");
        assert!(!output.status.success(), "{}", said(&output));
        let told = format!("trueflight-mpi run --resume {folder}` under mpirun");
        assert!(said(&output).contains(&told), "{}", said(&output));
        assert!(blocks.exists() && drawing(&folder).is_empty());
    }
    // A run that is small enough to be drawn to its end.
    let mut interrupted = false;
    for _ in 0..20 {
        let _ = fs::remove_dir_all(place.path("torn"));
        let mut run = mpirun(&place, 2);
        run.args(Place::asked("--out torn").split_whitespace());
        let mut run = run.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("mpirun");
        let blocks = place.path("torn/blocks.bin");
        while run.try_wait().expect("a process").is_none() {
            if fs::metadata(&blocks).is_ok_and(|file| file.len() > 100_000) {
                let ranks = drawing("torn").into_iter().filter(|&id| id != run.id()).max();
                let killed =
                    ranks.map(|id| Command::new("kill").args(["-9", &id.to_string()]).status());
                assert!(killed.is_none_or(|status| status.is_ok()));
                break;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        run.wait().expect("it ends");
        if blocks.exists() && !place.path("torn/draws.bin").exists() {
            interrupted = true;
            break;
        }
    }
    assert!(interrupted, "no rank died while it was drawing");
    let output = say(&place, 3, "run --resume torn");
    assert!(output.status.success(), "{}", said(&output));
    assert_eq!(place.difference("torn"), None);
}

#[test]
#[ignore = "needs mpirun and trueflight-mpi"]
fn ranks_that_would_draw_something_else_are_named() {
    let place = Place::with(&program());
    fs::create_dir(place.path("elsewhere")).expect("a folder");
    let curve = fs::read_to_string(place.path("curve.toml")).expect("a case");
    let ray = fs::read_to_string(place.path("ray.toml")).expect("a case");
    fs::write(place.path("elsewhere/curve.toml"), curve).expect("a case");
    fs::write(place.path("elsewhere/ray.toml"), ray.replace("1.5", "1.25")).expect("a case");
    let elsewhere = place.path("elsewhere");
    let refused = |more: &[&str], word: &str| {
        let asked = Place::asked("--out refused");
        let mut command = mpirun(&place, 1);
        command.args(asked.split_whitespace()).args([":", "-n", "1"]).args(more);
        let output = command.args([&program()]).args(asked.split_whitespace()).output();
        let output = output.expect("mpirun");
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        assert!(said(&output).contains(word), "{}", said(&output));
        assert!(!place.path("refused/record.json").exists());
    };
    let elsewhere = elsewhere.to_str().expect("text");
    refused(
        &["-wdir", elsewhere],
        "rank 1: would not draw the same: the case ray had another text",
    );
    fs::remove_file(place.path("elsewhere/ray.toml")).expect("a case");
    refused(&["-wdir", elsewhere], "rank 1: ");
    for (asked, word) in [
        ("run nowhere.toml --out refused", "nowhere.toml"),
        ("run ray.toml --shard 1/2 --out refused", "leave out mpirun"),
        ("plan ray.toml", "leave out mpirun"),
        ("run --resume nowhere", "nothing was interrupted there"),
    ] {
        let output = say(&place, 2, asked);
        assert_eq!(output.status.code(), Some(2), "{asked}: {}", said(&output));
        assert!(said(&output).contains(word), "{asked}: {}", said(&output));
    }
}

#[test]
#[ignore = "needs mpirun, trueflight-mpi and two quiet processors"]
fn how_two_ranks_scale() {
    let place = Place::with(&program());
    println!("seconds of one process, of two ranks, their ratio");
    let time = |ranks: usize, more: &str| {
        let begin = Instant::now();
        let asked = "run ray.toml --draws 1e8 --fixed-draws --threads 1 --fresh";
        let output = say(&place, ranks, &format!("{asked} --out scaled-{ranks} {more}"));
        assert!(output.status.success(), "{}", said(&output));
        begin.elapsed().as_secs_f64()
    };
    for more in ["", "--blocks-per-look 16"] {
        for _ in 0..3 {
            let (one, two) = (time(1, more), time(2, more));
            println!("{one:.2} {two:.2} {:.2} {more}", one / two);
        }
    }
}
