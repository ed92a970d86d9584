"""scripts/fleet: from the command line to the exit code."""

import os
import subprocess
import sys
import tempfile
import time
from dataclasses import replace

from trio.check import reason
from trio.messages import STDOUT, Problem, os_error_text, say, write
from trio.network import use_bus_key
from trio.process_options import without
from trio.programs import check_programs, program

from . import slurm, table
from .folder import FleetFolder, write_text
from .inputs import read_list
from .local import Local
from .options import PROGRAMS, USAGE, RunParser, settings_of
from .page import page
from .rounds import Rounds, todo
from .task import do_task, use_processors
from .work import LOG, words_of

INTERRUPTED = 130  # exit code, as shells have it
WRONG_FLAG = 100  # the lowest exit code of a program with a wrong flag
# How the options of a program are tried, and the lowest exit code for which they are to blame: a cloud is never there.
TRIALS = {"cloud": (("no/such/input.ply", "labelled.ply"), WRONG_FLAG), "segmenter": (("--check",), 1),
          "mapper": (("--check", "--device=synthetic://plane", "--lcm-url=memq://", f"--store={LOG}"), 1)}
OF_DEVICE = ("--depth-mode", "--color-mode")  # the plane offers others than a camera does
SHOWN_FAILURES = 20
NEEDED = ("segment-cloud", "segmenter", "mapper", "evaluate", "ground-truth")


def main(arguments):
    commands = {"run": run, "report": report, "task": task}
    try:
        if not arguments or arguments[0] in ("-h", "--help"):
            write(STDOUT, USAGE + RunParser().format_help())
            return 0 if arguments else 2
        if arguments[0] not in commands:
            raise Problem(f"unknown command {arguments[0]}; expected run or report, see scripts/fleet --help", 2)
        return commands[arguments[0]](arguments[1:])
    except Problem as problem:
        say(str(problem))
        return problem.exit_code
    except OSError as error:
        say(os_error_text(error))
        return 1


def run(arguments):
    choice = RunParser().parse(arguments)
    use_bus_key()
    folder = FleetFolder(choice.out)
    folder.lock_if_used()
    inputs, settings = read_list(choice.list, folder.recorded()), settings_of(choice)
    for name in NEEDED:
        check_program(name)
    check_programs([], ["setpriv"])
    folder.check_is_of(inputs, settings)
    scheduler = scheduler_for(choice, folder)
    check_flags(inputs, settings)
    folder.begin(inputs, settings)
    slurm.wait_for_earlier(folder, lambda: None)
    to_do = [given for given in inputs if not folder.is_done(given.name)]
    if len(to_do) < len(inputs):
        say(f"{len(inputs) - len(to_do)} of {len(inputs)} inputs have been done before")
    ended = work_through(choice, folder, scheduler, to_do)
    write_report(folder, inputs, settings)
    rows = folder.rows(inputs)
    tell(rows, folder)
    if not ended:
        return INTERRUPTED
    return 1 if table.count(rows)["done"] < len(rows) else 0


def work_through(choice, folder, scheduler, to_do):
    """Whether all has ended, and not by a signal."""
    if not to_do:
        return True
    workers = f", {scheduler.workers} at a time" if scheduler.workers else ""
    say(f"tasks: {len(to_do)}, with {scheduler.name}{workers}")
    begun, start_s = time.strftime("%Y-%m-%d %H:%M:%S"), time.monotonic()
    rounds = Rounds(folder, to_do, scheduler, choice.timeout, choice.cpus)
    ended = rounds.run()
    elapsed_s = time.monotonic() - start_s
    folder.tidy()
    rows = folder.rows(rounds.with_result())
    task_s = sum(row.get("wall_s", 0.0) for row in rows)
    folder.add_run({"begun": begun, "elapsed_s": round(elapsed_s, 1), "scheduler": scheduler.name,
                    "workers": scheduler.workers or None, "tasks": len(rows),
                    "failed": sum(row["state"] == "failed" for row in rows), "task_s": round(task_s, 1),
                    "at_work": round(task_s / elapsed_s, 2),
                    # of its first task, by the clock of the tasks
                    "begun_s": min((row["started_s"] for row in rows if "started_s" in row), default=0.0)})
    return ended


