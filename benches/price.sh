#!/usr/bin/env bash
# What kernels cost a build: seconds of LLVM and kB of code, family by family and level by level, as a table of Markdown.
#
# `benches/price.sh` compiles the crate of estimators once more, with LLVM's own clock, in a folder of its own: some minutes, and 2 GB
# for the trace. LLVM's threads run beside each other, so that only shares and ratios mean something. Takes python3, and nm of
# binutils.
set -euo pipefail
cd "$(dirname "$0")/.."
target=${CARGO_TARGET_DIR:-target/price}
RUSTC_BOOTSTRAP=1 CARGO_INCREMENTAL=0 CARGO_TARGET_DIR=$target \
    cargo rustc --quiet --release -p trueflight-estimators --lib -- -Z llvm-time-trace -C symbol-mangling-version=v0
trace=$(ls -t "$target"/release/deps/trueflight_estimators-*.llvm_timings.json | head -1)
library=$(ls -t "$target"/release/deps/libtrueflight_estimators-*.rlib | head -1)
nm -S "$library" 2>/dev/null | python3 -c '
import json, re, sys
from collections import Counter

FAMILY = re.compile(r"trueflight_estimators\d*(?:Nt|NvNt)?|(?<=21)trueflight_estimators")
LEVELS = ["avx512", "avx2", "one lane", "other"]


def family(symbol):
    """The module of the crate that a symbol of mangling v0 names first, beside those that all families use."""
    parts = [word for size, word in words(symbol)]
    shared = {"walks", "draw", "trial", "setup", "space", "recipes", "traits", "own"}
    for place, word in enumerate(parts):
        if word == "trueflight_estimators":
            inside = parts[place + 1 : place + 2]
            if inside and inside[0] not in shared:
                return inside[0]
    for word in parts:
        if word in FAMILIES:
            return word
    return "shared"


def words(symbol):
    """Identifiers of a symbol, in order."""
    place, found = 0, []
    for match in re.finditer(r"(?<![0-9a-zA-Z_])?(\d+)_?(?=[a-zA-Z_])", symbol):
        size, begin = int(match.group(1)), match.end()
        if match.start() < place or size < 2 or size > len(symbol) - begin:
            continue
        word = symbol[begin : begin + size]
        if re.fullmatch(r"[a-zA-Z_][a-zA-Z0-9_]*", word):
            found.append((size, word))
            place = begin + size
    return found


def level(symbol):
    if "vectorize_avx512" in symbol or "6Avx512" in symbol:
        return "avx512"
    if "vectorize_avx2" in symbol or "generated4avx2" in symbol:
        return "avx2"
    if "8compiled" in symbol:
        return "one lane"
    return "other"


FAMILIES = set(sys.argv[2].split())
seconds, sizes = Counter(), Counter()
for event in json.load(open(sys.argv[1]))["traceEvents"]:
    if event.get("ph") == "X" and event["name"] in ("PassManager<Function>", "OptFunction", "MachineFunctionPass"):
        if event["name"] == "OptFunction":
            continue
        symbol = event["args"].get("detail", "")
        seconds[family(symbol), level(symbol)] += event["dur"] / 1e6
for line in sys.stdin:
    match = re.match(r"[0-9a-f]+ ([0-9a-f]+) [tTwW] (\S+)", line)
    if match:
        symbol = match.group(2)
        sizes[family(symbol), level(symbol)] += int(match.group(1), 16) / 1e3
total = {name: sum(seconds[name, one] for one in LEVELS) for name, _ in set(seconds) | set(sizes)}
print("| family | " + " | ".join(f"{one}, s" for one in LEVELS) + " | sum, s | " + " | ".join(f"{one}, kB" for one in LEVELS) + " |")
print("|---|" + "--:|" * 9)
for name in sorted(total, key=total.get, reverse=True):
    cells = [f"{seconds[name, one]:.1f}" for one in LEVELS] + [f"{total[name]:.1f}"]
    cells += [f"{sizes[name, one]:.0f}" for one in LEVELS]
    print(f"| {name} | " + " | ".join(cells) + " |")
print(f"| all | " + " | ".join(f"{sum(seconds[n, one] for n in total):.1f}" for one in LEVELS) + f" | {sum(total.values()):.1f} | "
      + " | ".join(f"{sum(sizes[n, one] for n in total):.0f}" for one in LEVELS) + " |")
' "$trace" "$(sed -n 's/^pub mod \(.*\);/\1/p' crates/estimators/src/lib.rs | tr '\n' ' ')"
