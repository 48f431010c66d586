#!/usr/bin/env bash
# What a newcomer waits for, of two revisions in turn, each from an empty target folder:
#
#   benches/build.sh OLD [NEW] [STAGE…]      NEW is HEAD; OLD and NEW are revisions of git
#
# Stages, in this order: gate build first suite test edit. Without any: gate build first suite. Only committed changes are timed.
#
#   gate    cargo build --release of the package trueflight-gate alone, cold: processor seconds, wall seconds
#   build   the same of the command, and seconds of each crate of the workspace
#   first   fresh clone to the end of the main job: wall seconds (crates.io is reached beforehand)
#   suite   the main job alone, one thread, three times in turn: least processor seconds
#   test    cargo test --release, cold: processor seconds, building and running
#   edit    a changed heading of a report, and a changed line of an estimator: processor seconds to the verdict of a test
#
# A line a figure: name, old, new, new over old. Processor seconds are user and system time of all processes; other work beside it
# makes them some per cent larger. Wall seconds need a quiet machine.
set -euo pipefail
cd "$(dirname "$0")/.."
[[ $# -ge 1 ]] || { sed -n 2,17p "$0"; exit 2; }
old=$1 new=HEAD
shift
if [[ $# -ge 1 && ! $1 =~ ^(build|gate|first|suite|test|edit)$ ]]; then
    new=$1
    shift
fi
stages=" ${*:-build gate first suite} "
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
# What a user's settings would change.
unset CARGO_TARGET_DIR RUSTFLAGS CARGO_INCREMENTAL RUSTC_WRAPPER
export CARGO_TERM_QUIET=true

# Compilers report their time by this wrapper: processor seconds, and the crate.
cat >"$place/rustc" <<'W'
#!/usr/bin/env bash
crate=-
for ((i = 1; i < $#; i++)); do [[ ${!i} != --crate-name ]] || { j=$((i + 1)) crate=${!j}; }; done
TIMEFORMAT="%U %S $crate"
{ time "$@" 2>&3; } 3>&2 2>>"$RUSTC_TIMES"
W
chmod +x "$place/rustc"

for side in old new; do
    git clone -q . "$place/$side"
    git -C "$place/$side" -c advice.detachedHead=false checkout -q "$(git rev-parse "${!side}")"
    (cd "$place/$side" && cargo fetch --locked)
done

# Runs a command in a side's clone; leaves its processor and wall seconds in `processor` and `wall`.
timed() {
    local side=$1
    shift
    local TIMEFORMAT='%U %S %R'
    { time (cd "$place/$side" && "$@" >"$place/output" 2>&1) || { tail -20 "$place/output" >&2; exit 1; }; } 2>"$place/times"
    read -r user system wall < <(tail -1 "$place/times")
    processor=$(awk "BEGIN { print $user + $system }")
}

figure() {
    awk -v name="$1" -v old="$2" -v new="$3" 'BEGIN { printf "%-44s %9.1f %9.1f %7.2f\n", name, old, new, new / old }'
}

# Processor and wall seconds of a command on both sides, each after its folder was emptied.
cold() {
    local name=$1 olds
    shift
    for side in old new; do
        rm -rf "$place/$side/target"
        : >"$place/$side.crates"
        RUSTC_WRAPPER=$place/rustc RUSTC_TIMES=$place/$side.crates timed "$side" "$@"
        [[ $side == new ]] || olds="$processor $wall"
    done
    read -r old_processor old_wall <<<"$olds"
    figure "$name, processor s" "$old_processor" "$processor"
    figure "$name, wall s" "$old_wall" "$wall"
}

# Processor seconds of each crate of the workspace, and of all others.
crates() {
    awk '
        { seconds[FILENAME, name = $3 ~ /^trueflight/ ? $3 : "all other crates"] += $1 + $2; names[name] }
        END { for (name in names) printf "%-44s %9.1f %9.1f\n", "  " name, seconds[ARGV[1], name], seconds[ARGV[2], name] }
    ' "$place/old.crates" "$place/new.crates" | sort
}

megabytes() {
    strip -o "$place/stripped" "$place/$1/target/release/trueflight"
    stat -c %s "$place/stripped" | awk '{ print $1 / 1e6 }'
}

printf '%-44s %9s %9s %7s\n' "$(git rev-parse --short "$old") against $(git rev-parse --short "$new")" old new ratio
[[ $stages != *' gate '* ]] || cold 'gate alone' cargo build --release --locked -p trueflight-gate
if [[ $stages == *' build '* ]]; then
    cold 'build' cargo build --release --locked
    crates
    figure 'binary, stripped, MB' "$(megabytes old)" "$(megabytes new)"
fi
[[ $stages != *' first '* ]] || cold 'clone to the end of the main job' cargo run --release --locked -- run --out "$place/results"
if [[ $stages == *' suite '* ]]; then
    for side in old new; do timed "$side" cargo build --release --locked; done
    for turn in 1 2 3; do
        for side in old new; do
            timed "$side" target/release/trueflight run --threads 1 --seed 1 --out "$place/results"
            echo "$processor" >>"$place/$side.suite"
        done
    done
    figure 'suite, one thread, least processor s' "$(sort -g "$place/old.suite" | head -1)" "$(sort -g "$place/new.suite" | head -1)"
fi
[[ $stages != *' test '* ]] || cold 'cargo test' cargo test --release --locked
if [[ $stages == *' edit '* ]]; then
    # The developer's profile of a side, which the second figure of `cold` would not show: built once, edited, tested.
    edit() {
        local name=$1 file=$2 change=$3 topic=$4 olds
        for side in old new; do
            timed "$side" cargo test --locked --profile test-fast --test it "$topic"
            sed -i "$change" "$place/$side/$file"
            timed "$side" cargo test --locked --profile test-fast --test it "$topic"
            git -C "$place/$side" checkout -q .
            [[ $side == new ]] || olds=$processor
        done
        figure "$name" "$olds" "$processor"
    }
    edit 'edit of a report column to verdict, s' src/report/run/fields.rs \
        's/|line| line.standard_error;/|line| Option::from(line.standard_error);/' golden::consoles
    edit 'edit of an estimator to verdict, s' crates/estimators/src/free_flight/woodcock.rs \
        's/!met.number.below(met.ratio())/met.ratio().at_most(met.number)/' media_laws::
fi
