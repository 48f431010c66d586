"""Collects the licences of what is linked into the command, the C library and the Python module.

usage: licences.py TARGET FOLDER

Writes `third-party.txt` (crates of other authors, the font of plots, the unwinder of the linker) and
`rust-standard-library.html`, as Rust comes with it. Ends with an error for a crate without a licence.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

LINKED = ["trueflight", "trueflight-c", "trueflight-python"]
LICENCE = re.compile(r"^(un)?licen[cs]e|^copying|^copyright|^notice", re.IGNORECASE)


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def linked(target):
    """Returns the names and versions of all crates that are compiled into an artefact, without procedural macros."""
    chosen = [word for name in LINKED for word in ("-p", name)]
    tree = run("cargo", "tree", "--locked", "--target", target, "-e", "normal,no-proc-macro", "--prefix", "none", *chosen)
    return {tuple(line.replace(" v", " ").split()[:2]) for line in tree.splitlines() if line.strip()}


def texts(package):
    """Returns the licence texts of a crate: where there is a choice, MIT's alone, beside notices."""
    folder = Path(package["manifest_path"]).parent
    named = {folder / package["license_file"]} if package["license_file"] else set()
    found = sorted(named | {path for path in folder.iterdir() if path.is_file() and LICENCE.search(path.name)})
    choices = re.split(r"/|\bOR\b", package["license"] or "")
    if len(choices) > 1 and "MIT" in (choice.strip() for choice in choices):
        of_mit = [path for path in found if "mit" in path.name.lower()]
        notices = [path for path in found if re.match("notice|copyright", path.name, re.IGNORECASE)]
        found = of_mit + notices if of_mit else found
    return [path.read_text(encoding="utf-8", errors="replace").strip() for path in found]


def main(target, folder):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    packages = json.loads(run("cargo", "metadata", "--locked", "--format-version", "1", "--filter-platform", target))["packages"]
    wanted, by_text, bare = linked(target), {}, []
    for package in sorted(packages, key=lambda package: package["name"]):
        if (package["name"], package["version"]) not in wanted or package["source"] is None:
            continue
        name = f"{package['name']} {package['version']} ({package['license']})"
        if not package["license"]:
            sys.exit(f"error: {name} names no licence")
        own = texts(package)
        for text in own:
            by_text.setdefault(text, []).append(name)
        if not own:
            bare.append(f"{name}, by {', '.join(package['authors']) or 'its authors'}")
    rust = Path(run("rustc", "--print", "sysroot").strip())
    unwinder = Path(run(sys.executable, "-c", "import ziglang; print(ziglang.__path__[0])").strip()) / "lib/libunwind/LICENSE.TXT"
    for name, path in [("DejaVu Sans", Path("crates/drawing/src/dejavu-sans.LICENSE.txt")), ("LLVM libunwind", unwinder)]:
        by_text.setdefault(path.read_text(encoding="utf-8").strip(), []).append(name)
    rule = "=" * 100
    parts = [f"{rule}\n" + "\n".join(names) + f"\n{rule}\n\n{text}\n" for text, names in by_text.items()]
    head = "Trueflight is licensed under MIT or Apache-2.0. Linked into it are works of others, under these licences.\n"
    if bare:
        head += "\nWithout a text of their own, under the licence that stands beside their names:\n" + "".join(f"  {line}\n" for line in bare)
    (folder / "third-party.txt").write_text("\n".join([head, *parts]), encoding="utf-8")
    standard = (rust / "share/doc/rust/COPYRIGHT-library.html").read_bytes()
    (folder / "rust-standard-library.html").write_bytes(standard)
    crates = len({name for names in by_text.values() for name in names}) - 2 + len(bare)
    print(f"licences of {crates} crates, of the font, the unwinder and Rust's standard library; {len(bare)} crates without a text")


if __name__ == "__main__":
    main(*sys.argv[1:])
