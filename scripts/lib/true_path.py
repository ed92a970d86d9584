"""Times in the file of a camera's true path (TUM format)."""

import re
from statistics import median

FRAMES_A_SECOND = 30  # of a recording whose times are numbers of frames (ICL-NUIM)
MAX_STEP = 10  # from one of these numbers to the next


def microseconds(seconds):
    """Of a time in decimal seconds, exactly."""
    whole, _, decimals = seconds.partition(".")
    return int(whole) * 1_000_000 + int(f"{decimals:0<6}"[:6])


def in_seconds(truth, converted):
    """The true path with times in seconds: the given file or, if its times are numbers of frames (ICL-NUIM), a
    converted copy. The rule is the mapper's (frame_numbers.hpp): whole numbers in small steps."""
    lines = [line.split() for line in truth.read_text().splitlines() if line.strip() and not line.startswith("#")]
    if not all(re.fullmatch(r"\d+(\.0*)?", words[0]) for words in lines):
        return truth
    numbers = [int(float(words[0])) for words in lines]
    steps = [after - before for before, after in zip(numbers, numbers[1:])]
    if not steps or median(steps) > MAX_STEP:
        return truth
    converted.write_text("".join(f"{number / FRAMES_A_SECOND:.6f} {' '.join(words[1:])}\n"
                                 for number, words in zip(numbers, lines, strict=True)))
    return converted
