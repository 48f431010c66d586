"""Makes the .vdb files of this folder and `expected.json`. Needs Debian's python3-openvdb, libopenvdb-dev and libboost-dev:

    c++ -std=c++17 -w again.cpp -o again -lopenvdb -ltbb -lImath-3_1
    /usr/bin/python3 make.py ./again

Grids are made and written by pyopenvdb; again.cpp writes them anew by other compressions, and answers what
OpenVDB's own samplers find at points. Values at points and optical depths along rays are trilinear interpolation
of what pyopenvdb's accessor finds, in rational numbers.
"""

import json
import math
import subprocess
import sys
from fractions import Fraction

import pyopenvdb as vdb


def mixed():
    """Leaves with active and inactive voxels at negative coordinates, and an active tile of 8³."""
    grid = vdb.FloatGrid()
    grid.name = "density"
    voxel = grid.getAccessor()
    for x in range(-13, -5):
        for y in range(6, 11):
            for z in range(-12, -6):
                voxel.setValueOn((x, y, z), (7 * (x + 13) + 5 * (y - 6) + 3 * (z + 12)) % 16 / 16)
    voxel.setValueOn((-10, 8, -9), 0.7)
    # One leaf with one inactive value beside the background, one with two, one with three.
    voxel.setValueOff((-7, 7, -11), 0.75)
    voxel.setValueOff((-5, 12, -12), 0.25)
    voxel.setValueOff((-5, 13, -12), 0.5)
    voxel.setValueOff((-20, 1, -3), 0.25)
    voxel.setValueOff((-21, 1, -3), 0.5)
    voxel.setValueOff((-22, 1, -3), 0.625)
    voxel.setValueOn((-20, 2, -3), 0.125)
    grid.fill((-24, 8, -8), (-17, 15, -1), 0.375)
    return grid


