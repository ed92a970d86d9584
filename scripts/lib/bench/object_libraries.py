"""Libraries of objects for the section about objects: taught from a mapped room, and grown with made-up objects.

An object is taught from the segments most of whose points are its own, as a person would choose them. The instances
come from kintsugi-ground-truth, the segments from the map."""

import colorsys
import json
import re
import struct
import zlib
from collections import Counter, defaultdict
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from trio.messages import Problem

MIN_POINTS = 300  # to teach from: fewer show too little of the object
CARRIED_MM = 1100  # the largest side of what a person may carry about; the others are furniture
PROPERTY = re.compile(r"(?m)^property (\w+) (\w+)$")
FORMATS = {"float": "f", "uchar": "B", "int": "i", "uint": "I"}


def read_ply(file):
    """The names of the properties of the vertices, and an iterator over the vertices: binary, little endian."""
    content = Path(file).read_bytes()
    header, _, body = content.partition(b"end_header\n")
    header = header.decode()
    layout = layout_of(header)
    count = int(re.search(r"element vertex (\d+)", header)[1])
    return [name for _, name in PROPERTY.findall(header)], layout.iter_unpack(body[:count * layout.size])


def layout_of(header):
    """Of a vertex."""
    return struct.Struct("<" + "".join(FORMATS[kind] for kind, _ in PROPERTY.findall(header)))


def columns(file, *names):
    """These columns of each vertex, as tuples."""
    properties, vertices = read_ply(file)
    places = [properties.index(name) for name in names]
    return [tuple(vertex[place] for place in places) for vertex in vertices]


def owners(segments, truth):
    """The segments of each instance, and how many of its points are in them.
    segments, truth: (x, y, z, id) of each point; both of the same points, in any order."""
    instance_at = {point[:3]: point[3] for point in truth}
    instances = defaultdict(Counter)
    for *place, segment in segments:
        instances[segment][instance_at.get(tuple(place), 0)] += 1
    owned = defaultdict(lambda: [[], 0])
    for segment, counts in sorted(instances.items()):
        instance, count = max(counts.items(), key=lambda item: (item[1], -item[0]))
        if segment and instance and 2 * count > counts.total():
            owned[instance][0].append(segment)
            owned[instance][1] += count
    return owned


def library_name(key):
    """As kintsugi-evaluate expects it."""
    return key.replace(" ", "_")


def can_be_carried(key):
    sizes = re.search(r"(\d+)x(\d+)x(\d+)", key)
    return sizes is not None and max(map(int, sizes.groups())) <= CARRIED_MM


def lessons(owned, objects):
    """Which segments are to be taught under which name. objects: as kintsugi-ground-truth tells of those in two rooms."""
    keys = {each["id_before"]: each["key_before"] for each in objects}
    return {library_name(keys[instance]): segments for instance, (segments, points) in sorted(owned.items())
            if instance in keys and points >= MIN_POINTS and can_be_carried(keys[instance])}


def teach(run, room, objects, library):
    """Teaches the objects of a mapped room into a new library; returns their names."""
    owned = owners(columns(room.segments, "x", "y", "z", "segment_id"), columns(room.truth, "x", "y", "z", "instance_id"))

    def learn(lesson):
        name, segments = lesson
        run.kintsugi("objects", "teach", "--map", room.map, "--ids", ",".join(map(str, segments)), "--name", name,
                     "--library", library, log=f"teach_{name}")
        return name

    with ThreadPoolExecutor(2) as pool:
        return list(pool.map(learn, lessons(owned, objects).items()))


def grow(library, grown, count):
    """Copies a library and adds objects that are nowhere to be found, until it has so many: those of the library,
    stretched by their own factors along each axis and in another hue."""
    originals = [known_object(folder) for folder in sorted(Path(library).iterdir()) if folder.is_dir()]
    if not originals:
        raise Problem(f"there are no objects in {library}")
    for number in range(count):
        description, vertices = originals[number % len(originals)]
        generation = number // len(originals)
        if generation:
            description, vertices = variant(description, vertices, generation, number)
        write_object(Path(grown), description, vertices)


def known_object(folder):
    return json.loads((folder / "object.json").read_text()), list(read_ply(folder / "model.ply")[1])


def spread(number, step):
    """Numbers from 0 to 1 that lie evenly, however many there are."""
    return number * step % 1.0


# Inverse powers of the root of x^4 = x + 1: the sequence that fills a cube with one side more than a plane most evenly.
STEPS = (0.8191725, 0.6710436, 0.5497005)
SMALLEST, LARGEST = 0.75, 1.35  # of the factors: another thing of a like kind


def variant(description, vertices, generation, number):
    factors = [SMALLEST + (LARGEST - SMALLEST) * spread(number, step) for step in STEPS]
    turn = spread(number, 0.618034)
    vertices = [stretched(vertex, factors, turn) for vertex in vertices]
    low, high = ([extreme(vertex[axis] for vertex in vertices) for axis in range(3)] for extreme in (min, max))
    size_m = [b - a for a, b in zip(low, high, strict=True)]
    return {**description, "name": f"{description['name'][:54]}_v{generation}", "size_m": size_m}, vertices


def stretched(vertex, factors, turn):
    x, y, z, nx, ny, nz, red, green, blue, weight = vertex
    position = [each * factor for each, factor in zip((x, y, z), factors, strict=True)]
    normal = [each / factor for each, factor in zip((nx, ny, nz), factors, strict=True)]
    length = sum(each * each for each in normal) ** 0.5 or 1.0
    hue, saturation, value = colorsys.rgb_to_hsv(red / 255, green / 255, blue / 255)
    color = colorsys.hsv_to_rgb((hue + turn) % 1.0, saturation, value)
    return (*position, *(each / length for each in normal), *(round(255 * each) for each in color), weight)


def write_object(library, description, vertices):
    folder = library / description["name"]
    folder.mkdir(parents=True)
    properties = [*(f"float {name}" for name in ("x", "y", "z", "nx", "ny", "nz")),
                  *(f"uchar {name}" for name in ("red", "green", "blue")), "float weight"]
    header = "\n".join(["ply", "format binary_little_endian 1.0", "comment kintsugi object, frame O, metres",
                        f"element vertex {len(vertices)}", *(f"property {each}" for each in properties),
                        "end_header\n"])
    layout = struct.Struct("<6f3Bf")
    content = header.encode() + b"".join(layout.pack(*vertex) for vertex in vertices)
    (folder / "model.ply").write_bytes(content)
    (folder / "object.json").write_text(json.dumps({**description, "points": len(vertices),
                                                    "model_crc32": f"{zlib.crc32(content):08x}"}))
