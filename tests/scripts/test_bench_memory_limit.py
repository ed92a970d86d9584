"""The limit on memory that scripts/bench puts on a command."""

import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "lib"))

from bench.memory_limit import MemoryLimit  # noqa: E402
from trio.messages import Problem  # noqa: E402

USES_200_MB = (sys.executable, "-c", "print(len(bytearray(200_000_000)))")


class Limit(unittest.TestCase):
    def run_with(self, num_bytes):
        try:
            with MemoryLimit(num_bytes) as limit:
                result = subprocess.run(list(map(str, limit.command(*USES_200_MB))), capture_output=True, check=False)
        except Problem as problem:
            self.skipTest(str(problem))
        self.assertFalse(limit.group.exists())
        return result

    def test_a_command_that_needs_more_is_killed(self):
        self.assertNotEqual(self.run_with(50_000_000).returncode, 0)

    def test_one_that_needs_less_is_not(self):
        self.assertEqual(self.run_with(1_000_000_000).stdout, b"200000000\n")


if __name__ == "__main__":
    unittest.main()
