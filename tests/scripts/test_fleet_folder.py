"""The folder of a fleet: whose it is, and how results appear in it."""

from fleet_fakes import FleetTest

from fleet.folder import FleetFolder
from fleet.inputs import Input
from trio.messages import Problem

SETTINGS = {"preset": "", "maps": True, "cloud": [], "segmenter": [], "mapper": []}
A, B = Input("a", "/a.ply"), Input("b", "/b.ply")


class FolderTest(FleetTest):
    def begun(self, *given):
        folder = FleetFolder(self.out)
        folder.begin(given, SETTINGS)
        return folder

    def refusal(self, folder, given, settings=None):
        with self.assertRaises(Problem) as caught:
            folder.check_is_of(given, settings or SETTINGS)
        self.assertEqual(caught.exception.exit_code, 2)
        return str(caught.exception)

    def test_it_remembers_what_it_is_of(self):
        self.assertEqual(self.begun(A, Input("c", "/\udcff", words={"mapper": ["--x"]})).recall(),
                         ([A, Input("c", "/\udcff", words={"mapper": ["--x"]})], SETTINGS))

    def test_the_same_list_and_one_with_more_inputs_go_on(self):
        folder = self.begun(A)
        folder.check_is_of([A], SETTINGS)
        folder.check_is_of([B, A], SETTINGS)

    def test_another_list_is_refused_with_the_difference_and_what_to_do(self):
        folder = self.begun(A, B)
        text = self.refusal(folder, [A])
        self.assertIn("another list: it has no input b (/b.ply). Go on with that list", text)
        self.assertIn("choose another folder with --out", text)
        self.assertIn("device of a was '/a.ply', and is '/other.ply' now", self.refusal(folder, [Input("a", "/other.ply"), B]))
        self.assertIn("truth of a was not given, and is '/t.ply' now", self.refusal(folder, [Input("a", "/a.ply", truth="/t.ply"), B]))

    def test_other_options_are_refused(self):
        self.assertIn("preset was not given, and is 'paper' now",
                      self.refusal(self.begun(A), [A], {**SETTINGS, "preset": "paper"}))

    def test_a_folder_with_other_files_is_refused_and_an_empty_one_not(self):
        folder = FleetFolder(self.here)
        self.write("thesis.tex", "")
        self.assertIn("holds other files", self.refusal(folder, [A]))
        FleetFolder(self.here / "new").check_is_of([A], SETTINGS)
        self.assertFalse((self.here / "new").exists())

    def test_a_folder_that_is_none_or_damaged_is_told(self):
        with self.assertRaisesRegex(Problem, "is no folder of a fleet"):
            FleetFolder(self.here).recall()
        folder = self.begun(A)
        (self.out / "fleet.json").write_text('{"inputs": [')
        with self.assertRaisesRegex(Problem, "fleet.json is damaged"):
            folder.recall()

    def test_a_result_appears_as_a_whole_and_replaces_an_earlier_one(self):
        folder = self.begun(A)
        for content in ("first", "second"):
            before = folder.results().get("a")
            with folder.work_on("a") as here:
                (here / "row.json").write_text('{"state": "done"}')
                (here / content).touch()
                self.assertEqual(folder.results().get("a"), before)
            self.assertNotEqual(folder.results()["a"], before)
        self.assertEqual(sorted(path.name for path in (self.out / "results" / "a").iterdir()), ["row.json", "second"])
        folder.tidy()
        self.assertEqual(list((self.out / "work").iterdir()), [])

    def test_a_task_that_ends_with_an_error_leaves_the_earlier_result(self):
        folder = self.begun(A)
        with folder.work_on("a") as here:
            (here / "row.json").write_text('{"state": "failed"}')
        with self.assertRaises(KeyboardInterrupt), folder.work_on("a") as here:
            (here / "row.json").write_text('{"state": "done"}')
            raise KeyboardInterrupt
        self.assertFalse(folder.is_done("a"))

    def test_two_tasks_on_one_input_are_refused(self):
        folder = self.begun(A)
        with folder.work_on("a"), self.assertRaisesRegex(Problem, "another task is at work"), folder.work_on("a"):
            pass

    def test_a_damaged_row_is_no_result(self):
        folder = self.begun(A)
        with folder.work_on("a") as here:
            (here / "row.json").write_text('{"state": ')
        self.assertEqual(folder.rows([A])[0]["state"], "missing")
