"""scripts/trio and scripts/replay from the outside, with fake programs: exit codes, messages, the command lines
of the processes, and what happens when the supervisor is stopped or killed."""

import os
import re
import shlex
import signal
import subprocess
import unittest
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest import mock

from trio_fakes import ROOT, UNTIL_TERM, environment, process_is_gone, wait_until, write_program

from trio import commands, options
from trio.programs import command_of
from trio.recording import HEADER, SYNC_WORD

# Each program accepts all options, and notes how it was called. The display of the progress lasts until it is ended;
# questions are answered at once: there is no other mapper on the bus, everything else is so.
CHECK = 'case " $* " in *" --check "*) echo "$@" >>"$CALLS/checked-$(basename "$0")"; exit 0 ;; esac; '
NOTE = 'echo "$@" >>"$CALLS/$(basename "$0")"; '
FINISHES = NOTE + "sleep 0.2"
LASTS = NOTE + UNTIL_TERM
STATUS = NOTE + f'case "$*" in *--viewer*) {UNTIL_TERM} ;; "--until-ready mapper --map-name"*) exit 2 ;; esac'
A_LOG = HEADER.pack(SYNC_WORD, 0, 1_000, 4, 4) + b"CHANdata"
LOGGER = 'for file; do :; done; echo a log >"$file"; trap "exit 0" INT; while :; do sleep 0.02; done'


