"""What a person reads, and the errors that end a run with a message instead of a traceback."""

import os
import sys

STDOUT = 1
STDERR = 2


class Problem(Exception):
    """A foreseeable error: its text is shown to the person, its code is the exit code."""

    def __init__(self, text, exit_code=1):
        super().__init__(text)
        self.exit_code = exit_code


def command_name():
    return os.path.basename(sys.argv[0])


def say(text):
    """A message on standard error."""
    write(STDERR, f"{command_name()}: {text}\n")


def write(descriptor, text):
    """Without a buffer, so that nothing is left to be written (and to fail) at exit. A terminal that
    was closed, or a full disk behind a redirection, must not end a run."""
    try:
        os.write(descriptor, text.encode(errors="surrogateescape"))
    except OSError:
        pass


def os_error_text(error):
    """An OSError as "FILE: REASON"."""
    reason = error.strerror or str(error)
    return f"{error.filename}: {reason}" if error.filename else reason
