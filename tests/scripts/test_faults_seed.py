"""scripts/faults: the seed fixes the moments of kills and power cuts."""

import subprocess
import unittest

from trio_fakes import ROOT

DRAWS = """
set -euo pipefail
source "$1/scripts/lib/faults.sh"
RANDOM="$2" figure[reference_s]=100
for run in 1 2; do plan_kills segmenter viewer mapper; echo "$planned"; done
draw_share; echo "$share $RANDOM"
"""


class FaultsSeedTest(unittest.TestCase):
    def draws(self, seed):
        return subprocess.run(["bash", "-c", DRAWS, "faults", ROOT, str(seed)], check=True, capture_output=True,
                              text=True).stdout

    def test_the_same_seed_gives_the_same_moments(self):
        draws = self.draws(3)
        self.assertEqual(draws, self.draws(3))
        self.assertNotEqual(draws, self.draws(4))
        moments = [float(line.split()[0]) for line in draws.splitlines()[:-1]]
        self.assertEqual(len(set(moments)), 6)
        for run in (moments[:3], moments[3:]):
            self.assertEqual(run, sorted(run))


if __name__ == "__main__":
    unittest.main()
