"""From LCM messages to complete segment_update_t: events of a log, checksums, chunks.

Needs the modules that the build writes into share/python: `kintsugi`, the message types that lcm-gen
generates, and `kintsugi_layout`, the packed records. Apart from these only the standard library.
"""

import os
import struct
import zlib
from collections import namedtuple

CHANNEL = "SEGMENT_UPDATE"
HEARTBEAT = "HEARTBEAT"
CREATED, GROWN, MERGED, SPLIT, RETIRED = range(5)

# Records in the payload of an update; kintsugi_segment_update_t.lcm describes them.
LABEL_BYTES, RUN_BYTES = 4, 20
EVENT = struct.Struct("<III")
Event = namedtuple("Event", "type segment_id other_id")


class BadMessage(Exception):
    """A message that cannot be used."""


class StatisticsRecord:
    """Reads the packed statistics of segments: metres, frame W.

    `layout` is the generated module kintsugi_layout. A record becomes a namedtuple with its fields;
    a vector is a tuple of numbers.
    """

    def __init__(self, layout):
        self.format = struct.Struct(layout.STATISTICS_FORMAT)
        self.lengths = [length for _, length in layout.STATISTICS_FIELDS]
        self.type = namedtuple("Statistics", [name for name, _ in layout.STATISTICS_FIELDS])

    def read_all(self, data):
        return [self.read(values) for values in self.format.iter_unpack(data)]

    def read(self, values):
        fields, place = [], 0
        for length in self.lengths:
            fields.append(values[place:place + length] if length else values[place])
            place += max(1, length)
        return self.type(*fields)


class Update:
    """A complete update: header (the fields of its first chunk), events, statistics."""

    def __init__(self, header, payload, record):
        self.header = header
        self.sequence = header.sequence
        place = header.num_labels * LABEL_BYTES + header.num_runs * RUN_BYTES
        end = place + header.num_events * EVENT.size
        self.events = [Event(*values) for values in EVENT.iter_unpack(payload[place:end])]
        self.statistics = record.read_all(payload[end:])
        for event in self.events:
            if event.type > RETIRED:
                raise BadMessage("segment_update_t: event type is %d" % event.type)

    def lists_all(self):
        """True if it has statistics of every segment of the map, as the last update of a full state."""
        return len(self.statistics) == self.header.num_segments


class LogReader:
    """Iterates over the channel and data of each event in an LCM log, up to its first damage."""

    HEADER = struct.Struct(">IqqII")  # sync word, number, time, bytes of the channel, of the data
    SYNC_WORD = 0xEDA1DA01
    MAX_CHANNEL_BYTES = 63  # of LCM

    def __init__(self, path):
        self.path = path
        self.damage = ""  # after the iteration: where and how it is damaged; empty: it is not

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
    """Behind LCM's fingerprint of 8 bytes, every message has the CRC-32 (as zlib computes it) of its
    bytes, computed with that field 0. Raises BadMessage."""
    if len(data) < 12:
        raise BadMessage("a message of %d bytes" % len(data))
    claimed = int.from_bytes(data[8:12], "big")
    computed = zlib.crc32(data[12:], zlib.crc32(data[:8] + bytes(4)))
    if claimed != computed:
        raise BadMessage("checksum is %d, expected %d" % (claimed, computed))


def decode(message_type, data):
    """Raises BadMessage."""
    if data[:8] != message_type._get_packed_fingerprint():  # depends on the fields of the type
        raise BadMessage("%s: the fingerprint is that of another type, or the message was sent or "
                         "recorded by another version of Kintsugi" % message_type.__name__)
    check_checksum(data)
    try:
        return message_type.decode(data)
    except (ValueError, struct.error) as error:
        raise BadMessage("no %s: %s" % (message_type.__name__, error)) from error


class Assembler:
    """Joins the chunks of updates, which may arrive in any order and repeatedly."""

    OF_CHUNK = {"checksum", "sequence", "chunk_index", "first_byte", "num_bytes", "data"}

    def __init__(self, types, layout):
        self.types = types    # the module that lcm-gen generates
        self.layout = layout  # the module kintsugi_layout
        self.record = StatisticsRecord(layout)
        self.pending = {}     # (session, number of the first chunk) -> {index: chunk}
        self.seen = {}        # session -> numbers of the received chunks
        self.ranges = {}      # session -> (the first that is needed, one past the newest)

    def handle(self, channel, data):
        """Returns the update that this message completes; None: it completes none. Raises BadMessage."""
        if channel == HEARTBEAT:
            beat = decode(self.types.heartbeat_t, data)
            if beat.channel == CHANNEL:
                self.note(beat.session, beat.state_sequence, beat.next_sequence)
        elif channel == CHANNEL:
            return self.add(decode(self.types.segment_update_t, data))
        return None

    def add(self, chunk):
        if chunk.records_version != self.layout.RECORDS_VERSION:
            raise BadMessage("segment_update_t has records of version %d, this program knows version %d: "
                             "it was sent or recorded by another version of Kintsugi"
                             % (chunk.records_version, self.layout.RECORDS_VERSION))
        seen = self.seen.setdefault(chunk.session, set())
        self.note(chunk.session, 0, chunk.sequence + 1)
        if chunk.sequence in seen:
            return None
        chunks = self.pending.setdefault((chunk.session, chunk.sequence - chunk.chunk_index), {})
        if any(self.header(other) != self.header(chunk) for other in chunks.values()):
            raise BadMessage("chunk %d has another header than other chunks of its update" % chunk.sequence)
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
                    first.num_events * EVENT.size + first.num_statistics * self.record.format.size)
        if len(payload) != expected:
            raise BadMessage("an update of %d bytes, expected %d" % (len(payload), expected))
        return Update(first, payload, self.record)

    def header(self, chunk):
        return [getattr(chunk, name) for name in chunk.__slots__ if name not in self.OF_CHUNK]

    def note(self, session, first, end):
        known = self.ranges.get(session, (0, 0))
        self.ranges[session] = (max(known[0], first), max(known[1], end))

    def num_missing(self, session, since):
        """Number of missing chunks among those numbered from `since` on."""
        first, end = self.ranges[session]
        first = max(first, since)
        return max(0, end - first) - sum(1 for number in self.seen[session] if number >= first)
