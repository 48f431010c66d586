#!/usr/bin/env bash
# What kernels cost a build: seconds of LLVM and kB of code, family by family and level by level, as a table of Markdown.
#
# `benches/price.sh` compiles the crate of estimators once more, with LLVM's own clock, in a folder of its own: some minutes, and 2 GB
# for the trace. The seconds are those of passes over functions, without the making of machine code, and two threads of LLVM run
# beside each other: shares and ratios mean something. Takes python3, and nm and c++filt of binutils.
set -euo pipefail
cd "$(dirname "$0")/.."
target=${CARGO_TARGET_DIR:-target/price}
RUSTC_BOOTSTRAP=1 CARGO_INCREMENTAL=0 CARGO_TARGET_DIR=$target \
    cargo rustc --quiet --release -p trueflight-estimators --lib -- -Z llvm-time-trace -C symbol-mangling-version=v0
trace=$(ls -t "$target"/release/deps/trueflight_estimators-*.llvm_timings.json | head -1)
library=$(ls -t "$target"/release/deps/libtrueflight_estimators-*.rlib | head -1)
families=$(sed -n 's/^pub mod \(.*\);/\1/p' crates/estimators/src/lib.rs | tr '\n' ' ')
nm -S "$library" 2>/dev/null | python3 /dev/fd/3 "$trace" "$families" 3<<'PYTHON'
import json
import re
import subprocess
import sys
from collections import Counter

LEVELS = ["AVX-512", "AVX2", "one lane", "other"]
# Modules that all families use.
SHARED = {"walks", "draw", "trial", "setup", "space", "recipes", "traits", "own", "multiple_scattering", "chromatic"}
FAMILIES = set(sys.argv[2].split()) - SHARED


def family(name):
    """The first family that a function names."""
    modules = re.findall(r"trueflight_estimators(?:\[\w+\])?::(\w+)", name)
    return next((module for module in modules if module in FAMILIES), "shared")


def level(name):
    if "vectorize_avx512" in name or "avx512::Avx512>" in name:
        return "AVX-512"
    if "vectorize_avx2" in name or "avx2::Avx2>" in name:
        return "AVX2"
    return "one lane" if "::compiled" in name else "other"


seconds, sizes = Counter(), Counter()
for event in json.load(open(sys.argv[1]))["traceEvents"]:
    if event.get("ph") == "X" and event["name"] == "PassManager<Function>":
        seconds[event["args"].get("detail", "")] += event["dur"] / 1e6
for line in sys.stdin:
    match = re.match(r"[0-9a-f]+ ([0-9a-f]+) [tTwW] (\S+)", line)
    if match:
        sizes[match.group(2)] += int(match.group(1), 16) / 1e3
symbols = sorted(set(seconds) | set(sizes))
names = subprocess.run(["c++filt"], input="\n".join(symbols), capture_output=True, text=True, check=True).stdout.split("\n")
table = Counter()
for symbol, name in zip(symbols, names):
    place = (family(name), level(name))
    table[(*place, "s")] += seconds[symbol]
    table[(*place, "kB")] += sizes[symbol]
total = Counter()
for (name, _, unit), amount in table.items():
    if unit == "s":
        total[name] += amount
columns = [f"{one}, {unit}" for unit in ("s", "kB") for one in LEVELS]
print("| family | all, s | " + " | ".join(columns) + " |")
print("|---|" + "--:|" * (1 + len(columns)))
for name, amount in total.most_common():
    cells = [f"{table[name, one, 's']:.1f}" for one in LEVELS] + [f"{table[name, one, 'kB']:.0f}" for one in LEVELS]
    print(f"| {name} | {amount:.1f} | " + " | ".join(cells) + " |")
sums = [sum(table[name, one, unit] for name in total) for unit in ("s", "kB") for one in LEVELS]
print(f"| all | {sum(total.values()):.1f} | " + " | ".join(f"{x:.0f}" for x in sums) + " |")
PYTHON
