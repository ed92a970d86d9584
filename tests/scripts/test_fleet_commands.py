"""The command line of scripts/fleet: what is refused before anything is started, and the report of a folder."""

import signal
from unittest import mock

from fleet_fakes import FleetTest
from trio_fakes import write_program

from fleet import commands, local, slurm
from fleet.folder import FleetFolder
from fleet.inputs import Input
from fleet.options import RunParser
from fleet.rounds import Rounds
from fleet.task import do_task
from trio.messages import Problem

SETTINGS = {"preset": "", "maps": True, "cloud": [], "segmenter": [], "mapper": []}


class RefusedTest(FleetTest):
    def refused(self, *arguments, told, code=2):
        self.assertIn(told, self.fleet(*arguments, expect=code))
        self.assertFalse(self.out.exists())

    def test_wrong_command_lines_change_nothing(self):
        self.write_list(a="")
        run = ("run", "list.txt", "--out", self.out)
        self.refused(told="usage: scripts/fleet run LIST")
        self.refused("start", told="unknown command start; expected run or report")
        self.refused("run", told="which list?")
        self.refused("report", told="report of which folder?")
        self.refused(*run, "--jobs", "two", told="--jobs two: expected a whole number, at least 0")
        self.refused(*run, "--cpus", "0", told="--cpus 0: expected a whole number, at least 1")
        self.refused(*run, "--scheduler", "pbs", told="--scheduler pbs: expected one of auto, slurm, parallel")
        self.refused(*run, "--nonsense", told="unknown option --nonsense")
        self.refused(*run, "--mapper", "'open", told="No closing quotation")
        self.refused(*run, "--segmenter", "--log x", told="scripts/fleet sets --log itself: PATH in the list is the log")
        self.refused("run", "none.txt", "--out", self.out, told="none.txt: No such file")
        self.refused("report", self.out, told="is no folder of a fleet")

    def test_programs_that_are_not_built_are_told(self):
        self.write_list(a="")
        (self.programs / "kintsugi-evaluate").unlink()
        self.refused("run", "list.txt", "--out", self.out, told="there is no kintsugi-evaluate", code=1)

    def test_help_says_what_a_list_is(self):
        for arguments in (["--help"], ["run", "--help"]):
            self.assertIn("PATH [name=NAME] [truth=FILE]", self.fleet(*arguments))


class FlagsTest(FleetTest):
    """Not through a scheduler, which may not be here."""

    def check(self, given, **settings):
        commands.check_flags(given, {**SETTINGS, **settings})

    def test_a_flag_that_a_program_does_not_know_is_told_before_anything_runs(self):
        self.check([Input("a", "/a.ply")], cloud=["--right"])
        with self.assertRaisesRegex(Problem, "--cloud: --wrong: not known"):
            self.check([Input("a", "/a.ply")], cloud=["--wrong"])
        with self.assertRaisesRegex(Problem, "b in the list: --wrong: not known"):
            self.check([Input("a", "/a.ply"), Input("b", "/b.ply", words={"cloud": ["--wrong"]})])

    def test_what_is_wrong_is_told_of_where_it_was_given(self):
        write_program(self.programs / "kintsugi-segment-cloud", "case \"$*\" in *foo*) echo '--preset: foo not known' >&2; "
                      "exit 105 ;; *--wrong*) echo '--wrong: not known' >&2; exit 109 ;; esac")
        given = [Input("a", "/a.ply", words={"cloud": ["--right"]})]
        with self.assertRaisesRegex(Problem, "^--preset: foo not known"):
            self.check(given, preset="foo", cloud=["--right"])
        with self.assertRaisesRegex(Problem, "^--cloud: --wrong: not known"):
            self.check(given, preset="paper", cloud=["--wrong"])

    def test_a_file_that_is_not_found_from_the_folder_of_a_task_is_told(self):
        write_program(self.programs / "kintsugi-mapper",
                      'for file; do :; done; file="${file#--calibration=}"\n'
                      'case "$*" in *--calibration*) [ -e "$file" ] ;; esac || '
                      '{ echo "kintsugi-mapper: $file: cannot be read" >&2; exit 1; }')
        self.write("cam.txt", "")
        given = [Input("a", "/a.klg")]
        for words in (["--calibration", "cam.txt"], ["--calibration=cam.txt"]):
            with self.assertRaisesRegex(Problem, "^--mapper: cam.txt: cannot be read; .* needs its whole path"):
                self.check(given, mapper=words)
            with self.assertRaisesRegex(Problem, "^b in the list: cam.txt: cannot be read; a file"):
                self.check([*given, Input("b", "/b.klg", words={"mapper": words})])
        self.check(given, mapper=["--calibration", f"{self.here}/cam.txt"])

    def test_what_only_the_device_of_an_input_offers_is_not_tried(self):
        write_program(self.programs / "kintsugi-mapper", 'case "$*" in *mode*) exit 1 ;; *--right) ;; *) exit 2 ;; esac')
        self.check([Input("a", "/a.klg")], mapper=["--depth-mode", "320x240@30", "--color-mode=320x240", "--right"])

    def test_values_that_begin_with_a_dash_belong_to_their_flag(self):
        choice = RunParser().parse(["list.txt", "--mapper", "--resolution=0.02", "--sbatch", "--mem=4G -p long"])
        self.assertEqual((choice.mapper, choice.sbatch), (["--resolution=0.02"], ["--mem=4G", "-p", "long"]))


class SchedulerTest(FleetTest):
    def test_without_any_scheduler_it_is_said_what_to_install(self):
        with mock.patch("shutil.which", return_value=None):
            self.assertFalse(slurm.answers())
            with self.assertRaisesRegex(Problem, "apt-get install parallel"):
                local.Local(None, 0, 1, [])
            with self.assertRaisesRegex(Problem, "no controller of Slurm answers"):
                slurm.Slurm(None, 0, 1, [])


class RoundsTest(FleetTest):
    def test_a_signal_after_the_tasks_is_handled_as_before_them(self):
        scheduler = mock.Mock()
        scheduler.is_at_work.return_value = False
        scheduler.problem.return_value = ""
        folder = FleetFolder(self.out)
        folder.begin([], SETTINGS)
        before = signal.getsignal(signal.SIGINT)
        self.assertTrue(Rounds(folder, [], scheduler, 0, 1).run())
        self.assertIs(signal.getsignal(signal.SIGINT), before)


class ReportTest(FleetTest):
    def test_the_report_of_what_there_is_so_far(self):
        given = [Input(name, str(self.write(f"{name}.ply", ""))) for name in "ab"]
        folder = FleetFolder(self.out)
        folder.begin(given, SETTINGS)
        do_task(folder, given, SETTINGS, "a")
        self.assertIn("1 done, 1 missing of 2 inputs", self.fleet("report", self.out))
        self.assertEqual([row["state"] for row in self.table().values()], ["done", "missing"])
        self.assertIn("1 done, 1 missing", (self.out / "report.html").read_text())
