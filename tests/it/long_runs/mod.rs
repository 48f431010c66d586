//! Runs that are interrupted, resumed and shared: the same bytes as undisturbed, or refused with the reason.
//!
//! `cargo test --release --test it long_runs -- --ignored --nocapture` makes the numbers of tries in `results/faults/`.

mod faults;
mod place;
#[cfg(unix)]
mod ranks;

use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use self::faults::{cuts, flips, kills, strangers, wrong_parts};
use self::place::{Place, said};
use trueflight::draw::block::{self, Drawn};
use trueflight::draw::run;
use trueflight::draw::share::{self, Share, Threads};
use trueflight::draw::store::{Header, Key, Log, Store, entry};
use trueflight::plan::Options;
use trueflight::plan::Plan;

use crate::common::{case, options};

/// Number of tries of each fault in a quick test.
const FEW: usize = 4;

#[test]
fn killed_and_spoilt_runs_end_as_undisturbed_ones() {
    let mut place = Place::new();
    kills(&mut place, FEW).hold();
    cuts(&mut place, FEW).hold();
    flips(&mut place, FEW).hold();
    strangers(&mut place).hold();
}

#[test]
fn a_file_of_many_blocks_stays_short() {
    let place = Place::new();
    let asked = "run ray.toml --draws 2e7 --fixed-draws --filter *:woodcock --quiet";
    let finished = place.say(&format!("{asked} --out whole"));
    assert!(finished.status.success(), "{}", said(&finished));
    // Of 1221 blocks of 9 kB each, only some are in the file at any time.
    let mut run = place.begin(&format!("{asked} --out long"));
    let (mut longest, mut kills) = (0, 0);
    loop {
        let length = fs::metadata(place.path("long/blocks.bin")).map_or(0, |file| file.len());
        let was_shortened = length < longest;
        longest = longest.max(length);
        // Killed each time the file was rewritten, and resumed from there.
        if was_shortened && kills < 3 && run.kill().is_ok() {
            run.wait().expect("it has ended");
            kills += 1;
            run = place.begin("run --resume long --quiet");
            longest = 0;
        }
        if run.try_wait().expect("a process").is_some() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    assert_eq!(kills, 3, "it was written anew less often");
    assert!(longest < 6 << 20, "{longest} bytes");
    let read = |folder: &str| fs::read_to_string(place.path(&format!("{folder}/checks.csv")));
    assert_eq!(read("long").expect("rows"), read("whole").expect("rows"));
}

#[test]
fn looks_after_many_blocks_are_drawn_in_any_order_and_judge_alike() {
    let place = Place::new();
    let asked = |more: &str| Place::asked(&format!("--blocks-per-look 4 {more}"));
    let run = place.say(&asked("--out four --threads 1"));
    assert!(run.status.success(), "{}", said(&run));
    for part in 1..=2 {
        let run = place.say(&asked(&format!("--shard {part}/2 --out four-{part}")));
        assert!(run.status.success(), "{}", said(&run));
    }
    let merged = place.say("merge four-2 four-1 --out merged");
    assert!(merged.status.success(), "{}", said(&merged));
    let read = |folder: &str| fs::read_to_string(place.path(&format!("{folder}/checks.csv")));
    assert_eq!(read("four").expect("rows"), read("merged").expect("rows"));
    let record = fs::read_to_string(place.path("four/record.json")).expect("a record");
    assert!(record.contains("--blocks-per-look 4"), "the command that repeats says so");
    let wrong = place.say(&asked("--out four-1 --shard 1/2 --blocks-per-look 0"));
    assert_eq!(wrong.status.code(), Some(2), "{}", said(&wrong));
}

#[test]
fn of_those_who_begin_at_once_one_writes() {
    let place = Place::new();
    for _ in 0..5 {
        let _ = fs::remove_dir_all(place.path("crowd"));
        let asked = "run ray.toml --draws 1e10 --fixed-draws --threads 1 --out crowd";
        let mut runs: Vec<std::process::Child> = (0..4).map(|_| place.begin(asked)).collect();
        let mut refused = 0;
        let begin = Instant::now();
        while refused < 3 && begin.elapsed().as_secs() < 60 {
            std::thread::sleep(std::time::Duration::from_millis(5));
            let status = |run: &mut std::process::Child| run.try_wait().expect("a process");
            refused = runs.iter_mut().filter_map(status).filter(|s| s.code() == Some(2)).count();
        }
        std::thread::sleep(std::time::Duration::from_millis(100));
        for run in &mut runs {
            let _ = run.kill();
        }
        let said: Vec<String> = runs
            .into_iter()
            .map(|run| said(&run.wait_with_output().expect("it has ended")))
            .filter(|said| said.contains("another run is writing into"))
            .collect();
        assert_eq!((refused, said.len()), (3, 3), "{said:?}");
    }
}

#[test]
fn parts_merge_to_the_run_of_one_machine_or_are_refused() {
    let mut place = Place::new();
    wrong_parts(&mut place, FEW).hold();
}

#[test]
#[ignore = "as many faults as the table has take ten minutes"]
fn the_table_of_faults() {
    let mut place = Place::new();
    println!("fault,tried,identical,refused");
    let tables = [
        ("killed at a random moment", kills(&mut place, 200)),
        ("journal cut at a random byte", cuts(&mut place, 50)),
        ("a random bit of a journal flipped", flips(&mut place, 50)),
        ("journal of something else", strangers(&mut place)),
        ("wrong parts", wrong_parts(&mut place, 20)),
    ];
    for (name, counts) in tables {
        println!("{name},{},{},{}", counts.tried(), counts.identical, counts.refused.len());
        counts.hold();
    }
}

/// Returns a log without blocks.
fn log(path: &Path, header: &Header) -> Log {
    Log::write(path, [entry(Key::Header, header)]).expect("a file");
    Log::resume(path, None).expect("a log")
}

#[test]
#[ignore = "a measurement"]
fn what_a_block_costs_those_who_draw_and_those_who_merge() {
    let cases = [case("ray", place::RAY), case("curve", place::CURVE)];
    let folder = tempfile::TempDir::new().expect("a folder");
    println!(
        "blocks as one, bytes of it, ms to draw it, µs to encode it, and to decode, keep and merge it"
    );
    for blocks_per_look in [1, 16, 256] {
        let plan =
            Plan::new(&cases, &Options { fixed: true, blocks_per_look, ..options(1, 10_000_000) });
        let header = Header::new(&plan, "program", &[], None);
        let log = log(&folder.path().join("blocks.bin"), &header);
        let [mut bytes, mut count, mut draw, mut encode, mut take] = [0.0; 5];
        let long = plan.experiments().filter(|(_, planned)| planned.horizon == 10_000_000);
        for (number, (_, planned)) in long.enumerate() {
            let mut drawn = Drawn::new(planned);
            for block in 0..(512 / blocks_per_look).min(64) {
                let begin = Instant::now();
                let one = block::merged(planned, block, blocks_per_look, &|| false);
                let one = one.expect("a block");
                draw += begin.elapsed().as_secs_f64();
                let begin = Instant::now();
                let message = postcard::to_stdvec(&one).expect("encoded");
                encode += begin.elapsed().as_secs_f64();
                let begin = Instant::now();
                let one: block::Block = postcard::from_bytes(&message).expect("decoded");
                log.put(Key::Block(number as u64, block), &one).expect("written");
                drawn.merge(planned, &one, block);
                take += begin.elapsed().as_secs_f64();
                (bytes, count) = (bytes + message.len() as f64, count + 1.0);
            }
        }
        let [bytes, draw, encode, take] = [bytes, draw * 1e3, encode * 1e6, take * 1e6];
        println!(
            "{blocks_per_look} {:.0} {:.3} {:.1} {:.1}",
            bytes / count,
            draw / count,
            encode / count,
            take / count
        );
        assert!(count > 0.0);
    }
}

#[test]
#[ignore = "a measurement"]
fn what_keeping_blocks_costs() {
    let cases = [case("ray", place::RAY), case("curve", place::CURVE)];
    let plan = Plan::new(&cases, &Options { fixed: true, ..options(1, 10_000_000) });
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("blocks.bin");
    println!("seconds without a file, with one");
    for _ in 0..3 {
        let begin = Instant::now();
        run::draw(&plan, &|_| {});
        let without = begin.elapsed().as_secs_f64();
        let begin = Instant::now();
        let header = Header::new(&plan, "program", &[], None);
        let log = log(&path, &header);
        let store = Store::journal(header, log, Box::new(Threads), Arc::default());
        run::draw_with(&plan, &store, &|_| {});
        let with = begin.elapsed().as_secs_f64();
        println!("{without:.2} {with:.2}");
        assert!(path.exists());
    }
}

#[cfg(unix)]
#[test]
fn the_first_interruption_ends_with_a_verdict_and_the_second_at_once() {
    let place = Place::new();
    let send = |signals: &[&str], id: u32| {
        let kills: Vec<String> =
            signals.iter().map(|signal| format!("kill -{signal} {id}")).collect();
        let sent = std::process::Command::new("sh").args(["-c", &kills.join(";")]).status();
        assert!(sent.expect("a shell").success());
    };
    let mut seen = false;
    // The run may end before it is interrupted.
    for _ in 0..20 {
        let _ = fs::remove_dir_all(place.path("stopped"));
        let asked = Place::asked("--out stopped --inconclusive pass");
        let Some(run) = place.drawing(&asked, "stopped") else { continue };
        send(&["INT"], run.id());
        let output = run.wait_with_output().expect("it ends");
        if place.path("stopped/blocks.bin").exists() && place.path("stopped/record.json").exists() {
            assert_eq!(output.status.code(), Some(3), "{}", said(&output));
            assert!(said(&output).contains("go") && said(&output).contains("--resume stopped"));
            let record = fs::read_to_string(place.path("stopped/record.json")).expect("a record");
            assert!(record.replace(' ', "").contains("\"cut_by_time\":true"), "it is said");
            seen = true;
            break;
        }
    }
    assert!(seen, "no run was interrupted while it was drawing");
    let output = place.say(&Place::asked("--out stopped"));
    assert!(output.status.code() == Some(2) && said(&output).contains("--resume stopped"));
    // A time limit ends a resumed run, and no draw is lost.
    let output = place.say("run --resume stopped --budget 0.02s --inconclusive pass");
    assert!(said(&output).contains("--resume stopped"), "{}", said(&output));
    assert!(output.status.code() == Some(3) && place.path("stopped/blocks.bin").exists());
    let output = place.say("report stopped");
    assert!(output.status.success() && said(&output).contains("is not finished"));
    assert_eq!(place.say("run --resume stopped").status.code(), Some(0));
    assert_eq!(place.difference("stopped"), None);
    let output = place.say("run --resume stopped");
    assert!(output.status.code() == Some(2) && said(&output).contains("nothing was interrupted"));
    // Two different signals, since two equal ones may be delivered once.
    let asked = "run ray.toml --draws 1e9 --fixed-draws --out endless";
    let run = place.drawing(asked, "endless").expect("it draws for minutes");
    send(&["INT", "TERM"], run.id());
    assert_eq!(run.wait_with_output().expect("it ends").status.code(), Some(130));
    assert!(place.path("endless/blocks.bin").exists());
    assert!(!place.path("endless/record.json").exists());
}

#[test]
fn shares_are_all_blocks_once() {
    let text = "title = \"t\"
        [problem.transmittance]
        medium.constant.extinction = 1
        span = [0, 2]
        sampling.constant.value = 1.5
        estimators = [{ woodcock = {} }, { ratio = {} }, { double = {} }, { next-flight = {} }]";
    let cases = [case("all", text)];
    let plan = Plan::new(&cases, &options(1, 300_000));
    let blocks = |share| -> Vec<(u32, u64)> { share::blocks(&plan, share).collect() };
    let mut all = blocks(Share::WHOLE);
    all.sort_unstable();
    for of in [2, 3, 16, 1000] {
        let parts = (1..=of).map(|part| blocks(Share { part, of }));
        let sizes: Vec<usize> = parts.clone().map(|blocks| blocks.len()).collect();
        let mut together: Vec<(u32, u64)> = parts.flatten().collect();
        together.sort_unstable();
        assert_eq!(together, all, "{of} shares");
        let (least, most) = (sizes.iter().min().expect("some"), sizes.iter().max().expect("some"));
        assert!(most - least <= 4, "{of} shares of {least} to {most} blocks");
    }
    for wrong in ["0/3", "4/3", "3", "a/b", "1/0", "-1/3"] {
        assert!(wrong.parse::<Share>().is_err(), "{wrong}");
    }
}

#[test]
fn a_run_of_1e12_draws_is_planned_and_shared_out() {
    let cases = [case("ray", place::RAY)];
    let plan = Plan::new(&cases, &options(1, 1_000_000_000_000));
    let blocks: u64 = {
        let all = plan.experiments().filter(|(_, planned)| planned.same_as.is_none());
        all.map(|(_, planned)| planned.horizon.div_ceil(1 << 14)).sum()
    };
    assert!(blocks > 400_000_000, "{blocks}");
    let share = Share { part: 7, of: 1_000_000 };
    let own = share::blocks(&plan, share).count() as u64;
    assert!(own.abs_diff(blocks / 1_000_000) <= 4, "{own} of {blocks}");
}

#[test]
fn every_mismatch_is_named() {
    let text = "title = \"t\"\n[problem.transmittance]\nmedium.constant.extinction = 1\nspan = [0, 2]\n\
                sampling.constant.value = 1.5\nestimators = [{ ratio = {} }]";
    let header = |text: &str, draws: u64| {
        let cases = [case("named", text)];
        let words = [format!("--draws={draws}")];
        Header::new(&Plan::new(&cases, &options(1, draws)), "program", &words, None)
    };
    let own = header(text, 50_000);
    assert_eq!(own.mismatch(&own), None);
    let others = [
        (Header { version: "0.0.1".into(), ..own.clone() }, "version 0.0.1"),
        (Header { program: "another".into(), ..own.clone() }, "build another"),
        (header(text, 60_000), "--draws=60000, not --draws=50000"),
        (header(&text.replace("= 1\n", "= 1.25\n"), 50_000), "another text"),
    ];
    for (other, word) in others {
        let why = other.mismatch(&own).expect("a mismatch");
        assert!(why.contains(word), "{why}");
    }
}

#[test]
fn the_array_of_tasks_is_in_the_manual() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |name: &str| fs::read_to_string(root.join(name)).expect("a file");
    let script = read("examples/slurm-array.sh");
    assert!(read("docs/long-runs.md").contains(&format!("```bash\n{script}```\n")));
}

