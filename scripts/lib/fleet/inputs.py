"""The list of inputs: one a line."""

import json
import os
import re
import shlex
import sys
from collections import Counter, defaultdict
from dataclasses import asdict, dataclass, field, replace

from trio.messages import Problem, os_error_text

from .options import PROGRAMS, words_for

KINDS = ("cloud", "log", "recording")
FILES = ("truth", "path")
KEYS = ("name", *FILES, "kind", *PROGRAMS)
ADDRESS = re.compile(r"^[a-z0-9]+://")
NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.=-]{0,99}")
SHOWN_ERRORS = 10


@dataclass(frozen=True)
class Input:
    """A line of the list. Paths are absolute; `device` may be an address, as synthetic://office."""

    name: str
    device: str
    kind: str = ""  # empty: its name and content tell
    truth: str = ""  # PLY file with true instances
    path: str = ""  # file with the camera's true path
    words: dict = field(default_factory=dict)  # further options, by the keys of PROGRAMS

    def as_json(self):
        return asdict(self)

    def but_for_its_name(self):
        return json.dumps(replace(self, name="").as_json(), sort_keys=True)


def read_list(file, recorded=()):
    """The inputs of a list (a path, or - for standard input), in its order. `recorded`: those that the folder of the
    fleet has already. Raises Problem, which names the first lines that are wrong."""
    try:
        if file == "-":
            text, folder, file = sys.stdin.read(), os.getcwd(), "standard input"
        else:
            with open(file, encoding="utf-8-sig", errors="surrogateescape") as lines:
                text, folder = lines.read(), os.path.dirname(os.path.realpath(file))
    except OSError as error:
        raise Problem(os_error_text(error), 2) from error
    parsed, errors = [], []
    for number, line in enumerate(text.splitlines(), 1):
        try:
            if words := words_of(line):
                parsed.append((number, parse_line(words, folder)))
        except Problem as problem:
            errors.append((number, str(problem)))
    errors += [(number, f"there is a name={name} in line {first} already") for number, name, first in repeated(parsed)]
    if errors:
        lines = [f"{file}:{number}: {text}" for number, text in sorted(errors)]
        rest = [f"and {len(lines) - SHOWN_ERRORS} more"] if len(lines) > SHOWN_ERRORS else []
        raise Problem("\n  ".join(lines[:SHOWN_ERRORS] + rest), 2)
    if not parsed:
        raise Problem(f"{file}: there is no input in it; expected one a line, see scripts/fleet run --help", 2)
    return with_names(with_recorded_names([given for _, given in parsed], recorded))


def words_of(line):
    """The words of a line, without its comment."""
    if line.lstrip().startswith("#"):
        return []
    lexer = shlex.shlex(line, posix=True, punctuation_chars=False)
    lexer.whitespace_split = True
    lexer.commenters = ""
    words = []
    try:
        for word in lexer:
            if word.startswith("#"):
                break
            words.append(word)
    except ValueError as error:
        raise Problem(f"{error}: quote words with blanks or quotes as in a shell") from error
    return words


def parse_line(words, folder):
    """An Input, whose name is empty where the line has none."""
    device, *rest = words
    given, options = {}, {}
    for word in rest:
        key, is_pair, value = word.partition("=")
        if not is_pair or key not in KEYS:
            hint = "; a path with blanks needs quotes" if not is_pair else ""
            raise Problem(f"'{word}': expected {', '.join(f'{name}=' for name in KEYS)}{hint}")
        if key in given or key in options:
            raise Problem(f"{key}= is given twice")
        if key in PROGRAMS:
            options[key] = words_for(key, value, f"{key}=")
        else:
            given[key] = value
    check_values(given)
    files = {key: absolute(given[key], folder) for key in FILES if given.get(key)}
    return Input(name=given.get("name", ""), device=absolute(device, folder), kind=given.get("kind", ""),
                 words=options, **files)


def check_values(given):
    for key, value in given.items():
        if not value:
            raise Problem(f"{key}= needs a value")
    if "kind" in given and given["kind"] not in KINDS:
        raise Problem(f"kind={given['kind']}: expected one of {', '.join(KINDS)}")
    if "name" in given and not NAME.fullmatch(given["name"]):
        raise Problem(f"name={given['name']}: expected at most 100 letters, digits and _.=-, beginning with a letter, "
                      "a digit or _: it becomes the name of a folder")


def absolute(path, folder):
    return path if ADDRESS.match(path) else os.path.normpath(os.path.join(folder, os.path.expanduser(path)))


def repeated(parsed):
    """(line, name, first line) of names that lines give again."""
    first = {}
    for number, given in parsed:
        if given.name and given.name in first:
            yield number, given.name, first[given.name]
        first.setdefault(given.name, number)


def with_recorded_names(inputs, recorded):
    """Inputs without a name that were recorded before keep the name that they got then."""
    given_names = {given.name for given in inputs}
    names = defaultdict(list)
    for before in recorded:
        if before.name not in given_names:
            names[before.but_for_its_name()].append(before.name)
    return [replace(given, name=names[key].pop(0)) if not given.name and names[key := given.but_for_its_name()] else given
            for given in inputs]


def with_names(inputs):
    """Inputs without a name get that of their file; as many folders before it as tell equal ones apart, and else a
    number."""
    taken = Counter(given.name for given in inputs if given.name)
    unnamed = [given.device for given in inputs if not given.name]
    names = {device: name_of(device, 1) for device in unnamed}
    for depth in range(2, 6):
        counts = Counter(names[device] for device in unnamed)
        for device in unnamed:
            if counts[names[device]] + taken[names[device]] > 1:
                names[device] = name_of(device, depth)
    result = []
    for given in inputs:
        name = given.name or unused(names[given.device], taken)
        taken[name] += not given.name
        result.append(replace(given, name=name))
    return result


def name_of(device, depth):
    """The last `depth` parts of a path, without the ending of the file, as a name."""
    parts = ADDRESS.sub("", device).rstrip("/").split("/")
    text = "_".join(parts[-depth:])
    if not ADDRESS.match(device):
        text = re.sub(r"(?<=.)\.(ply|pcd|las|npy|xyz|pts|txt|asc|csv|lcm|klg|sens|bag|oni)$", "", text, flags=re.I)
    text = re.sub(r"[^A-Za-z0-9_.=-]+", "_", text).lstrip(".=-")
    return text[-100:].lstrip(".=-") or "input"


def unused(name, taken):
    number, found = 1, name
    while taken[found]:
        number += 1
        found = f"{name}-{number}"
    return found
