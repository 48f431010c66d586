"""Makes the grids of this folder and `expected.json`, beside those of ../vdb. Needs what ../vdb/make.py needs, and Debian's
libnanovdb-tools (NanoVDB 32.4.2, of OpenVDB 10.0.1):

    c++ -std=c++17 -w ../vdb/again.cpp -o again -lopenvdb -ltbb -lImath-3_1
    /usr/bin/python3 make.py ./again
    c++ -std=c++17 -I NEW/nanovdb later.cpp -lz -o later && ./later     NEW: OpenVDB of August 2026, NanoVDB 32.9

Values and optical depths are those of ../vdb/make.py: OpenVDB's samplers, and trilinear interpolation in rational numbers
of what its accessor finds.
"""

import json
import math
import subprocess
import sys

import pyopenvdb as vdb

sys.path.insert(0, "../vdb")
from make import expected, mixed, small, tiles  # noqa: E402


def turned(grid, degrees, scale, shift):
    """Turned about (1, 2, 2)/3 by an angle, with a scale along each of the grid's own axes."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    axis = [1 / 3, 2 / 3, 2 / 3]
    cross = [[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]]
    turn = [[c * (i == j) + s * cross[i][j] + (1 - c) * axis[i] * axis[j] for j in range(3)] for i in range(3)]
    # OpenVDB multiplies points from the left.
    rows = [[scale[i] * turn[j][i] for j in range(3)] + [0.0] for i in range(3)]
    grid.transform = vdb.createLinearTransform(rows + [[*shift, 1.0]])
    return grid


def filled():
    """A background that is not 0: beyond the box of other voxels it goes on for ever."""
    grid = vdb.FloatGrid(0.5)
    grid.name = "density"
    voxel = grid.getAccessor()
    for n in range(27):
        voxel.setValueOn((n % 3, n // 3 % 3, n // 9), (n * n % 8) / 4)
    return grid


def main():
    again = sys.argv[1]
    vdb.write("turned.vdb", turned(small(), 40, (0.5, 0.5, 0.5), (1, -2, 3)))
    vdb.write("turned-mixed.vdb", turned(mixed(), -75, (0.25, 0.5, 0.125), (0, 0, 1)))
    quarter = small()
    quarter.transform = vdb.createLinearTransform([[0, 0.5, 0, 0], [-0.5, 0, 0, 0], [0, 0, 0.5, 0], [1, 2, 3, 1]])
    vdb.write("quarter.vdb", quarter)
    vdb.write("filled.vdb", filled())
    vdb.write("turned-filled.vdb", turned(filled(), 20, (1, 1, 1), (0.5, 0, 0)))
    negative = vdb.FloatGrid(-0.5)
    negative.fill((0, 0, 0), (1, 1, 1), 1.0)
    vdb.write("negative.vdb", negative)
    convert = lambda source, target, *words: subprocess.run(
        ["nanovdb_convert", "-f", *words, source, target], check=True
    )
    source = "../vdb/mixed-blosc.vdb"
    convert(source, "mixed-zip.nvdb", "--zip")
    convert(source, "mixed-blosc.nvdb", "--blosc")
    for kind in ("fp4", "fp8", "fp16", "fpN"):
        convert(source, f"mixed-{kind}.nvdb", "--zip", f"--{kind}")
        # What NanoVDB reads of it, as OpenVDB's file.
        subprocess.run(["nanovdb_convert", "-f", f"mixed-{kind}.nvdb", f"mixed-{kind}.vdb"], check=True)
    for name in ("several", "level-set", "tiles", "mirrored"):
        convert(f"../vdb/{name}.vdb", f"{name}.nvdb", "--zip")
    convert("turned.vdb", "turned.nvdb", "--zip")
    convert("filled.vdb", "filled.nvdb", "--zip")
    entries = [expected(f"{name}.vdb", again) for name in ("turned", "turned-mixed", "quarter", "filled", "turned-filled")]
    entries.append({**expected("../vdb/sheared.vdb", again), "file": "../vdb/sheared.vdb"})
    entries.append({**expected("../vdb/background.vdb", again), "file": "../vdb/background.vdb"})
    with open("expected.json", "w") as out:
        lines = ",\n".join(json.dumps(entry) for entry in entries)
        out.write(f"[\n{lines}\n]\n")


main()
