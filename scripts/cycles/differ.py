"""Says how Cycles' picture of what is lit differs from Noonmark's truth, and what both cost in processor time.

    python3 differ.py FOLDER     with FOLDER/judged/{ladder.exr,point.json}, FOLDER/times.json and FOLDER/view.txt

It reads ladder.exr as Noonmark writes it: ZIP compression, one part. Exit code 1: more than 0.5% of the counted pixels
differ, so the two programs do not see the same scene.
"""
import json
import re
import statistics
import struct
import sys
import zlib

import numpy

FACING, AMBIGUOUS = 1, 4  # flags in point.json
AT_MOST = 0.005


def read_exr(path, wanted):
    with open(path, "rb") as file:
        data = file.read()
    at, attributes = 8, {}
    while data[at]:
        name_end = data.index(0, at)
        kind_end = data.index(0, name_end + 1)
        size = struct.unpack_from("<i", data, kind_end + 1)[0]
        attributes[data[at:name_end].decode()] = data[kind_end + 5:kind_end + 5 + size]
        at = kind_end + 5 + size
    channels, listed, name = [], attributes["channels"], 0
    while listed[name]:
        end = listed.index(0, name)
        channels.append(listed[name:end].decode())
        name = end + 17
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    pictures = {c: numpy.empty((height, width), numpy.float32) for c in wanted}
    for (offset,) in struct.iter_unpack("<Q", data[at + 1:at + 1 + 8 * -(-height // 16)]):
        first, size = struct.unpack_from("<2i", data, offset)
        first -= top
        rows = min(16, height - first)
        block = data[offset + 8:offset + 8 + size]
        if size < rows * width * len(channels) * 4:  # otherwise the block is stored as it is
            steps = numpy.frombuffer(zlib.decompress(block), numpy.uint8).copy()
            steps[1:] -= 128
            whole = numpy.cumsum(steps, dtype=numpy.uint8)
            half = (len(whole) + 1) // 2
            mixed = numpy.empty_like(whole)
            mixed[0::2], mixed[1::2] = whole[:half], whole[half:]
            block = mixed.tobytes()
        values = numpy.frombuffer(block, "<f4").reshape(rows, len(channels), width)
        for c in wanted:
            pictures[c][first:first + rows] = values[:, channels.index(c)]
    return pictures


def beside_edge(classes):
    """Pixels with a neighbour (of eight) of another class."""
    padded = numpy.pad(classes, 1, mode="edge")
    height, width = classes.shape
    near = numpy.zeros(classes.shape, bool)
    for y in range(3):
        for x in range(3):
            near |= padded[y:y + height, x:x + width] != classes
    return near


def main():
    folder = sys.argv[1]
    seen = read_exr(f"{folder}/judged/ladder.exr", ["R1", "R6", "flags", "primitive"])
    flags = seen["flags"].astype(int)
    counted = (flags & FACING != 0) & (flags & AMBIGUOUS == 0)
    other = counted & (seen["R1"] != seen["R6"])
    share, total = other.sum() / counted.sum(), counted.sum()
    facing = flags & FACING != 0
    shadow_edge = beside_edge(numpy.where(facing, seen["R1"], 2))
    triangle_edge = beside_edge(seen["primitive"])
    on_shadow, on_triangle = (other & shadow_edge).sum(), (other & ~shadow_edge & triangle_edge).sum()
    print(f"pixels: {other.sum()} of {total} counted differ ({100 * share:.4f}%); "
          f"{(other & (seen['R6'] > 0.5)).sum()} of them Cycles calls lit")
    print(f"  {on_shadow} beside an edge of a shadow or of what faces the sun, {on_triangle} beside another edge of a "
          f"triangle, {other.sum() - on_shadow - on_triangle} elsewhere")

    with open(f"{folder}/times.json") as file:
        times = json.load(file)
    with open(f"{folder}/view.txt") as file:
        picture, kept, first = map(float, re.search(r"picture ([\d.]+) ms CPU, R1 ([\d.]+), first R1 ([\d.]+)",
                                                    file.read()).groups())
    sample = statistics.median(times["sample_ms"])
    print(f"Cycles: {sample:.0f} ms of processor time for one more sample of each pixel "
          f"({min(times['sample_ms']):.0f} to {max(times['sample_ms']):.0f}); "
          f"a render of one sample: {statistics.median(times['few_ms']):.0f} ms")
    print(f"Noonmark: picture {picture:.0f} ms, R1 with its certainty {kept:.0f} ms (new light: {first:.0f} ms)")
    print(f"Cycles takes {sample / (picture + kept):.1f} times as long as picture and R1, "
          f"{sample / (picture + first):.1f} times with a new light, {sample / kept:.1f} times as long as R1 alone")
    return 1 if share > AT_MOST else 0


sys.exit(main())
