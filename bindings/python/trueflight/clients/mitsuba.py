"""Renders a scene of `trueflight export --to mitsuba` with Mitsuba 3 and judges its pixels.

    trueflight export transmittance/eq21-overview --to mitsuba --out scene
    python -m trueflight.clients.mitsuba scene --integrator volpath

Every sample of the camera's only ray has one law, whose mean `truth.json` tells, and often its variance. Where a scene
has several channels, red, green and blue are judged each by its own truth. Draws are
the samples of the integrator with the numbers of one generator. With `--pixels` they are those of pictures: scalar
variants seed each pixel by a consecutive number, and neighbours depend on each other, which the gate may find.
The gate says pass, fail or inconclusive, and so does the exit code: 0, 1 or 3, and 2 where something is wrong
with what was given. Seconds are processor time of a picture, on one thread.

Two bugs can be injected, to see that they are found:

    --bug majorant   the grid says that its largest sample is 5 % less than it is (`max_value` of `gridvolume`)
    --bug emission   lights shine twice as bright, which is what an integrator makes of them that adds what they
                     emit twice wherever it finds them
"""

import argparse
import csv
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import time
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path

import trueflight

# Version of `truth.json`, and exit codes, the worst last.
VERSION = 1
CODES = {"pass": 0, "inconclusive": 3, "fail": 1}
INTERRUPTED = 130

# Mitsuba's seeds have 32 bits.
SEEDS = 1 << 32


class Wrong(Exception):
    """An argument is invalid; the message gives the reason and the cure."""


@dataclass
class Row:
    """Results of one picture. Seconds to 1 % are for a standard error of a hundredth of the truth."""

    case: str
    question: str
    integrator: str
    emitter_sampling: bool
    draws_are: str
    bug: str
    verdict: str
    truth: float
    mean: float
    relative_difference: float
    relative_error: float
    z: float | None
    draws: int
    variance: float
    expected_variance: float | None
    samples_per_second: float
    seconds_to_1e_2: float
    ours_seconds_to_1e_2: float | None
    reason: str
    mitsuba: str


def judge(draws, truth, rounding, law, alpha):
    """Returns the verdict and the reason of the gate over an array of draws."""
    known = {"rounding": rounding, "variance": law["variance"], "kurtosis": law["kurtosis"]}
    if law["low"] is not None:
        low, high = law["low"] - rounding, law["high"]
        known["range"] = (low, math.inf if high is None else high * (1 + rounding))
    try:
        verdict = trueflight.check(draws, truth=truth, alpha=alpha, **known)
    except trueflight.Error as error:
        raise Wrong(str(error)) from None
    return verdict.verdict, verdict.reason


def ours(folder, question):
    """Returns the seconds to 1 % of `trueflight bench` for the estimator of `case.toml`; None if its draws do not vary."""
    program = os.environ.get("TRUEFLIGHT", "trueflight")
    with tempfile.TemporaryDirectory() as out:
        command = [program, "bench", str(Path(folder, "case.toml")), "--format", "csv", "--out", out]
        try:
            run = subprocess.run(command, capture_output=True, text=True, check=False)
        except FileNotFoundError:
            raise Wrong(f"cannot run `{program}`; put it in PATH, or its path in TRUEFLIGHT") from None
    if run.returncode != 0:
        raise Wrong(f"`{program} bench`: {run.stderr.strip()}")
    rows = list(csv.DictReader(run.stdout.splitlines()))
    row = next((row for row in rows if row["channel"] == question), rows[0])
    return float(row["seconds_to_1e-2"]) if row["seconds_to_1e-2"] else None


def read(folder):
    """Returns the contents of `truth.json`."""
    path = Path(folder, "truth.json")
    try:
        truth = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise Wrong(f"{path}: {error.strerror}; write it by `trueflight export --to mitsuba`") from None
    except ValueError as error:
        raise Wrong(f"{path}: {error}; write it anew by `trueflight export`") from None
    if truth.get("version") != VERSION or truth.get("target") != "mitsuba":
        raise Wrong(f"{path} is not for Mitsuba, or not of version {VERSION}; export it anew")
    return truth


def scene(mitsuba, folder, truth, question, options):
    """Returns the scene of a picture, with the requested bug."""
    path = Path(folder, question["scene"])
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise Wrong(f"{path}: {error.strerror}; write it by `trueflight export`") from None
    if options.bug == "majorant":
        if truth["field"] is None:
            raise Wrong("a homogeneous medium has no majorant; take a case whose field varies")
        low = 0.95 * truth["field"]["peak"]
        text, count = re.subn(r"(gridvolume\">)", rf'\1<float name="max_value" value="{low!r}"/>', text)
    elif options.bug == "emission":
        one = r'name="(radiance|intensity)" value="(\S+) \S+ \S+"'

        def bright(found):
            return f'name="{found[1]}" value="{2 * float(found[2])!r}"'

        text, count = re.subn(one, bright, text)
    else:
        count = 1
    if count == 0:
        raise Wrong(f"{path} has no place for the bug `{options.bug}`")
    side = str(1024 if options.pixels else 256)
    parameters = {
        "integrator": options.integrator,
        "sampling": "false" if options.no_emitter_sampling else "true",
        "width": side,
        "height": side,
    }
    # Up to 3.5 the resolver belongs to a thread.
    resolver = getattr(mitsuba, "file_resolver", None) or mitsuba.Thread.thread().file_resolver
    resolver().prepend(str(Path(folder).resolve()))
    try:
        return mitsuba.load_string(text, **parameters)
    except RuntimeError as error:
        raise Wrong(f"Mitsuba cannot load {path}: {error}") from None