class CommandTest(unittest.TestCase):
    def setUp(self):
        temporary = TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.work = Path(temporary.name)
        self.programs = self.work / "bin"
        self.calls = self.work / "calls"
        for folder in (self.programs, self.calls):
            folder.mkdir()
        self.program("mapper", LASTS)
        self.program("segmenter", LASTS)
        self.program("viewer", FINISHES)
        self.program("status", STATUS)
        self.program("complete-log", LASTS)
        write_program(self.programs / "lcm-logger", LOGGER)
        write_program(self.programs / "lcm-logplayer", FINISHES)

    def program(self, name, script):
        write_program(self.programs / f"kintsugi-{name}", CHECK + script)

    def start(self, command, *arguments):
        process = subprocess.Popen([ROOT / "scripts" / command, *arguments], cwd=self.work, text=True,
                                   env={**environment(self.programs), "CALLS": str(self.calls)},
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def run_command(self, command, *arguments):
        """Exit code and what was said; never a traceback."""
        process = self.start(command, *arguments)
        said = process.communicate()[0]
        self.assertNotIn("Traceback", said)
        return process.returncode, said

    def expect(self, exit_code, command, *arguments):
        code, said = self.run_command(command, *arguments)
        self.assertEqual(code, exit_code, said)
        return said

    def call(self, name, number=-1):
        """The words with which a program was called."""
        return shlex.split((self.calls / name).read_text().splitlines()[number])

    def size(self, file):
        path = self.work / file
        return path.stat().st_size if path.exists() else 0

    def pids(self, out):
        return [int((self.work / out / f"{name}.pid").read_text()) for name in ("mapper", "segmenter", "viewer")]


class Demo(unittest.TestCase):
    def test_builds_all_programs_that_its_run_starts(self):
        script = Path(ROOT, "scripts", "demo").read_text()
        built = set(re.search(r"^programs=\((.*)\)$", script, re.MULTILINE)[1].split())
        options_of_run = shlex.split(re.search(r"^exec \S+ (.*) \"\$@\"$", script, re.MULTILINE)[1])
        started = commands.needed_programs(options.parse_trio(options_of_run))
        self.assertEqual(built, {os.path.basename(command_of(name)[0]) for name in started})


class Trio(CommandTest):
    def test_a_run_names_what_it_wrote(self):
        said = self.expect(0, "trio", "--out", "run", "--every", "3")
        self.assertIn("trio: written:", said)
        self.assertIn("run/run.lcm", said)
        self.assertIn("0 pictures of the run", said)
        self.assertEqual((self.work / "run/run.lcm").read_text(), "a log\n")
        self.assertEqual(self.call("kintsugi-complete-log"), ["run/run.lcm.partial"])
        self.assertFalse((self.work / "run/run.lcm.partial").exists())
        self.assertEqual(list((self.work / "run").glob("*.pid")), [])

    def test_each_process_gets_its_options(self):
        self.expect(0, "trio", "--out", "run", "--no-log", "--device", "", "--mapper", "--session=7", "--video",
                    "--mode", "batch")
        self.assertEqual(self.call("kintsugi-mapper"), ["--output-trajectory=run/trajectory.txt", "--linger=-1",
                                                        "--store=run/mapper.lcm", "--session=7"])
        self.assertEqual(self.call("kintsugi-segmenter"), [
            "--out=run", "--exit-on-final", "--linger=-1", "--save=run/segmenter.map", "--save-every=5",
            "--resume-if-saved", "--map-name=map", "--mode=batch"])
        self.assertEqual(self.call("kintsugi-viewer"),
                         ["--out=run", "--exit-on-final", "--map-name=map", "--video=run/run.mp4"])

    def test_an_option_of_the_user_replaces_that_of_the_run(self):
        self.expect(0, "trio", "--out", "run", "--no-log", "--video",
                    "--mapper", "--output-trajectory 'my path.txt' --linger=3",
                    "--segmenter", "--save-every 2 --exit-on-final", "--viewer", "--video=my.mp4")
        self.assertEqual(self.call("kintsugi-mapper"), ["--store=run/mapper.lcm", "--output-trajectory", "my", "path.txt",
                                                        "--linger=3"])  # echo loses the quotes
        segmenter = " ".join(self.call("kintsugi-segmenter"))
        for flag in ("--save-every", "--exit-on-final"):
            self.assertEqual(segmenter.count(flag), 1, segmenter)
        self.assertEqual(" ".join(self.call("kintsugi-viewer")).count("--video"), 1)

    def test_a_key_of_the_bus_is_that_of_all_processes_also_when_the_run_goes_on(self):
        key = 'echo "$KINTSUGI_BUS_KEY" >"$CALLS/key-$(basename "$0")"; '
        for name, script in (("mapper", FINISHES), ("segmenter", FINISHES), ("viewer", FINISHES), ("status", STATUS)):
            self.program(name, CHECK + key + script)

        def keys():
            found = {file.name: file.read_text().strip() for file in self.calls.glob("key-*")}
            for name in found:
                (self.calls / name).unlink()
            return found

        names = [f"key-kintsugi-{name}" for name in ("mapper", "segmenter", "viewer", "status")]
        self.expect(0, "trio", "--out", "run", "--no-log", "--bus-key", "my.key")
        self.assertEqual(keys(), {name: str(self.work / "my.key") for name in names})
        self.expect(0, "trio", "--out", "run", "--no-log", "--resume")
        self.assertEqual(keys(), {name: str(self.work / "my.key") for name in names})
        self.expect(0, "trio", "--out", "run", "--no-log")
        self.assertEqual(keys(), {name: "" for name in names})
        with mock.patch.dict(os.environ, {"KINTSUGI_BUS_KEY": "its.key"}):
            self.expect(0, "trio", "--out", "run", "--no-log", "--resume")
        self.assertEqual(keys(), {name: str(self.work / "its.key") for name in names})
        with mock.patch.dict(os.environ, {"KINTSUGI_BUS_KEY": "its.key"}):
            self.expect(0, "trio", "--out", "run", "--no-log")
            keys()
        self.expect(0, "trio", "--out", "run", "--no-log", "--resume")
        self.assertEqual(keys(), {name: str(self.work / "its.key") for name in names})
        self.expect(0, "trio", "--out", "run", "--no-log", "--resume", "--bus-key", "new.key")
        self.assertEqual(keys(), {name: str(self.work / "new.key") for name in names})

    def test_a_name_of_the_map_is_that_of_all_processes(self):
        for number, options in enumerate((["--map-name", "attic"], ["--mapper", "--map-name attic"],
                                          ["--mapper=--map-name=attic", "--segmenter", "--map-name attic"])):
            self.expect(0, "trio", "--out", f"run{number}", "--no-log", *options)
            for name in ("mapper", "segmenter", "viewer", "status"):
                call = " ".join(self.call(f"kintsugi-{name}")).replace("--map-name=", "--map-name ")
                self.assertEqual(call.count("--map-name attic"), 1, (name, options))

    def test_segmenter_and_viewer_alone_take_a_map_of_any_name(self):
        self.expect(0, "trio", "--only", "segmenter,viewer", "--out", "run", "--no-log")
        for name in ("segmenter", "viewer", "status"):
            self.assertNotIn("--map-name=map", self.call(f"kintsugi-{name}"))

    def test_a_second_mapper_with_the_name_of_the_map_is_refused(self):
        self.expect(0, "trio", "--out", "run", "--no-log")
        before = sorted(path.name for path in (self.work / "run").iterdir())
        self.program("status", 'case "$*" in "--until-ready mapper --map-name=map"*) exit 0 ;; esac; ' + UNTIL_TERM)
        said = self.expect(1, "trio", "--out", "run", "--no-log")
        self.assertIn("another mapper makes a map called 'map' on this bus", said)
        self.assertIn("--map-name", said)
        self.assertEqual(sorted(path.name for path in (self.work / "run").iterdir()), before)

    def test_objects_are_found_by_a_fourth_process(self):
        self.program("objects", FINISHES)
        self.expect(0, "trio", "--out", "run", "--no-log", "--objects", "library", "--detector", "--speed=2")
        words = ["--library=library", "--exit-on-final", "--json=run/objects.json", "--map-name=map", "--speed=2"]
        self.assertEqual(self.call("kintsugi-objects"), ["detect", *words])
        self.assertEqual(self.call("checked-kintsugi-objects"), ["detect", "--check", "--library=library", "--speed=2"])
        self.assertTrue((self.work / "run/detector.log").exists())
        self.expect(0, "trio", "--out", "other", "--no-log")
        self.assertEqual(len((self.calls / "kintsugi-objects").read_text().splitlines()), 1)

    def test_a_library_that_is_refused_ends_with_2(self):
        write_program(self.programs / "kintsugi-objects", "echo kintsugi-objects: library: no such folder >&2; exit 1")
        said = self.expect(2, "trio", "--out", "run", "--objects", "library")
        self.assertEqual(said.splitlines()[-1], "trio: detector: library: no such folder")
        self.assertFalse((self.work / "run").exists())

    def test_a_detector_that_was_killed_is_started_again(self):
        killed = 'if [ ! -e "$CALLS/killed" ]; then touch "$CALLS/killed"; kill -KILL $$; fi; '
        self.program("objects", NOTE + killed + 'touch "$CALLS/again"; ' + UNTIL_TERM)
        self.program("viewer", 'until [ -e "$CALLS/again" ]; do sleep 0.02; done')
        said = self.expect(0, "trio", "--out", "run", "--no-log", "--objects", "library")
        self.assertIn("detector was killed (signal 9); starting it again", said)
        self.assertEqual(len((self.calls / "kintsugi-objects").read_text().splitlines()), 2)

    def test_without_the_program_of_the_detector_nothing_is_started(self):
        self.assertIn("there is no kintsugi-objects in", self.expect(1, "trio", "--out", "run", "--objects", "library"))

    def test_without_a_viewer_the_others_linger_for_a_minute(self):
        self.program("segmenter", FINISHES)
        self.expect(0, "trio", "--only", "mapper,segmenter", "--out", "run", "--no-log")
        self.assertIn("--linger=60", self.call("kintsugi-mapper"))
        self.assertFalse((self.calls / "kintsugi-viewer").exists())

    def test_resume_recalls_the_options(self):
        self.expect(0, "trio", "--out", "run", "--no-log", "--resolution", "0.02", "--max-frames", "5")
        (self.work / "run/mapper.lcm").write_text("slices")
        self.expect(0, "trio", "--resume", "--out", "run", "--max-frames", "9")
        call = self.call("kintsugi-mapper")
        self.assertIn("--resolution=0.02", call)
        self.assertIn("--max-frames=9", call)
        self.assertNotIn("--max-frames=5", call)
        self.assertIn(f"--resume={self.work.resolve()}/run/mapper.lcm", call)

    def test_a_run_that_was_finished_is_not_resumed_and_that_is_told(self):
        self.expect(0, "trio", "--out", "run", "--no-log")
        (self.work / "run/mapper.lcm").write_text("slices")
        for says, is_told in (("session 7 is complete: its slices are only sent again", True), ("resumed", False)):
            self.program("mapper", f'echo "{says}"; ' + UNTIL_TERM)
            said = self.expect(0, "trio", "--resume", "--out", "run")
            self.assertEqual("nothing was resumed" in said.splitlines()[-1], is_told, said)

    def test_a_mapper_that_resumes_is_asked_as_one_that_resumes(self):
        self.expect(0, "trio", "--out", "run", "--no-log")
        self.assertEqual(self.call("checked-kintsugi-mapper"), ["--check"])
        (self.work / "run/mapper.lcm").write_text("slices")
        self.expect(0, "trio", "--resume", "--out", "run")
        self.assertEqual(self.call("checked-kintsugi-mapper"),
                         ["--check", f"--resume={self.work.resolve()}/run/mapper.lcm"])

    def test_resume_without_slices_starts_from_the_beginning(self):
        self.expect(0, "trio", "--out", "run", "--no-log")
        self.expect(0, "trio", "--resume", "--out", "run")
        self.assertIn(f"--store={self.work.resolve()}/run/mapper.lcm", self.call("kintsugi-mapper"))

    def test_a_mapper_that_was_killed_resumes_its_log(self):
        self.program("mapper", NOTE + 'case "$*" in *--store*) echo slices >run/mapper.lcm; kill -KILL $$ ;; esac; '
                     + UNTIL_TERM)
        self.program("viewer", 'until grep -q -e --resume "$CALLS/kintsugi-mapper"; do sleep 0.02; done')
        said = self.expect(0, "trio", "--out", "run", "--no-log")
        self.assertIn("mapper was killed (signal 9); starting it again", said)
        self.assertEqual(len((self.calls / "kintsugi-mapper").read_text().splitlines()), 2)

    def test_an_error_is_told_with_its_reason(self):
        self.program("viewer", "echo no folder; exit 3")
        said = self.expect(1, "trio", "--out", "run", "--no-log")
        self.assertIn("viewer ended with an error (exit code 3):\n  viewer: no folder\n", said)
        self.assertEqual(said.splitlines()[-1], "trio: viewer ended with an error (exit code 3): no folder")

    def test_options_that_a_process_refuses_end_with_2_before_anything_is_written(self):
        self.expect(0, "trio", "--out", "old", "--no-log")
        before = sorted(path.name for path in (self.work / "old").iterdir())
        write_program(self.programs / "kintsugi-mapper", "echo kintsugi-mapper: a.oni: no such file >&2; exit 1")
        for out in ("old", "new"):
            said = self.expect(2, "trio", "--out", out, "--device", "a.oni")
            self.assertEqual(said.splitlines()[-1], "trio: mapper: a.oni: no such file")
        self.assertEqual(sorted(path.name for path in (self.work / "old").iterdir()), before)
        self.assertFalse((self.work / "new").exists())
        self.expect(2, "trio", "--resume", "--out", "old")

    def test_processes_that_do_not_run_are_not_asked(self):
        write_program(self.programs / "kintsugi-mapper", "exit 1")
        self.expect(0, "trio", "--only", "segmenter,viewer", "--out", "run", "--no-log", "--preset", "paper")
        self.assertEqual(self.call("checked-kintsugi-segmenter"), ["--check", "--preset=paper"])

    def test_the_hint_of_a_program_names_the_program(self):
        write_program(self.programs / "kintsugi-viewer", "echo '--x: no such flag' >&2; "
                      "echo Run with --help for more information. >&2; exit 109")
        self.assertIn("trio: viewer: --x: no such flag; see kintsugi-viewer --help",
                      self.expect(2, "trio", "--out", "run"))
        (self.work / "run.lcm").write_bytes(A_LOG)
        self.assertIn("replay: viewer: --x: no such flag", self.expect(2, "replay", "run.lcm", "--out", "again"))
        self.assertFalse((self.work / "again").exists())

    def test_wrong_options_end_with_2(self):
        self.assertIn("trio: unknown option --nonsense", self.expect(2, "trio", "--nonsense"))
        self.assertIn("trio: --only painter", self.expect(2, "trio", "--only", "painter"))

    def test_programs_that_are_missing_are_named(self):
        (self.programs / "kintsugi-viewer").unlink()
        self.assertIn("no kintsugi-viewer", self.expect(1, "trio", "--out", "run"))

    def test_a_folder_that_cannot_be_made_is_named(self):
        (self.work / "file").touch()
        self.assertIn("trio: file/run: Not a directory", self.expect(1, "trio", "--out", "file/run"))

    def test_a_full_disk_is_named(self):
        (self.work / "run").mkdir()
        os.symlink("/dev/full", self.work / "run/trio.options.partial")
        self.assertIn("trio: run/trio.options.partial: No space left on device", self.expect(1, "trio", "--out", "run"))
        self.expect(0, "trio", "--out", "run")

    def test_nothing_to_resume_is_told(self):
        self.assertIn("holds no run to go on with", self.expect(1, "trio", "--resume", "--out", "nothing"))

    def test_one_signal_finishes_the_run(self):
        self.program("viewer", UNTIL_TERM)
        self.program("status", STATUS.replace(" ;; esac", " ;; *--lingering*) exit 2 ;; esac"))  # it still maps
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            out = f"run{number}"
            self.program("mapper", f"trap 'kill $(cat {out}/viewer.pid); exit 0' TERM; echo up; "
                         "while :; do sleep 0.02; done")
            trio = self.start("trio", "--out", out)
            self.assertTrue(wait_until(lambda: self.size(f"{out}/mapper.log")))
            trio.send_signal(number)
            said = trio.communicate()[0]
            self.assertEqual(trio.returncode, 0, said)
            self.assertIn("stopping; the map so far", said)

    def test_all_processes_end_with_a_supervisor_that_is_killed(self):
        self.program("viewer", UNTIL_TERM)
        self.program("mapper", "trap '' TERM; while :; do sleep 0.02; done")  # one SIGTERM does not end it
        trio = self.start("trio", "--out", "run")
        self.assertTrue(wait_until(lambda: (self.work / "run/mapper.pid").exists()))
        pids = self.pids("run")
        self.assertTrue(wait_until(lambda: all("kintsugi" in command_line(pid) for pid in pids)))
        trio.kill()
        self.assertTrue(wait_until(lambda: all(process_is_gone(pid) for pid in pids)))
        self.program("viewer", FINISHES)
        self.program("mapper", LASTS)
        self.expect(0, "trio", "--resume", "--out", "run")


class Replay(CommandTest):
    def setUp(self):
        super().setUp()
        (self.work / "run.lcm").write_bytes(A_LOG)

    def test_the_log_is_played_for_those_who_listen(self):
        self.expect(0, "replay", "run.lcm", "--speed", "4", "--out", "again", "--preset", "paper")
        call = self.call("lcm-logplayer")
        self.assertEqual((call[call.index("-s") + 1], call[-1]), ("4", "run.lcm"))
        played = call[call.index("-e") + 1]
        for channel in ("CLOUD_SLICE", "CAMERA_VIEW"):
            self.assertRegex(channel, played)
        self.assertNotRegex("SEGMENT_UPDATE", played)
        self.assertIn("--preset=paper", self.call("kintsugi-segmenter"))

    def test_what_an_earlier_replay_wrote_does_not_count_as_written(self):
        (self.work / "again").mkdir()
        for name in ("segments.ply", "map_final.png", "run.lcm", "trajectory.txt"):
            (self.work / "again" / name).write_bytes(A_LOG)
            os.utime(self.work / "again" / name, (1e9, 1e9))
        said = self.expect(0, "replay", "again/run.lcm", "--out", "again")
        self.assertNotIn("trajectory.txt", said)
        self.assertNotIn("everything that was on the bus", said)
        self.assertNotIn("segments.ply", said)
        self.assertNotIn("map_final.png", said)
        self.assertTrue((self.work / "again/run.lcm").exists())

    def test_what_is_wrong_with_the_log_is_told_before_anything_is_started(self):
        (self.work / "empty.lcm").touch()
        (self.work / "bus.key").write_bytes(bytes(32))
        for log, reason in (("missing.lcm", "No such file or directory"), (".", "Is a directory"),
                            ("empty.lcm", "not an LCM log"), ("bus.key", "not an LCM log")):
            said = self.expect(1, "replay", log, "--out", "again")
            self.assertEqual(said.count("\n"), 1, said)
            self.assertIn(f"replay: {log}: {reason}", said)
        self.assertFalse((self.work / "again").exists())

    @unittest.skipIf(os.geteuid() == 0, "root may read everything")
    def test_a_log_that_may_not_be_read_is_told(self):
        (self.work / "run.lcm").chmod(0)
        self.assertIn("replay: run.lcm: Permission denied", self.expect(1, "replay", "run.lcm"))

    def test_why_the_log_is_not_played_is_told(self):
        write_program(self.programs / "lcm-logplayer", "echo 'Error: Failed to open run.lcm'; echo bye; exit 1")
        said = self.expect(1, "replay", "run.lcm", "--out", "again")
        self.assertIn("player ended with an error (exit code 1): Error: Failed to open run.lcm", said.splitlines()[-1])

    def test_who_does_not_come_up_is_told(self):
        self.program("viewer", "echo no screen; exit 1")
        self.program("status", 'case "$*" in *--until-ready*) sleep 1000 ;; esac')
        said = self.expect(1, "replay", "run.lcm", "--out", "again")
        self.assertIn("segmenter,viewer did not come up", said)
        self.assertIn("viewer: no screen", said)


def command_line(pid):
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes().decode().split("\0")[1]
    except (OSError, IndexError):
        return ""


if __name__ == "__main__":
    unittest.main()
