"""The cases of the battery: rooms x sensors x colour or not x speeds x rates."""

import itertools
from dataclasses import dataclass

from trio.messages import Problem

from .run import Input

ROOMS = ("office", "hall", "hallway", "kitchen")
SENSORS = ("kinect1", "kinect2", "d435", "lidar", "clean")
SPEEDS = ("1", "2", "0.5")  # times that of the room's path
RATES_HZ = (30, 15)
HARDER_SENSORS = ("kinect1", "d435")  # whose default cases include speed 2 and 15 Hz


@dataclass(frozen=True)
class Case:
    room: str
    sensor: str
    has_color: bool = True
    speed: str = "1"
    rate_hz: int = 30

    @property
    def words(self):
        """One of each kind, as --cases takes them."""
        return [self.room, self.sensor, "color" if self.has_color else "depth", f"speed{self.speed}",
                f"{self.rate_hz}hz"]

    @property
    def source(self):
        options = [f"sensor={self.sensor}", f"speed={self.speed}", f"rate={self.rate_hz}"]
        if not self.has_color:
            options.append("color=off")
        return Input("_".join(self.words), address=f"synthetic://{self.room}?{'&'.join(options)}")

    @property
    def row(self):
        return self.room, self.sensor

    @property
    def column(self):
        """For people: only what is not usual."""
        return ", ".join(["colour" if self.has_color else "depth alone",
                          *([f"speed {self.speed}"] if self.speed != "1" else []),
                          *([f"{self.rate_hz} Hz"] if self.rate_hz != 30 else [])])


def all_cases():
    return [Case(*values) for values in itertools.product(ROOMS, SENSORS, (True, False), SPEEDS, RATES_HZ)]


def is_default(case):
    """Every sensor in every room; a faster walk, or fewer frames, with the sensors to which they matter most."""
    changes = [case.speed == "2", case.rate_hz == 15]
    return case.speed != "0.5" and (not any(changes) or (sum(changes) == 1 and case.sensor in HARDER_SENSORS))


def chosen_cases(text):
    """None: the default ones; `all`; or words separated by commas, all of which a case must have."""
    if text is None:
        return [case for case in all_cases() if is_default(case)]
    if text == "all":
        return all_cases()
    known = dict.fromkeys(word for kind in zip(*(case.words for case in all_cases()), strict=True) for word in kind)
    for word in text.split(","):
        if word not in known:
            raise Problem(f"--cases: no case has the word '{word}'; there are: {' '.join(known)}", exit_code=2)
    chosen = [case for case in all_cases() if set(text.split(",")).issubset(case.words)]
    if not chosen:
        raise Problem(f"--cases: no case has all of these words: {text}", exit_code=2)
    return chosen


def rows_and_columns(cases):
    """Of a table with these cases, in the order of all_cases()."""
    columns = {case.column: None for case in all_cases()}
    used = {case.column for case in cases}
    return list(dict.fromkeys(case.row for case in cases)), [column for column in columns if column in used]
