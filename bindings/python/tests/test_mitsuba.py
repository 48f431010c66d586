"""The client of Mitsuba: honest pictures pass, injected bugs fail, and what is wrong gets one clear error.

It needs the package mitsuba, and the command `trueflight` in PATH or its path in TRUEFLIGHT.
"""

import csv
import os
import shutil
import subprocess

import pytest

pytest.importorskip("mitsuba")
pytest.importorskip("numpy")

from trueflight.clients import mitsuba as client

PROGRAM = os.environ.get("TRUEFLIGHT", "trueflight")
if shutil.which(PROGRAM) is None:
    pytest.skip("the command `trueflight` is not there", allow_module_level=True)


@pytest.fixture(scope="module")
def export(tmp_path_factory):
    """Exports a built-in case to a folder."""
    folders = {}

    def exported(case, target="mitsuba"):
        if (case, target) not in folders:
            out = tmp_path_factory.mktemp("scene")
            command = [PROGRAM, "export", case, "--to", target, "--out", str(out), "--quiet"]
            subprocess.run(command, check=True)
            folders[case, target] = str(out)
        return folders[case, target]

    return exported


SMALL = ["--draws", "500000", "--alpha", "1e-6"]


@pytest.mark.parametrize("integrator", ["volpath", "volpathmis"])
@pytest.mark.parametrize("case", ["transmittance/eq21-overview", "single-scattering/null-paths-layers"])
def test_honest_pictures_pass(export, case, integrator):
    assert client.main([export(case), "--integrator", integrator, *SMALL]) == 0


def test_every_path_of_a_white_furnace_finds_light(export):
    assert client.main([export("furnace/known-bugs"), "--no-emitter-sampling", "--draws", "5000"]) == 0


@pytest.mark.parametrize("integrator", ["volpath", "volpathmis"])
def test_lights_counted_twice_are_found(export, integrator):
    for case in ["transmittance/eq21-overview", "single-scattering/null-paths-layers"]:
        assert client.main([export(case), "--integrator", integrator, "--bug", "emission", *SMALL]) == 1


def test_a_low_majorant_is_found(export):
    words = ["--draws", "4000000", "--bug", "majorant"]
    assert client.main([export("transmittance/eq21-overview"), *words]) == 1


def test_rows_are_appended_to_a_table(export, tmp_path):
    table = tmp_path / "table.csv"
    for _ in range(2):
        client.main([export("slab/known-bugs"), "--draws", "5000", "--csv", str(table)])
    with open(table, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [row["question"] for row in rows] == ["reflectance", "transmittance"] * 2
    assert rows[0]["mean"] == rows[2]["mean"], "a seed makes its draws again"


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["nowhere"], "truth.json"),
        (["EXPORT", "--integrator", "nonsense"], "nonsense"),
        (["EXPORT", "--variant", "nonsense"], "nonsense"),
        (["BALL", "--bug", "majorant"], "no majorant"),
        (["POINT", "--no-emitter-sampling"], "does not find this light"),
        (["PBRT"], "not for Mitsuba"),
        (["EXPORT", "--draws", "9999999999", "--csv", "no/such/table.csv"], "--csv no/such/table.csv: No such file"),
        (["EXPORT", "--draws", "100", "--pixels", "--seed", "4096"], "--seed 4096 has no seed of 32 bits for each pixel"),
    ],
)
def test_what_is_wrong_is_told(export, capsys, words, told):
    folders = {
        "EXPORT": ("transmittance/eq21-overview", "mitsuba"),
        "BALL": ("furnace/known-bugs", "mitsuba"),
        "POINT": ("single-scattering/null-paths-layers", "mitsuba"),
        "PBRT": ("transmittance/eq21-overview", "pbrt"),
    }
    words = [export(*folders[word]) if word in folders else word for word in words]
    assert client.main(words) == 2
    error = capsys.readouterr().err
    assert error.startswith("error: ") and told in error


def test_a_command_that_is_not_there_is_told(export, capsys, monkeypatch):
    folder = export("transmittance/eq21-overview")
    monkeypatch.setenv("TRUEFLIGHT", "no-such-command")
    assert client.main([folder, "--draws", "100", "--ours"]) == 2
    assert "no-such-command" in capsys.readouterr().err


def test_what_the_console_says(export, capsys):
    folder = export("transmittance/eq21-overview")
    assert client.main([folder, "--draws", "100", "--seed", "0", "--ours"]) == 3
    first, _, third, fourth = capsys.readouterr().out.splitlines()
    assert first.startswith("transmittance/eq21-overview") and ", volpath: inconclusive: " in first
    assert "100 draws, " in third and fourth.startswith("  ours: 1 % in ")


def test_draws_that_are_alike_have_no_z(export, capsys, tmp_path):
    table = tmp_path / "table.csv"
    words = [export("transmittance/eq21-overview"), "--integrator", "path", "--draws", "5000", "--csv", str(table)]
    client.main(words)
    text = capsys.readouterr().out
    assert "z = –\n" in text and "every draw is 1\n" in text and "1 % in" not in text
    with open(table, encoding="utf-8") as file:
        assert [row["z"] for row in csv.DictReader(file)] == [""]


@pytest.mark.parametrize("seed", ["-1", "4294967296", "²", "1e3"])
def test_a_seed_has_32_bits(capsys, seed):
    with pytest.raises(SystemExit) as left:
        client.main(["scene", f"--seed={seed}"])
    assert left.value.code == 2 and "a whole number from 0 to 2^32 - 1" in capsys.readouterr().err


def test_ctrl_c_is_one_line(export, capsys, monkeypatch, tmp_path):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(client, "measure", interrupted)
    table = tmp_path / "table.csv"
    assert client.main([export("transmittance/eq21-overview"), "--csv", str(table)]) == 130
    assert capsys.readouterr().err == "interrupted\n" and not table.exists()
