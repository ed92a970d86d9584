"""kintsugi.lcm.signing: signs as the C++ programs do, and verifies."""

import os
import random
import struct
import subprocess
import tempfile
import unittest
from unittest import mock

import kintsugi
import kintsugi.lcm
from kintsugi.lcm import signing
from kintsugi.lcm.signing import BusKey, Refused, Signer, Verifier

KEY = BusKey(bytes(range(32)))
BIN = os.environ["KINTSUGI_BIN"]


def session_of(second, number=0):
    return second << 32 | number


def signed(channel, session, sequence, message, key=KEY):
    return message + signing.NUMBERS.pack(session, sequence) + key.tag(channel, session, sequence, message) + signing.MARKER


def event(number, channel, data):
    """An event of an LCM log."""
    return struct.pack(">IqqII", 0xEDA1DA01, number, number, len(channel), len(data)) + channel.encode() + data


class SigningTest(unittest.TestCase):
    def refusal(self, verifier, channel, data):
        with self.assertRaises(Refused) as refused:
            verifier.open(channel, data)
        return refused.exception.reason

    # The same values stand in tests/lcmtypes/signing/test_signed_message.cpp.
    def test_the_tag_is_that_of_the_other_programs(self):
        self.assertEqual(KEY.tag("CLOUD_SLICE", 0x0102030405060708, 42, b"kintsugi").hex(),
                         "609da71e9333e098d901a7eeabde0414")
        self.assertEqual(KEY.tag("X", 1 << 63, 1, b"").hex(), "790720c55ebf530194b073db48f0dda2")

    def test_a_signed_message_is_let_through_once(self):
        signer, verifier = Signer(KEY), Verifier(KEY)
        data = signer.sign("X", b"abc")
        self.assertEqual(len(data), 3 + signing.SIGNATURE_BYTES)
        self.assertEqual(verifier.open("X", data), b"abc")
        self.assertEqual(self.refusal(verifier, "X", data), "replayed")
        self.assertEqual(verifier.open("X", signer.sign("X", b"")), b"")
        self.assertEqual(verifier.open("X", Signer(KEY).sign("X", b"abc")), b"abc")

    def test_every_changed_byte_is_refused(self):
        data = Signer(KEY).sign("X", b"abc")
        verifier = Verifier(KEY)
        for place in range(len(data)):
            changed = bytearray(data)
            changed[place] ^= 1
            self.assertIn(self.refusal(verifier, "X", bytes(changed)), ("forged", "unsigned"))
            self.assertIn(self.refusal(verifier, "X", data[:place]), ("forged", "unsigned"))
        self.assertEqual(self.refusal(verifier, "Y", data), "forged")
        self.assertEqual(self.refusal(Verifier(BusKey(bytes(32))), "X", data), "forged")
        self.assertEqual(self.refusal(verifier, "X", b"abc"), "unsigned")
        self.assertEqual(verifier.open("X", data), b"abc")

    def test_disorder_loses_nothing_and_repeats_nothing(self):
        numbers = list(range(1, 3001))
        random.Random(1).shuffle(numbers)
        verifier = Verifier(KEY)
        for number in numbers:
            self.assertEqual(verifier.open("X", signed("X", session_of(5), number, b"a")), b"a")
        for number in numbers:
            self.assertEqual(self.refusal(verifier, "X", signed("X", session_of(5), number, b"a")), "replayed")

    def test_what_is_too_old_to_know_is_refused(self):
        verifier = Verifier(KEY)
        newest = signing.WINDOW + 10
        verifier.open("X", signed("X", session_of(5), newest, b"a"))
        self.assertEqual(self.refusal(verifier, "X", signed("X", session_of(5), 10, b"a")), "replayed")
        self.assertEqual(verifier.open("X", signed("X", session_of(5), 11, b"a")), b"a")
        self.assertEqual(self.refusal(verifier, "X", signed("X", session_of(5), 0, b"a")), "replayed")
        verifier.open("X", signed("X", session_of(5), 3 * signing.WINDOW, b"a"))
        self.assertEqual(self.refusal(verifier, "X", signed("X", session_of(5), newest, b"a")), "replayed")

    def test_a_sender_that_was_forgotten_is_refused(self):
        with mock.patch.object(signing, "MAX_SESSIONS", 2):
            verifier = Verifier(KEY)
            for second in (7, 5, 6):
                verifier.open("X", signed("X", session_of(second), 1, b"a"))
            for number in (1, 2):
                self.assertEqual(self.refusal(verifier, "X", signed("X", session_of(7), number, b"a")), "replayed")
            verifier.open("X", signed("X", session_of(8), 1, b"a"))

    def test_a_long_silence_begins_a_new_session(self):
        signer = Signer(KEY)
        sessions = []
        for now_s in (1000.0, 1600.0, 2201.0):
            with mock.patch.object(signing.time, "monotonic", return_value=now_s):
                sessions.append(signer.sign("X", b"")[:8])
        self.assertEqual(sessions[0], sessions[1])
        self.assertNotEqual(sessions[1], sessions[2])

    def test_decoders_of_lcm_ignore_the_signature(self):
        heartbeat = kintsugi.lcm.heartbeat_t()
        heartbeat.channel, heartbeat.session, heartbeat.next_sequence, heartbeat.map_name = "X", 7, 9, "map"
        decoded = kintsugi.lcm.heartbeat_t.decode(Signer(KEY).sign("HEARTBEAT", heartbeat.encode()))
        self.assertEqual((decoded.channel, decoded.session, decoded.next_sequence, decoded.map_name), ("X", 7, 9, "map"))


class KeyFileTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name
        self.file = os.path.join(self.folder, "bus.key")

    def test_the_key_of_keygen_is_read(self):
        subprocess.run([os.path.join(BIN, "kintsugi-keygen"), self.file], check=True, stdout=subprocess.DEVNULL)
        with open(self.file, "rb") as file:
            secret = file.read()
        self.assertEqual(BusKey.read(self.file).tag("X", 1, 1, b""), BusKey(secret).tag("X", 1, 1, b""))

    def test_files_of_others_and_of_another_size_are_refused(self):
        for size, mode, reason in ((32, 0o640, "mode 0640"), (32, 0o606, "mode 0606"), (31, 0o600, "has 31"),
                                   (33, 0o600, "has 33")):
            with open(self.file, "wb") as file:
                file.write(b"k" * size)
            os.chmod(self.file, mode)
            for read in (BusKey.read, lambda path: kintsugi.connect(bus_key=path)):
                with self.assertRaisesRegex((ValueError, RuntimeError), reason):
                    read(self.file)
        with self.assertRaises(OSError):
            BusKey.read(self.file + ".none")
        os.mkfifo(self.file + ".pipe", 0o600)
        with self.assertRaisesRegex(ValueError, "is no file"):
            BusKey.read(self.file + ".pipe")

    def test_a_log_that_python_signed_is_read_with_its_key(self):
        with open(self.file, "wb") as file:
            file.write(bytes(range(32)))
        os.chmod(self.file, 0o600)
        heartbeat = kintsugi.lcm.heartbeat_t()
        signer = Signer(KEY)
        log = os.path.join(self.folder, "run.lcm")
        with open(log, "wb") as file:
            for number in range(3):
                file.write(event(number, "HEARTBEAT", signer.sign("HEARTBEAT", heartbeat.encode())))
        self.assertEqual(kintsugi.read_log(log, bus_key=self.file).damage, "")
        self.assertEqual(kintsugi.read_log(log, trust_log=True).damage, "")
        with self.assertRaisesRegex(RuntimeError, "is signed: give the key"):
            kintsugi.read_log(log)
        with open(self.file, "wb") as file:
            file.write(bytes(32))
        with self.assertRaisesRegex(RuntimeError, "0 are not signed, 3 are signed otherwise"):
            kintsugi.read_log(log, bus_key=self.file)


if __name__ == "__main__":
    unittest.main()
