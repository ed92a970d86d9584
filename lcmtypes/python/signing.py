"""Signed messages, for programs in Python that use LCM themselves (kintsugi.connect() signs by itself).

    key = BusKey.read("bus.key")              # made by kintsugi-keygen
    signer, verifier = Signer(key), Verifier(key)
    bus.publish("RGBD_FRAME", signer.sign("RGBD_FRAME", frame.encode()))
    bus.subscribe("CLOUD_SLICE", lambda channel, data: use(verifier.open(channel, data)))

lcmtypes/README.md describes the signature: 40 bytes behind the message. Python's standard library only.
"""

import collections
import hashlib
import hmac
import os
import secrets
import stat
import struct
import threading
import time

KEY_BYTES = 32
TAG_BYTES = 16
MARKER = b"KINTSIG1"
NUMBERS = struct.Struct("<QQ")  # session, sequence
SIGNATURE_BYTES = NUMBERS.size + TAG_BYTES + len(MARKER)
LONGEST_SILENCE_S = 600.0  # after which a sender begins a new session
WINDOW = 65_536  # a message so many numbers behind its sender's newest one is refused
MAX_SESSIONS = 4_096


class Refused(Exception):
    """A message is not signed, forged, or was received before: `reason` is "unsigned", "forged" or "replayed"."""

    def __init__(self, reason, channel):
        super().__init__(f"a message on {channel} is refused: {reason}")
        self.reason = reason


class BusKey:
    """The secret that the programs on one bus share: 32 bytes."""

    def __init__(self, secret):
        if len(secret) != KEY_BYTES:
            raise ValueError(f"a bus key has {KEY_BYTES} bytes, this has {len(secret)}")
        self._secret = bytes(secret)

    @classmethod
    def read(cls, path):
        """Raises OSError when the file cannot be read, ValueError when it is no file, others than its owner may
        use it (expected: mode 0600) or it has another size."""
        # Not blocking: a pipe would wait for a writer.
        with open(path, "rb", opener=lambda name, flags: os.open(name, flags | os.O_NONBLOCK)) as file:
            status = os.fstat(file.fileno())
            if not stat.S_ISREG(status.st_mode):
                raise ValueError(f"bus key '{path}' is no file")
            mode = stat.S_IMODE(status.st_mode)
            if mode & 0o077:
                raise ValueError(f"bus key '{path}' has mode {mode:04o}, so others than its owner may use it; expected "
                                 f"0600: chmod 600 {path}")
            return cls(file.read(KEY_BYTES + 1))

    def tag(self, channel, session, sequence, message):
        """BLAKE2b with this key of marker, session, sequence, channel, a zero byte, message."""
        digest = hashlib.blake2b(MARKER, key=self._secret, digest_size=TAG_BYTES)
        digest.update(NUMBERS.pack(session, sequence))
        digest.update(channel.encode() + b"\0")
        digest.update(message)
        return digest.digest()


class Signer:
    """Signs the messages of one sender. Threads may share it."""

    def __init__(self, key):
        self._key = key
        self._lock = threading.Lock()
        self._session = self._sequence = 0
        self._last_s = 0.0

    def sign(self, channel, message):
        """The message with a signature, for publish()."""
        with self._lock:
            now_s = time.monotonic()
            if not self._sequence or now_s - self._last_s > LONGEST_SILENCE_S:
                self._session = int(time.time()) << 32 | secrets.randbits(32)
                self._sequence = 0
            self._last_s = now_s
            self._sequence += 1
            session, sequence = self._session, self._sequence
        tag = self._key.tag(channel, session, sequence, message)
        return message + NUMBERS.pack(session, sequence) + tag + MARKER


class Verifier:
    """Lets signed messages through, once each. One thread at a time may use it."""

    def __init__(self, key):
        self._key = key
        self._senders = collections.OrderedDict()  # by session, the one that was silent for the longest time first
        self._forgotten_s = 0  # sessions that began up to then may be forgotten

    def open(self, channel, data):
        """The message without its signature. Raises Refused."""
        if len(data) < SIGNATURE_BYTES or data[-len(MARKER):] != MARKER:
            raise Refused("unsigned", channel)
        message, signature = data[:-SIGNATURE_BYTES], data[-SIGNATURE_BYTES:]
        session, sequence = NUMBERS.unpack_from(signature)
        tag = signature[NUMBERS.size:NUMBERS.size + TAG_BYTES]
        if not hmac.compare_digest(tag, self._key.tag(channel, session, sequence, message)):
            raise Refused("forged", channel)
        if not self._take(session, sequence):
            raise Refused("replayed", channel)
        return message

    def _take(self, session, sequence):
        sender = self._senders.get(session)
        if sender is None:
            if session >> 32 <= self._forgotten_s:
                return False
            sender = self._senders[session] = _Received()
        if not sender.take(sequence):
            return False
        self._senders.move_to_end(session)
        if len(self._senders) > MAX_SESSIONS:
            forgotten, _ = self._senders.popitem(last=False)
            self._forgotten_s = max(self._forgotten_s, forgotten >> 32)
        return True


class _Received:
    """The numbers of one sender that were received: a bit for each of the last WINDOW ones."""

    def __init__(self):
        self._newest = 0
        self._bits = 0  # bit i: newest - i was received

    def take(self, sequence):
        """Returns False when it was received before, or is too old to know."""
        ahead = sequence - self._newest
        if ahead > 0:
            self._bits = (self._bits << ahead | 1) & _ALL if ahead < WINDOW else 1
            self._newest = sequence
            return True
        bit = 1 << -ahead
        if sequence < 1 or -ahead >= WINDOW or self._bits & bit:
            return False
        self._bits |= bit
        return True


_ALL = (1 << WINDOW) - 1
