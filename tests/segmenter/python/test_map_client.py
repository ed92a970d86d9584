"""kintsugi.MapClient of a log, from Python."""

import os
import struct
import tempfile
import threading
import unittest
import zlib

import kintsugi
import kintsugi.lcm
from kintsugi.lcm import layout


def update(name):
    """An update of a map without segments; the message has a name in bytes, which lcm-gen's classes have not."""
    message = kintsugi.lcm.segment_update_t()
    message.session = message.map_session = message.num_chunks = message.num_slices = 1
    message.records_version = layout.RECORDS_VERSION
    message.data, message.map_name = b"", "@" * len(name)
    data = bytearray(message.encode().replace(message.map_name.encode(), name))
    data[8:12] = struct.pack(">I", zlib.crc32(data))  # it was 0
    return bytes(data)


class MapClientTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.file = os.path.join(temporary.name, "run.lcm")

    def write(self, *events):
        with open(self.file, "wb") as file:
            for number, (channel, data) in enumerate(events):
                header = struct.pack(">IqqII", 0xEDA1DA01, number, number, len(channel), len(data))
                file.write(header + channel.encode() + data)

    def test_a_name_that_is_no_utf_8_can_be_read(self):
        name = b"map" + bytes([0xFF])
        self.write(("SEGMENT_UPDATE", update(name)))
        client = kintsugi.read_log(self.file)
        self.assertEqual(client.newest_update.map_name, "map\ufffd")
        self.assertEqual(client.problem, "")

    def test_other_threads_go_on_while_a_log_is_verified(self):
        key = self.file + ".key"
        with open(key, "wb") as file:
            file.write(bytes(32))
        os.chmod(key, 0o600)
        num_bytes = 1 << 24
        with open(self.file, "wb") as file:  # 512 MB of zeros, which take no room
            for number in range(32):
                file.write(struct.pack(">IqqII", 0xEDA1DA01, number, number, 1, num_bytes) + b"X")
                file.seek(num_bytes, os.SEEK_CUR)
            file.truncate()
        ticks = []
        stop = threading.Event()
        ticking = threading.Thread(target=lambda: [ticks.append(1) for _ in iter(lambda: stop.wait(0.001), True)])
        ticking.start()
        num_before = len(ticks)
        with self.assertRaisesRegex(RuntimeError, "32 are not signed"):
            kintsugi.open_log(self.file, bus_key=key)
        num_after = len(ticks)
        stop.set()
        ticking.join()
        self.assertGreater(num_after - num_before, 10)


if __name__ == "__main__":
    unittest.main()
