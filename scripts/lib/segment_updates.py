"""From LCM messages to whole segment_update_t: events of a log, checksums, chunks.

Needs the types that lcm-gen makes for Python, and nothing else beyond the standard library.
"""

import os
import struct
import zlib
from collections import namedtuple

CHANNEL = "SEGMENT_UPDATE"
HEARTBEAT = "HEARTBEAT"
CREATED, GROWN, MERGED, SPLIT, RETIRED = range(5)

# The records in the payload of an update; kintsugi_segment_update_t.lcm says what they are.
LABEL_BYTES, RUN_BYTES = 4, 20
EVENT = struct.Struct("<III")
STATISTICS = struct.Struct("<II12f3Bxfii")
Event = namedtuple("Event", "type segment_id other_id")


class BadMessage(Exception):
    """A message that cannot be used."""


class Statistics:
    """What is known of one segment: metres, frame W."""

    def __init__(self, values):
        self.id, self.points = values[:2]
        self.box_min, self.box_max, self.centroid, self.mean_normal = (
            values[i:i + 3] for i in range(2, 14, 3))
        self.mean_color = values[14:17]
        self.area, self.first_slice, self.last_slice = values[17:]


class Update:
    """A whole update: header (the fields of its first chunk), events, statistics."""

    def __init__(self, header, payload):
        self.header = header
        self.sequence = header.sequence
        place = header.num_labels * LABEL_BYTES + header.num_runs * RUN_BYTES
        end = place + header.num_events * EVENT.size
        self.events = [Event(*values) for values in EVENT.iter_unpack(payload[place:end])]
        self.statistics = [Statistics(values) for values in STATISTICS.iter_unpack(payload[end:])]
        for event in self.events:
            if event.type > RETIRED:
                raise BadMessage("segment_update_t: event type is %d" % event.type)

    def lists_all(self):
        """The last update of a full state does, and any other that changed every segment."""
        return len(self.statistics) == self.header.num_segments


class LogReader:
    """Channel and data of each event in an LCM log, as far as it can be read."""

    HEADER = struct.Struct(">IqqII")  # sync word, number, time, bytes of the channel, of the data
    SYNC_WORD = 0xEDA1DA01
    MAX_CHANNEL_BYTES = 63  # of LCM

    def __init__(self, path):
        self.path = path
        self.damage = ""  # after the last event: where and how it is damaged; empty: it is whole

    def __iter__(self):
        with open(self.path, "rb") as file:
            size = os.fstat(file.fileno()).st_size
            place = 0
            while place < size or size == 0:
                problem, length = "cut off in an event's header", 0
                head = file.read(self.HEADER.size)
                if len(head) == self.HEADER.size:
                    sync_word, _, _, channel_bytes, data_bytes = self.HEADER.unpack(head)
                    length = self.HEADER.size + channel_bytes + data_bytes
                    problem = self.problem(sync_word, channel_bytes, size - place - length)
                if problem:
                    self.damage = "log '%s' is damaged at byte %d of %d: %s" % (
                        self.path, place, size, problem)
                    return
                channel = file.read(channel_bytes).decode("utf-8", "replace")
                yield channel, file.read(data_bytes)
                place += length

    def problem(self, sync_word, channel_bytes, bytes_left):
        if sync_word != self.SYNC_WORD:
            return "expected the sync word of an event"
        if not 1 <= channel_bytes <= self.MAX_CHANNEL_BYTES:
            return "an event with a channel of %d bytes" % channel_bytes
        if bytes_left < 0:
            return "the event lacks its last %d bytes" % -bytes_left
        return ""


def check_checksum(data):
    """Every message carries, behind LCM's fingerprint of 8 bytes, the CRC-32 (zlib's) of itself,
    computed with that field 0."""
    if len(data) < 12:
        raise BadMessage("a message of %d bytes" % len(data))
    claimed = int.from_bytes(data[8:12], "big")
    computed = zlib.crc32(data[12:], zlib.crc32(data[:8] + bytes(4)))
    if claimed != computed:
        raise BadMessage("checksum is %d, expected %d" % (claimed, computed))


def decode(message_type, data):
    """Raises BadMessage."""
    check_checksum(data)
    try:
        return message_type.decode(data)
    except (ValueError, struct.error) as error:
        raise BadMessage("no %s: %s" % (message_type.__name__, error)) from error


class Assembler:
    """Puts the chunks of updates together, whatever their order and however often they come."""

    OF_CHUNK = {"checksum", "sequence", "chunk_index", "first_byte", "num_bytes", "data"}

    def __init__(self, types):
        self.types = types  # the module that lcm-gen has made
        self.pending = {}   # (session, number of the first chunk) -> {index: chunk}
        self.seen = {}      # session -> numbers of the chunks that came
        self.ranges = {}    # session -> (the first that is not superseded, one past the newest)

    def handle(self, channel, data):
        """The update that this message completes; None: it completes none. Raises BadMessage."""
        if channel == HEARTBEAT:
            beat = decode(self.types.heartbeat_t, data)
            if beat.channel == CHANNEL:
                self.note(beat.session, beat.state_sequence, beat.next_sequence)
        elif channel == CHANNEL:
            return self.add(decode(self.types.segment_update_t, data))
        return None

    def add(self, chunk):
        seen = self.seen.setdefault(chunk.session, set())
        self.note(chunk.session, 0, chunk.sequence + 1)
        if chunk.sequence in seen:
            return None
        chunks = self.pending.setdefault((chunk.session, chunk.sequence - chunk.chunk_index), {})
        if any(self.header(other) != self.header(chunk) for other in chunks.values()):
            raise BadMessage("chunk %d is of another update than those beside it" % chunk.sequence)
        seen.add(chunk.sequence)
        chunks[chunk.chunk_index] = chunk
        if len(chunks) < chunk.num_chunks:
            return None
        del self.pending[(chunk.session, chunk.sequence - chunk.chunk_index)]
        return self.join([chunks[index] for index in sorted(chunks)])

    def join(self, chunks):
        first = chunks[0]
        payload = b"".join(bytes(chunk.data) for chunk in chunks)
        expected = (first.num_labels * LABEL_BYTES + first.num_runs * RUN_BYTES +
                    first.num_events * EVENT.size + first.num_statistics * STATISTICS.size)
        if len(payload) != expected:
            raise BadMessage("an update of %d bytes, expected %d" % (len(payload), expected))
        return Update(first, payload)

    def header(self, chunk):
        return [getattr(chunk, name) for name in chunk.__slots__ if name not in self.OF_CHUNK]

    def note(self, session, first, end):
        known = self.ranges.get(session, (0, 0))
        self.ranges[session] = (max(known[0], first), max(known[1], end))

    def num_missing(self, session, since):
        """Chunks that exist and have not come, of those numbered from `since` on."""
        first, end = self.ranges[session]
        first = max(first, since)
        return max(0, end - first) - sum(1 for number in self.seen[session] if number >= first)
