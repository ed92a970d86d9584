"""The log of the bus, which lcm-logger writes: it appends, and syncs what it has written every 0.1 s. What it has missed
kintsugi-complete-log requests."""

import os
import struct

from .durable import sync_file, sync_folder

# As lcmtypes/log/log_format.hpp describes it: sync word, number, time, bytes of the channel and of the data.
HEADER = struct.Struct(">4sqqII")
SYNC_WORD = b"\xed\xa1\xda\x01"
MAX_CHANNEL_BYTES = 63


def begins_as_log(path):
    """Whether the file begins with an event of a log. Raises OSError if it cannot be read."""
    with open(path, "rb") as file:
        return file.read(len(SYNC_WORD)) == SYNC_WORD


class Recording:
    """`file`, and the name that it has until it is complete, `partial`. With `durable` a power cut takes no more of it
    than what lcm-logger had not synced."""

    def __init__(self, folder, durable=False):
        self.file = folder / "run.lcm"
        self.partial = folder / "run.lcm.partial"
        self.durable = durable

    def begin(self):
        """Before lcm-logger is started. A run that is resumed goes on with its recording, which has got its name if
        only another process failed. What an earlier logger has left half written is cut off: behind it nothing could
        be read."""
        if self.file.exists() and not self.partial.exists():
            self.file.rename(self.partial)
        if self.partial.exists():
            cut_after_last_event(self.partial)
        if self.durable:
            self.partial.touch()
            sync_folder(self.partial.parent)

    def end(self):
        if self.durable:
            sync_file(self.partial)
        os.replace(self.partial, self.file)
        if self.durable:
            sync_folder(self.file.parent)


def cut_after_last_event(path):
    """Shortens a log to its whole events. A damaged text of an event is not seen: messages have checksums."""
    with open(path, "r+b") as log:
        size = os.fstat(log.fileno()).st_size
        end = 0
        while end + HEADER.size <= size:
            log.seek(end)
            word, _, _, channel_bytes, data_bytes = HEADER.unpack(log.read(HEADER.size))
            next_end = end + HEADER.size + channel_bytes + data_bytes
            if word != SYNC_WORD or not 0 < channel_bytes <= MAX_CHANNEL_BYTES or next_end > size:
                break
            end = next_end
        if end < size:
            log.truncate(end)