def small(scale=None, **transform):
    """Two leaves, that need not be compressed."""
    grid = vdb.FloatGrid()
    grid.name = "density"
    voxel = grid.getAccessor()
    for n in range(27):
        voxel.setValueOn((n % 3 + 7, n // 3 % 3, n // 9), (n * n % 8) / 4 + 0.1)
    if scale:
        matrix = [[0.0] * 4 for _ in range(4)]
        for j in range(3):
            matrix[j][j] = scale[j]
        matrix[3] = [*transform.get("shift", (0, 0, 0)), 1]
        for at, value in transform.get("shear", {}).items():
            matrix[at[0]][at[1]] = value
        grid.transform = vdb.createLinearTransform(matrix)
    return grid


def tiles():
    """An active tile of 128³ and one of 8³ beside it."""
    grid = vdb.FloatGrid()
    grid.name = "density"
    grid.fill((-128, 0, 0), (-1, 127, 127), 0.5)
    grid.fill((0, 0, 0), (7, 7, 7), 0.25)
    grid.transform = vdb.createLinearTransform(0.0625)
    return grid


def named(grid, name):
    grid.name = name
    return grid


def write_all():
    vdb.write("mixed-blosc.vdb", mixed())
    half = mixed()
    half.saveFloatAsHalf = True
    vdb.write("half-blosc.vdb", half)
    vdb.write("small-blosc.vdb", small())
    vdb.write("tiles.vdb", tiles())
    vdb.write("translated.vdb", small((1, 1, 1), shift=(10, -20, 0.5)))
    fog = small((0.25, 0.25, 0.25))
    fog.gridClass = vdb.GridClass.FOG_VOLUME
    vdb.write("uniform.vdb", fog)
    vdb.write("moved.vdb", small((0.1, 0.1, 0.1), shift=(1, 2, 3)))
    vdb.write("stretched.vdb", small((0.5, 0.25, 2), shift=(-1, 0, 4)))
    vdb.write("scaled.vdb", small((0.5, 0.25, 2)))
    vdb.write("mirrored.vdb", small((-0.5, 0.25, 0.5), shift=(3, 0, 0)))
    vdb.write("sheared.vdb", small((1, 1, 1), shear={(0, 1): 0.5}))
    frustum = small()
    frustum.transform = vdb.createFrustumTransform((0, 0, 0), (8, 8, 8), 0.5, 10)
    vdb.write("frustum.vdb", frustum)
    # What is no medium.
    vdb.write("empty.vdb", vdb.FloatGrid())
    filled = vdb.FloatGrid(0.5)
    filled.fill((0, 0, 0), (3, 3, 3), 1.0)
    vdb.write("background.vdb", filled)
    vdb.write("level-set.vdb", vdb.createLevelSetSphere(radius=3.0, voxelSize=1.0))
    far = vdb.FloatGrid()
    far.fill((0, 0, 0), (4095, 4095, 4095), 1.0)
    vdb.write("vast.vdb", far)
    bad = vdb.FloatGrid()
    bad.getAccessor().setValueOn((1, 2, -3), math.nan)
    vdb.write("nan.vdb", bad)
    # Several grids: two share a tree, two a name, and some have no floats.
    first = named(small(), "density")
    shared = first.copy()
    shared.name = "shared"
    shared.transform = vdb.createLinearTransform(0.5)
    velocity = vdb.Vec3SGrid()
    velocity.fill((0, 0, 0), (1, 1, 1), (1.0, 2.0, 3.0))
    mask = vdb.BoolGrid()
    mask.fill((0, 0, 0), (1, 1, 1), True)
    heat = named(small((0.25, 0.25, 0.25)), "heat")
    other = named(vdb.FloatGrid(), "heat")
    other.fill((0, 0, 0), (1, 1, 1), 3.0)
    vdb.write("several.vdb", [first, shared, named(velocity, "velocity"), named(mask, "mask"), heat, other])


def trilinear(voxel, u):
    base = [math.floor(x) for x in u]
    total = Fraction(0)
    for corner in range(8):
        at, weight = [], Fraction(1)
        for j in range(3):
            far = corner >> j & 1
            at.append(base[j] + far)
            weight *= u[j] - base[j] if far else 1 - (u[j] - base[j])
        if weight:
            total += weight * Fraction(voxel.getValue(tuple(at)))
    return total


def index(grid, p):
    return [Fraction(x) for x in grid.transform.worldToIndex(tuple(p))]


def within(u, box):
    return all(low <= x <= high for x, low, high in zip(u, *box))


def depth(grid, origin, end, box):
    """∫ over the straight line from `origin` to `end`, in a box of indices: Simpson's rule in each cell, which cubics need
    no more than."""
    voxel = grid.getConstAccessor()
    a, b = index(grid, origin), index(grid, end)
    cuts = {Fraction(0), Fraction(1)}
    for p, q in zip(a, b):
        if p != q:
            low, high = sorted((p, q))
            cuts |= {(n - p) / (q - p) for n in range(math.ceil(low), math.floor(high) + 1)}
    place = lambda t: [p + t * (q - p) for p, q in zip(a, b)]
    at = lambda t: trilinear(voxel, place(t))
    cuts = sorted(cuts)
    total = Fraction(0)
    for s, t in zip(cuts, cuts[1:]):
        if within(place((s + t) / 2), box):
            total += (t - s) / 6 * (at(s) + 4 * at((s + t) / 2) + at(t))
    return float(total) * math.dist(origin, end)


def expected(file, again, name=""):
    grid = vdb.read(file, name) if name else vdb.readAll(file)[0][0]
    low, high = None, None
    for value in grid.iterAllValues():
        if value.value != grid.background:
            box = (value.min, value.max)
            low = box[0] if low is None else tuple(map(min, low, box[0]))
            high = box[1] if high is None else tuple(map(max, high, box[1]))
    # The leaf's own box is that of its voxels here: iterAllValues goes voxel by voxel.
    corner = lambda x: grid.transform.indexToWorld(tuple(x))
    ends = [[x - 1 for x in low], [x + 1 for x in high]]
    # A medium ends where OpenVDB's background goes on.
    is_in = lambda p: grid.background == 0 or within(index(grid, p), ends)
    halves = [[x - 0.5 for x in low], [x + 0.5 for x in high]]
    corners = [corner([ends[n >> j & 1][j] for j in range(3)]) for n in range(8)]
    low, high = [[f(column) for column in zip(*corners)] for f in (min, max)]
    inside = lambda *share: [a + s * (b - a) for a, b, s in zip(low, high, share)]
    shares = [(37 * n % 64 + 0.3) / 64 for n in range(40)]
    points = [inside(shares[i], shares[11 * i % 40], shares[7 * i % 40]) for i in range(40)]
    points += [inside(0.02, 0.98, 0.5), inside(0.5, 0.5, 0.5), inside(0, 0.3, 1)]
    voxel = grid.getConstAccessor()
    asked = "\n".join(" ".join(map(repr, p)) for p in points)
    own = subprocess.run([again, "sample", file, grid.name], input=asked, text=True, check=True, capture_output=True)
    sampled = [[float(word) for word in line.split()] for line in own.stdout.splitlines()]
    rays = [(inside(-0.5, 0.1, 0.2), inside(1.25, 0.9, 0.7)), (inside(0.3, 0.45, -1), inside(0.3, 0.45, 2))]
    rays.append((inside(1.1, 1.2, 1.1), inside(0.2, -0.3, 0.1)))
    return {
        "file": file,
        "grid": name,
        "low": low,
        "high": high,
        "points": [
            {
                "at": p,
                "value": float(trilinear(voxel, index(grid, p))) if is_in(p) else 0.0,
                "box": box if is_in(p) else 0.0,
                # Of a background that is not 0 the half voxels beyond the last ones are not compared.
                "nearest": nearest if grid.background == 0 or within(index(grid, p), halves) else None,
            }
            for p, (box, nearest) in zip(points, sampled)
        ],
        "rays": [{"from": o, "to": e, "depth": depth(grid, o, e, ends)} for o, e in rays],
    }


def main():
    again = sys.argv[1]
    write_all()
    for base, kinds in {
        "mixed": ["zip-mask", "mask", "zip", "blosc"],
        "half": ["zip-mask", "mask"],
        "small": ["none"],
    }.items():
        for kind in kinds:
            target = f"{base}-{kind}.vdb" if kind != "blosc" else f"{base}-blosc-all.vdb"
            subprocess.run([again, "write", f"{base}-blosc.vdb", target, kind], check=True)
    files = ["mixed-blosc", "mixed-blosc-all", "mixed-zip-mask", "mixed-zip", "mixed-mask"]
    files += ["half-blosc", "half-zip-mask", "half-mask", "small-blosc", "small-none", "tiles", "translated", "uniform"]
    files += ["moved", "stretched", "scaled", "mirrored"]
    entries = [expected(f"{file}.vdb", again) for file in files]
    entries += [expected("several.vdb", again, name) for name in ("density", "shared")]
    with open("expected.json", "w") as out:
        lines = ",\n".join(json.dumps(entry) for entry in entries)
        out.write(f"[\n{lines}\n]\n")


if __name__ == "__main__":
    main()
