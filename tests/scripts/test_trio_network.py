"""Where LCM can work, and what is said where it cannot."""

import os
import unittest
from unittest import mock

from trio_fakes import ROOT, FolderTest

from trio import network


class Network(FolderTest):
    def setUp(self):
        super().setUp()
        patches = [mock.patch.dict(os.environ), mock.patch.object(network.os, "execv"),
                   mock.patch.object(network, "has_multicast_route"), mock.patch.object(network, "RMEM_MAX", "missing")]
        _, self.execv, self.has_route, _ = [patch.start() for patch in patches]
        self.addCleanup(mock.patch.stopall)
        for name in ("KINTSUGI_PRIVATE_BUS", "KINTSUGI_BUS_KEY", "LCM_DEFAULT_URL"):
            os.environ.pop(name, None)

    def expect_private(self):
        script = str(ROOT / "scripts" / "private_bus")
        self.execv.assert_called_once_with(script, [script, "trio", "--out", "run"])

    def test_with_a_route_nothing_is_said(self):
        network.choose_network(False, ["trio"])
        self.execv.assert_not_called()
        network.tell_how_to_ask()
        self.assertEqual(self.said, "")

    def test_a_private_network_is_entered_when_asked_for(self):
        network.choose_network(True, ["trio", "--out", "run"])
        self.expect_private()

    def test_a_private_network_is_entered_only_once(self):
        os.environ["KINTSUGI_PRIVATE_BUS"] = "1"
        network.choose_network(True, ["trio"])
        self.execv.assert_not_called()

    def test_how_to_ask_a_private_run_is_told(self):
        enter = f"nsenter --target {os.getpid()}"
        for value, options in (("1", " --net "), ("user", " --user --preserve-credentials --net ")):
            self.said = ""
            os.environ["KINTSUGI_PRIVATE_BUS"] = value
            network.tell_how_to_ask()
            self.assertIn(enter + options, self.said)
            self.assertIn("kintsugi-status --once", self.said)

    def test_who_asks_a_signed_private_run_is_told_its_key(self):
        os.environ["KINTSUGI_PRIVATE_BUS"] = "1"
        network.tell_how_to_ask()
        self.assertNotIn("--bus-key", self.said)
        network.use_bus_key("my keys/bus.key", "/folder")
        network.tell_how_to_ask()
        self.assertIn("kintsugi-status --once '--bus-key=/folder/my keys/bus.key' (", self.said)

    def test_without_a_route_the_cure_is_named_and_the_run_is_private(self):
        self.has_route.return_value = False
        network.choose_network(False, ["trio", "--out", "run"])
        self.assertIn("sudo ip link set lo up && sudo ip route add 224.0.0.0/4 dev lo", self.said)
        self.expect_private()

    def test_a_bus_that_was_chosen_needs_no_route_of_ours(self):
        self.has_route.return_value = False
        os.environ["LCM_DEFAULT_URL"] = "memq://"
        network.choose_network(False, ["trio"])
        self.execv.assert_not_called()

    def test_a_small_receive_buffer_is_told(self):
        for size, is_told in (("212992\n", True), ("4194304\n", False)):
            self.said = ""
            file = self.temporary / "rmem_max"
            file.write_text(size)
            with mock.patch.object(network, "RMEM_MAX", str(file)):
                network.note_receive_buffer()
            self.assertEqual("sysctl -w net.core.rmem_max" in self.said, is_told)


if __name__ == "__main__":
    unittest.main()
