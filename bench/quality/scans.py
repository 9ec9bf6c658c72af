"""Rigid motions as rows of 4 x 4 matrices, boxes of scans, the truth of a set, and what a run holds of it."""
import json
import math
import sqlite3
import struct
import subprocess
from pathlib import Path
from typing import NamedTuple

PROGRAM = str(Path(__file__).resolve().parents[2] / "build/release/rejoin")
FOUND = (5.0, 2.0)  # degrees, per cent of the two fragments' joint diameter
PRECISE = (1.0, 0.5)


def read_truth(folder):
    """(file name -> matrix to the assembled object, (A, B) -> contact area) of FOLDER/truth.json."""
    truth = json.loads((folder / "truth.json").read_text())
    poses = {name: fragment["to_world"] for name, fragment in truth["fragments"].items()}
    return poses, {tuple(sorted(join[:2])): join[2] for join in truth["joins"]}


class Pair(NamedTuple):
    stage: str
    verdict: str
    score: float
    seconds: float
    pose: list | None  # the best


def read_pairs(run):
    """(A, B) -> Pair of what `rejoin batch` wrote."""
    database = sqlite3.connect(run / "run.sqlite")
    matrix = ", ".join(f"m{row}{column}" for row in range(1, 5) for column in range(1, 5))
    names = dict(database.execute("SELECT id, name FROM fragment"))
    poses = {row[:2]: row[2:] for row in database.execute(f"SELECT a, b, {matrix} FROM candidate WHERE rank = 1")}
    return {(names[a], names[b]): Pair(*rest, [poses[a, b][4 * k : 4 * k + 4] for k in range(4)] if (a, b) in poses else None)
            for a, b, *rest in database.execute("SELECT a, b, stage, verdict, score, seconds FROM pair")}


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def inverse(m):
    turned = [[m[j][i] for j in range(3)] for i in range(3)]
    moved = [-sum(turned[i][k] * m[k][3] for k in range(3)) for i in range(3)]
    return [turned[i] + [moved[i]] for i in range(3)] + [[0.0, 0.0, 0.0, 1.0]]


def moved(m, p):
    return [sum(m[i][k] * p[k] for k in range(3)) + m[i][3] for i in range(3)]


def turned_about(m, axis, degrees, centre):
    """A motion, then a turn about an axis (of any length) through a point."""
    x, y, z = (value / math.hypot(*axis) for value in axis)
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    turn = [[c + x * x * (1 - c), x * y * (1 - c) - z * s, x * z * (1 - c) + y * s],
            [y * x * (1 - c) + z * s, c + y * y * (1 - c), y * z * (1 - c) - x * s],
            [z * x * (1 - c) - y * s, z * y * (1 - c) + x * s, c + z * z * (1 - c)]]
    shift = [centre[i] - sum(turn[i][k] * centre[k] for k in range(3)) for i in range(3)]
    return product([turn[i] + [shift[i]] for i in range(3)] + [[0.0, 0.0, 0.0, 1.0]], m)


def corners(program, scan, folder):
    """The corners of a scan's box in file coordinates, read from the PLY that `rejoin facets` writes of it."""
    copy = Path(folder) / "box.ply"
    subprocess.run([program, "facets", str(scan), "--ply", str(copy), "--quiet"], check=True, stdout=subprocess.DEVNULL)
    data = copy.read_bytes()
    header, body = data.split(b"end_header\n", 1)
    lines = header.decode().splitlines()
    count = next(int(line.split()[2]) for line in lines if line.startswith("element vertex"))
    sizes = {"float": 4, "double": 8, "uchar": 1}
    kinds, inside = [], False
    for line in lines:
        if line.startswith("element"):
            inside = line.startswith("element vertex")
        elif line.startswith("property") and inside:
            kinds.append(line.split()[1])
    layout = struct.Struct("<" + "".join({"float": "f", "double": "d", "uchar": "B"}[kind] for kind in kinds))
    assert layout.size == sum(sizes[kind] for kind in kinds)
    points = [layout.unpack_from(body, k * layout.size)[:3] for k in range(0, count, max(1, count // 2000))]
    low = [min(axis) for axis in zip(*points)]
    high = [max(axis) for axis in zip(*points)]
    return [[(low, high)[(k >> axis) & 1][axis] for axis in range(3)] for k in range(8)]


def angle(a, b):
    """Angle between two motions, degrees."""
    trace = sum(a[i][k] * b[i][k] for i in range(3) for k in range(3))
    return math.degrees(math.acos(max(-1.0, min(1.0, (trace - 1) / 2))))


def diagonal(points):
    return math.dist([min(axis) for axis in zip(*points)], [max(axis) for axis in zip(*points)])


def offsets(pose, truth, box_a, box_b):
    """Rotation error in degrees, mean displacement of B's box in per cent of the joint diameter."""
    there = [moved(truth, p) for p in box_b]
    off = sum(math.dist(moved(pose, p), q) for p, q in zip(box_b, there)) / len(box_b)
    return angle(pose, truth), 100 * off / diagonal(box_a + there)


def is_found(pose, truth, box_a, box_b):
    if pose is None:
        return False
    turn, displacement = offsets(pose, truth, box_a, box_b)
    return turn <= FOUND[0] and displacement <= FOUND[1]