#[cfg(unix)]
#[test]
fn the_array_of_tasks_draws_all_shares_and_goes_on_with_what_it_has() {
    let place = Place::new();
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let script = fs::read_to_string(root.join("examples/slurm-array.sh")).expect("the example");
    let asked = "run cases --draws 4e7 ";
    assert!(script.contains(asked), "the script draws something else");
    let script = script.replace(asked, &Place::asked(""));
    let program = std::path::Path::new(env!("CARGO_BIN_EXE_trueflight"));
    let task = |part: &str| {
        let mut bash = std::process::Command::new("bash");
        let folder = program.parent().expect("a folder").display();
        let path = format!("{folder}:{}", std::env::var("PATH").unwrap_or_default());
        let variables = [("TASK_ID", part), ("TASK_COUNT", "2")];
        bash.envs(variables.map(|(name, value)| (format!("SLURM_ARRAY_{name}"), value)));
        bash.env("SLURM_CPUS_PER_TASK", "1").env("PATH", path).current_dir(place.path(""));
        bash.args(["-c", &script]).output().expect("bash")
    };
    for (part, word) in [("1", "is drawn"), ("2", "is drawn"), ("1", "was drawn before")] {
        let output = task(part);
        assert!(output.status.success() && said(&output).contains(word), "{}", said(&output));
    }
    let merged = place.say("merge shares/part-1 shares/part-2 --out merged");
    assert!(merged.status.success(), "{}", said(&merged));
    assert_eq!(place.difference("merged"), None);
}
