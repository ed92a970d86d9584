"""The name of the map of a run: of all runs on a bus, each needs its own."""

from .messages import Problem
from .status import Status

OTHER_MAPPER_S = 1  # a mapper sends three statuses a second
DEFAULT_MAP_NAME = "map"


def given_map_name(words):
    """The value of --map-name among the options of a process; None without."""
    for place, word in enumerate(words):
        flag, equals, value = word.partition("=")
        if flag == "--map-name":
            return value if equals else "".join(words[place + 1:place + 2])
    return None


def map_name(choice):
    """The name of the map; None: of any, because the mapper is elsewhere and no name is given."""
    if choice.map_name or "mapper" not in choice.only:
        return choice.map_name
    return given_map_name(choice.mapper) or DEFAULT_MAP_NAME


def map_option(name, words):
    """For a process with the options `words`."""
    return [f"--map-name={name}"] if name and given_map_name(words) is None else []


def refuse_second_mapper(choice):
    """Raises Problem if a mapper with this map name is at work: the segmenters and viewers of both runs would follow
    the newer one. The mapper itself refuses, too; but by then the folder of the run is changed."""
    if Status.hears_mapper_of(map_name(choice), OTHER_MAPPER_S):
        raise Problem(f"another mapper makes a map called '{map_name(choice)}' on this bus. Wait for its end, or run "
                      "beside it with another --map-name, on another bus (LCM_DEFAULT_URL), or with --private")