def scheduler_for(choice, folder):
    name = choice.scheduler
    if name == "auto":
        name = "slurm" if slurm.answers() else "parallel"
    if name == "slurm":
        return slurm.Slurm(folder, choice.jobs, choice.cpus, choice.sbatch)
    return Local(folder, choice.jobs, choice.cpus, choice.parallel)


def check_program(name):
    if not os.access(program(name), os.X_OK):
        raise Problem(f"there is no kintsugi-{name} in {os.path.dirname(program(name))}; run scripts/build first")


def check_flags(inputs, settings):
    """Raises Problem for options that a program does not take: they would let every input fail. Each set of options is
    tried once, without an input, in an empty folder as that of a task."""
    tried = set()
    with tempfile.TemporaryDirectory() as empty:
        for given in inputs:
            for word, where, words in options_of(given, settings):
                if not words or (word, *words) in tried:
                    continue
                tried.add((word, *words))
                name, (arguments, to_blame) = PROGRAMS[word], TRIALS[word]
                done = subprocess.run([program(name), *arguments, *without(OF_DEVICE, words)], cwd=empty,
                                      stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace",
                                      check=False)
                if done.returncode >= to_blame:
                    text = reason(name, done).removeprefix(f"{where}: ")
                    raise Problem(f"{where}: {text}{hint_at_path(text, words)}", 2)


def hint_at_path(text, words):
    """For a message FILE: REASON of a program."""
    file, is_pair, _ = text.partition(": ")
    is_given = is_pair and any(file in (word, word.partition("=")[2]) for word in words)
    return "; a file in options needs its whole path" if is_given and not os.path.isabs(file) else ""


def options_of(given, settings):
    """The options of each program for an input: those of one place, and then with those of the next one, so that what
    is wrong is of the last place. Yields the word of the program, the place and the options."""
    plain = replace(given, words={})
    for word in PROGRAMS:
        yield word, "--preset", words_of(word, plain, {**settings, word: []})
        yield word, f"--{word}", words_of(word, plain, settings)
        yield word, f"{given.name} in the list", words_of(word, given, settings)


def report(arguments):
    if arguments in (["-h"], ["--help"]):
        write(STDOUT, USAGE)
        return 0
    if len(arguments) != 1 or arguments[0].startswith("-"):
        raise Problem("report of which folder? see scripts/fleet --help", 2)
    folder = FleetFolder(arguments[0])
    inputs, settings = folder.recall()
    write_report(folder, inputs, settings)
    tell(folder.rows(inputs), folder)
    return 0


def write_report(folder, inputs, settings):
    rows = folder.rows(inputs)
    write_text(folder.path / "results.csv", table.as_csv(rows))
    write_text(folder.path / "report.html", page(f"Fleet {folder.path.name}", rows, folder.runs(), settings))


def tell(rows, folder):
    """The failed inputs with their reasons, and what there is."""
    failed = [row for row in rows if row["state"] == "failed"]
    for row in failed[:SHOWN_FAILURES]:
        say(f"{row['name']} failed: {row['reason']}")
    if len(failed) > SHOWN_FAILURES:
        say(f"and {len(failed) - SHOWN_FAILURES} more, see {folder.path}/results.csv")
    numbers = ", ".join(f"{number} {state}" for state, number in table.count(rows).items() if number)
    write(STDOUT, f"{numbers} of {len(rows)} inputs: {folder.path}/results.csv, {folder.path}/report.html\n")


def task(arguments):
    """scripts/fleet task DIR NUMBER [SLOT]: what schedulers call. The exit code is 0 when there is a result, of a
    failed input too."""
    if len(arguments) not in (2, 3):
        raise Problem("task is for schedulers: task DIR NUMBER [SLOT]", 2)
    folder = FleetFolder(arguments[0])
    inputs, settings = folder.recall()
    job = todo(folder)
    if len(arguments) == 3:
        use_processors(int(arguments[2]), job["cpus"])
    row = do_task(folder, inputs, settings, job["names"][int(arguments[1]) - 1], job["timeout_s"])
    if row["state"] == "failed":
        sys.stderr.write(f"{row['name']} failed: {row['reason']}\n")
    return 0