def pixels(mitsuba, loaded, count, seed):
    """Returns the pixels of square pictures, a row with red, green and blue each, and the seconds that they took."""
    import numpy

    side = loaded.sensors()[0].film().size()[0]
    most = SEEDS // side**2 - -(-count // side**2)
    if seed > most:
        raise Wrong(f"--seed {seed} has no seed of 32 bits for each pixel; give one from 0 to {most}")
    pictures, seconds = [], 0.0
    for index in range(-(-count // side**2)):
        begin = time.process_time()
        # Mitsuba gives pixel i the seed `seed + i`: pictures are as many seeds apart as they have pixels.
        image = mitsuba.render(loaded, seed=(seed + index) * side**2, spp=1)
        seconds += time.process_time() - begin
        pictures.append(numpy.array(image)[:, :, :3].astype(float).reshape(-1, 3))
    return numpy.concatenate(pictures), seconds


def samples(mitsuba, loaded, count, seed, is_inside):
    """Samples of the integrator along the camera's ray, with the numbers of one generator, one after the other: a row with
    red, green and blue each."""
    import numpy

    sampler = mitsuba.load_dict({"type": "independent"})
    sampler.seed(seed)
    integrator, middle = loaded.integrator(), [0.5, 0.5]
    ray, _ = loaded.sensors()[0].sample_ray_differential(0, 0.5, middle, middle)
    media = [shape.interior_medium() for shape in loaded.shapes()]
    medium = next(filter(None, media)) if is_inside else None
    draws = numpy.empty((count, 3))
    for index in range(count):
        colour = integrator.sample(loaded, sampler, ray, medium)[0]
        draws[index] = colour[0], colour[1], colour[2]
    return draws


def laws(question, options):
    """Returns the known distribution of samples, with or without emitter sampling."""
    law = question["without_emitter_sampling" if options.no_emitter_sampling else "with_emitter_sampling"]
    if law is None:
        raise Wrong("scattering alone does not find this light; leave --no-emitter-sampling out")
    return law


def measure(mitsuba, folder, truth, questions, options):
    """Renders one picture and judges it, channel by channel if it has several: a row for each question."""
    known = [laws(question, options) for question in questions]
    loaded = scene(mitsuba, folder, truth, questions[0], options)
    # Times a picture, not the calls from Python.
    draws, seconds = pixels(mitsuba, loaded, options.draws if options.pixels else 1, options.seed if options.pixels else 0)
    rate = len(draws) / seconds
    if not options.pixels:
        draws = samples(mitsuba, loaded, options.draws, options.seed, truth["camera_in_medium"])
    alpha = options.alpha / len(truth["questions"])
    rows = []
    for question, law in zip(questions, known, strict=True):
        # In a scene without channels all colours are equal.
        of_channel = draws[:, question.get("channel", 1) - 1].copy()
        row = found(of_channel, truth, (question, law), (rate, alpha), folder, options)
        rows.append(replace(row, mitsuba=mitsuba.__version__))
    return rows


def found(draws, truth, question_and_law, rate_and_alpha, folder, options):
    """Returns the row of one question."""
    (question, law), (rate, alpha) = question_and_law, rate_and_alpha
    mean, error = question["mean"], question["error"]
    rounding = question["rounding"] + error / mean
    verdict, reason = judge(draws, mean, rounding, law, alpha)
    deviation = float(draws.std())
    standard_error = deviation / len(draws) ** 0.5
    off = float(draws.mean()) - mean
    return Row(
        case=truth["case"],
        question=question["name"],
        integrator=options.integrator,
        emitter_sampling=not options.no_emitter_sampling,
        draws_are="pixels" if options.pixels else "samples",
        bug=options.bug or "",
        verdict=verdict,
        truth=mean,
        mean=float(draws.mean()),
        relative_difference=off / mean,
        relative_error=standard_error / mean,
        z=off / standard_error if standard_error > 0 else None,
        draws=len(draws),
        variance=deviation**2,
        expected_variance=law["variance"],
        samples_per_second=rate,
        seconds_to_1e_2=(deviation / mean / 0.01) ** 2 / rate,
        ours_seconds_to_1e_2=ours(folder, question["name"]) if options.ours else None,
        reason=reason,
        mitsuba="",
    )


def by_scene(questions):
    """Returns the questions of each scene, in the order of the scenes."""
    scenes = {}
    for question in questions:
        scenes.setdefault(question["scene"], []).append(question)
    return list(scenes.values())


def arguments(words):
    """Returns the options of the command line."""
    parser = argparse.ArgumentParser(
        prog="python -m trueflight.clients.mitsuba",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )

    def digits(text):
        return int(text) if text.isascii() and text.isdigit() and len(text) < 20 else -1

    def whole(text):
        if digits(text) < 1:
            raise argparse.ArgumentTypeError("it takes a whole number above 0")
        return digits(text)

    def seed(text):
        if not 0 <= digits(text) < SEEDS:
            raise argparse.ArgumentTypeError("it takes a whole number from 0 to 2^32 - 1, as Mitsuba does")
        return digits(text)

    def chance(text):
        try:
            number = float(text)
        except ValueError:
            number = math.nan
        if not 0 < number < 1:
            raise argparse.ArgumentTypeError("it takes a probability above 0 and below 1")
        return number

    parser.add_argument("folder", metavar="DIR", help="what `trueflight export --to mitsuba` wrote")
    parser.add_argument("--integrator", default="volpath", help="volpath (default), volpathmis, …")
    parser.add_argument("--no-emitter-sampling", action="store_true", help="scattering finds lights")
    parser.add_argument("--draws", type=whole, default=1 << 20, help="samples (default 1048576)")
    parser.add_argument("--pixels", action="store_true", help="take pixels of pictures of 1024 x 1024")
    parser.add_argument("--seed", type=seed, default=1, help="seed, of 32 bits (default 1)")
    parser.add_argument("--alpha", type=chance, default=1e-3, help="chance that a correct renderer fails")
    parser.add_argument("--variant", default="scalar_rgb", help="of Mitsuba (default scalar_rgb)")
    parser.add_argument("--bug", choices=["majorant", "emission"], help="a bug to be found")
    parser.add_argument("--ours", action="store_true", help="time case.toml by `trueflight bench`, too")
    parser.add_argument("--csv", metavar="FILE", help="append a row for each picture to this file")
    return parser.parse_args(words)


def writable(path):
    """Checks, before anything is rendered, that rows can be appended to a table; leaves no file behind."""
    is_new = not os.path.lexists(path)
    try:
        with open(path, "a+", encoding="utf-8") as file:
            file.seek(0)
            header = file.readline().strip()
        if is_new:
            os.remove(path)
    except OSError as error:
        raise Wrong(f"--csv {path}: {error.strerror}; give a file that can be written") from None
    if header and header != ",".join(field.name for field in fields(Row)):
        raise Wrong(f"--csv {path} has other columns, as of another version of this program; give another file")


def lines(row):
    """Returns the text of a picture on the console."""
    reason = f": {row.reason}" if row.reason else ""
    z = "–" if row.z is None else f"{row.z:.2f}"
    yield f"{row.case} {row.question}, {row.integrator}: {row.verdict}{reason}"
    yield f"  mean/truth - 1 = {row.relative_difference:.3e} ± {row.relative_error:.1e}, z = {z}"
    time_to = f"every draw is {row.mean:g}" if row.z is None else f"1 % in {row.seconds_to_1e_2:.3g} s"
    yield f"  {row.draws} draws, {row.samples_per_second:.3g} per second, {time_to}"


def append(path, rows):
    """Appends rows to a table, which begins with its header."""
    is_new = not Path(path).exists() or Path(path).stat().st_size == 0
    with open(path, "a", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, asdict(rows[0]).keys(), lineterminator="\n")
        if is_new:
            table.writeheader()
        table.writerows(asdict(row) for row in rows)


def main(words=None):
    """Renders, judges and prints; returns the exit code."""
    options = arguments(words)
    try:
        truth = read(options.folder)
        if options.csv:
            writable(options.csv)
        try:
            import drjit
            import mitsuba
            import numpy  # noqa: F401
        except ImportError as error:
            raise Wrong(f"{error}; run `pip install mitsuba numpy`") from None
        try:
            mitsuba.set_variant(options.variant)
            mitsuba.set_log_level(mitsuba.LogLevel.Error)
            drjit.set_thread_count(1)
        except (ImportError, AttributeError) as error:
            raise Wrong(f"--variant {options.variant}: {error}") from None
        asked = by_scene(truth["questions"])
        rows = [row for questions in asked for row in measure(mitsuba, options.folder, truth, questions, options)]
        if options.csv:
            append(options.csv, rows)
    except (Wrong, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return INTERRUPTED
    for row in rows:
        for line in lines(row):
            print(line)
        if options.ours:
            fast = row.ours_seconds_to_1e_2
            print("  ours: " + ("every draw is alike" if fast is None else f"1 % in {fast:.3g} s"))
    return CODES[max((row.verdict for row in rows), key=list(CODES).index)]


if __name__ == "__main__":
    sys.exit(main())
