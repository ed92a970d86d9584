"""The name of the map of a run: of all runs on a bus, each needs its own."""

from .messages import Problem
from .process_options import value_of
from .status import Status

OTHER_MAPPER_S = 1  # a mapper sends three statuses a second
DEFAULT_MAP_NAME = "map"


def map_name(choice):
    """The name of the map; None: of any, because the mapper is elsewhere and no name is given."""
    if choice.map_name or "mapper" not in choice.only:
        return choice.map_name
    return value_of("--map-name", choice.mapper) or DEFAULT_MAP_NAME


def map_option(name, words):
    """For a process with the options `words`."""
    return [f"--map-name={name}"] if name and value_of("--map-name", words) is None else []


def refuse_second_mapper(choice):
    """Raises Problem if a mapper with this map name is at work: the segmenters and viewers of both runs would follow
    the newer one. The mapper itself refuses, too; but by then the folder of the run is changed."""
    if Status.hears_mapper_of(map_name(choice), OTHER_MAPPER_S):
        raise Problem(f"another mapper makes a map called '{map_name(choice)}' on this bus. Wait for its end, or run "
                      "beside it with another --map-name, on another bus (LCM_DEFAULT_URL), or with --private")
