"""The options of one process: those that scripts/trio sets, those that its own flags pass on, and those in
--mapper '...' and the like. Of an option given twice the last one counts."""

from .messages import Problem
from .programs import called

# Without these a run would not be watched, stopped, resumed or summed up any more.
KEPT_BY_RUN = {
    "segmenter": {"--out": "--out of {command} chooses the folder of the run"},
    "viewer": {"--out": "--out of {command} chooses the folder of the run"},
    "detector": {"--library": "--objects of {command} chooses the library"},
}
# scripts/replay saves and resumes nothing.
KEPT_BY_TRIO = {
    "mapper": {"--store": "the log is mapper.lcm in the folder of the run; --out chooses the folder",
               "--resume": "scripts/trio --resume continues the run in --out"},
    "segmenter": {"--save": "the map is saved as segmenter.map in the folder of the run; --out chooses the folder",
                  "--resume": "the map is resumed from segmenter.map in the folder of the run"},
}
ENDS_AT_ONCE = ("-h", "--help", "--version", "--print-config", "--list-devices", "--check")


class ProcessOptions:
    """Options in the order in which they were given, each with its values."""

    def __init__(self, name):
        self.name = name
        self._options = []  # (flag, its words); flag None: words before the first flag

    def replace(self, flag, words):
        """An option that replaces what was given of it before; no words: the process's own default."""
        self._options = [option for option in self._options if option[0] != flag]
        if words:
            self._options.append((flag, words))

    def add(self, words):
        """Words as on the command line of the process. Its options replace those given before."""
        added = []
        for word in words:
            if is_flag(word):
                added.append((word.partition("=")[0], [word]))
            elif added:
                added[-1][1].append(word)
            else:
                added.append((None, [word]))
        flags = {flag for flag, _ in added} - {None}
        self._options = [option for option in self._options if option[0] not in flags] + added

    def check(self, command, kept=None, where=None):
        """Raises Problem for an option that belongs to `command`, or that lets the process end at once.

        `kept`: options of the command, with the reason (None: those of scripts/trio and scripts/replay); `where`:
        what the options were given by (None: the flag with the name of the process)."""
        kept = kept_by(command, self.name) if kept is None else kept
        for flag, words in self._options:
            option = f"{where or '--' + self.name} '{' '.join(words)}'"
            if flag in kept:
                raise Problem(f"{option}: {command} sets {flag} itself: {kept[flag].format(command=command)}", 2)
            if flag in ENDS_AT_ONCE:
                raise Problem(f"{option}: {called(self.name)} only prints and ends with {flag}; run it by itself", 2)

    def words(self):
        return [word for _, words in self._options for word in words]


def kept_by(command, name):
    """The options of a process that scripts/trio or scripts/replay sets itself, with the reason."""
    of_trio = KEPT_BY_TRIO.get(name, {}) if command == "scripts/trio" else {}
    return {**KEPT_BY_RUN.get(name, {}), **of_trio}


def is_flag(word):
    return word.startswith("--") or word == "-h"


def value_of(flag, words):
    """The value of an option among the words of a process; None without."""
    for place, word in enumerate(words):
        name, equals, value = word.partition("=")
        if name == flag:
            return value if equals else "".join(words[place + 1:place + 2])
    return None


def without(flags, words):
    """The words of a process without these options and their values."""
    options = ProcessOptions(None)
    options.add(words)
    for flag in flags:
        options.replace(flag, [])
    return options.words()


def with_given(own, given):
    """The words of a command line: `own`, each FLAG or FLAG=VALUE, without those that are given, then `given`."""
    flags = {word.partition("=")[0] for word in given if is_flag(word)}
    return [word for word in own if word.partition("=")[0] not in flags] + list(given)
