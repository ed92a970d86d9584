"""scripts/trio and scripts/replay: from the command line to the exit code."""

import contextlib
import os
import signal
import sys
import time

from . import network, options
from .check import check_options
from .map_name import map_name, map_option, refuse_second_mapper
from .messages import Problem, os_error_text, say
from .process import Process, stop
from .process_options import with_given
from .programs import check_programs, command_of, program
from .recording import Recording, begins_as_log
from .run_folder import RunFolder
from .status import Status
from .summary import show_summary
from .supervisor import Supervisor

LINGER_S = 60  # without a viewer, which knows when all is drawn: until there has been no request for so long
UNTIL_TOLD = -1
READY_TIMEOUT_S = 20
INTERRUPTED = 130  # exit code, as shells have it
NOTHING_TO_MAP = "is complete: its slices are only sent again"  # says a mapper
# What the mapper published. Messages of the recorded segmenter would contradict those of the one that listens now.
REPLAYED_CHANNELS = "^(CLOUD_SLICE|CAMERA_POSE|CAMERA_VIEW|MAPPER_STATUS|CHUNKS_REPLACED)$"
LONG_RUN_STATUS_S = 10  # between the statuses of a process in status.csv: 40 MB a day, all are 1.4 GB


def run_command(command):
    """Calls command(arguments) and returns the exit code: that of the command, 1 after a foreseeable error,
    2 after a wrong option."""
    try:
        return command(sys.argv[1:])
    except Problem as problem:
        say(str(problem))
        return problem.exit_code
    except OSError as error:
        say(os_error_text(error))
        return 1


def this_command():
    return [os.path.abspath(sys.argv[0]), *sys.argv[1:]]


def trio(arguments):
    choice = options.parse_trio(arguments)
    choice.started_in = None  # here
    if choice.resume:
        choice = recalled(choice.out, arguments)
    network.use_bus_key(choice.bus_key, choice.started_in)
    check_programs(needed_programs(choice), ["setpriv"] if choice.no_log else ["setpriv", "lcm-logger"])
    network.choose_network(choice.private, this_command())
    if "mapper" in choice.only and not choice.private:  # nobody else is in a private network
        refuse_second_mapper(choice)
    folder = RunFolder(choice.out)
    folder.lock_if_used()  # first: what another run has opened cannot be opened to check it
    check_options({name: words_to_check(name, choice, folder) for name in choice.only}, choice.started_in)
    folder.create()
    folder.lock()
    if choice.resume:
        os.chdir(choice.started_in)
    else:
        folder.begin_run([*network.bus_key_option(), *arguments], choice.durable)
    network.tell_how_to_ask()
    return run_trio(choice, folder)


def needed_programs(choice):
    """The names of the programs that a run with these options starts, as check_programs() takes them."""
    return [*choice.only, "status", *([] if choice.no_log else ["complete-log"])]


def words_to_check(name, choice, folder):
    """A mapper that resumes may find its session complete, and then needs no device."""
    resumes = name == "mapper" and choice.resume and folder.has("mapper.lcm")
    return [*([f"--resume={folder.file('mapper.lcm')}"] if resumes else []), *library_option(name, choice),
            *getattr(choice, name)]


def library_option(name, choice):
    return [f"--library={choice.objects}"] if name == options.DETECTOR else []


def recalled(out, arguments):
    """The options that the run in the folder `out` was started with; options given now replace the remembered
    ones. Relative paths are relative to the folder in which the run was started."""
    started_in, saved = RunFolder(out).recall_options()
    if not os.path.isdir(started_in):
        raise Problem(f"{started_in}, in which the run was started, is not there any more")
    choice = options.parse_trio([*saved, *arguments])
    choice.out, choice.started_in = os.path.realpath(out), started_in
    return choice


def run_trio(choice, folder):
    make = {"mapper": mapper_process, "segmenter": segmenter_process, "viewer": viewer_process,
            "detector": detector_process}
    watched = [make[name](choice, folder) for name in choice.only]
    recording = None if choice.no_log else Recording(folder.path, choice.durable)
    logger, completion = logger_processes(folder, recording) if recording else (None, None)
    status_period_s = LONG_RUN_STATUS_S if choice.is_long else 0
    with supervised(folder, watched, logger, completion, map_name(choice), status_period_s) as supervisor:
        if recording:
            recording.begin()
            logger.start()
            completion.start()
        for process in [*watched[1:], watched[0]] if "mapper" in choice.only else watched:
            process.start()
        good = supervisor.watch()
        if recording:
            good = end_recording(logger, recording) and good
        show_summary(folder, watched)
        tell_what_matters(supervisor, choice, watched[0])
    return 0 if good else 1


def tell_what_matters(supervisor, choice, leader):
    """At the end, where it is seen."""
    if choice.resume and leader.name == "mapper" and leader.has_said(NOTHING_TO_MAP):
        say("nothing was resumed: the run was finished before (Ctrl-C, too, finishes a run), so its map was only "
            "segmented and drawn again. A run without --resume maps anew")
    supervisor.tell_failures()


@contextlib.contextmanager
def supervised(folder, processes, logger=None, completion=None, its_map=None, status_period_s=0):
    """Yields a supervisor that handles signals. When the block ends, for whatever reason, its processes are ended."""
    status = Status(folder.file("status.csv"), its_map, status_period_s)
    supervisor = Supervisor(folder, status, processes, logger, completion)
    supervisor.install_signal_handlers()
    try:
        yield supervisor
    finally:
        supervisor.end()


def linger_s(choice):
    return UNTIL_TOLD if "viewer" in choice.only else LINGER_S


def mapper_process(choice, folder):
    def command(resume):
        log_option = "--resume" if resume and folder.has("mapper.lcm") else "--store"
        own = ["--output-trajectory=" + folder.file("trajectory.txt"), f"--linger={linger_s(choice)}",
               f"{log_option}={folder.file('mapper.lcm')}", *(["--durable"] if choice.durable else []),
               *map_option(choice.map_name, choice.mapper)]
        return [program("mapper"), *with_given(own, choice.mapper)]

    # A mapper that gets SIGTERM finishes its session, and answers requests until it gets another one. When this
    # supervisor is killed the session must remain unfinished, so that --resume can continue it.
    return Process("mapper", command(choice.resume), folder, restart_command=lambda: command(True), death_signal="KILL")


def segmenter_process(choice, folder):
    own = [f"--out={choice.out}", "--exit-on-final", f"--linger={linger_s(choice)}",
           "--save=" + folder.file("segmenter.map"), "--save-every=5", "--resume-if-saved",
           *map_option(map_name(choice), choice.segmenter)]
    return Process("segmenter", [program("segmenter"), *with_given(own, choice.segmenter)], folder)


def viewer_process(choice, folder):
    own = [f"--out={choice.out}", "--exit-on-final", *map_option(map_name(choice), choice.viewer),
           *(["--video=" + folder.file("run.mp4")] if choice.video else [])]
    return Process("viewer", [program("viewer"), *with_given(own, choice.viewer)], folder)


def detector_process(choice, folder):
    """Exits when it has examined the whole map."""
    own = [*library_option(options.DETECTOR, choice), "--exit-on-final", f"--json={folder.file('objects.json')}",
           *map_option(map_name(choice), choice.detector)]
    return Process("detector", [*command_of("detector"), *with_given(own, choice.detector)], folder)


def logger_processes(folder, recording):
    """The one that writes the log, and the one that requests what the log lacks."""
    url = os.environ.get("LCM_DEFAULT_URL")
    return (Process("logger", ["lcm-logger", "-q", "-a", *([f"--lcm-url={url}"] if url else []),
                               str(recording.partial)], folder),
            Process("completion", [program("complete-log"), str(recording.partial)], folder))


def end_recording(logger, recording):
    """Stops the logger; the log of the bus gets its name when it is complete. Returns whether that worked."""
    stop([logger], signal.SIGINT, 10)
    try:
        recording.end()
    except OSError as error:
        say(f"{recording.file} is not written: {error.strerror}")
        return False
    return True


def replay(arguments):
    choice = options.parse_replay(arguments)
    network.use_bus_key(choice.bus_key)
    if not begins_as_log(choice.log):
        raise Problem(f"{choice.log}: not an LCM log: it does not begin with an event")
    check_programs([*choice.only, "status"], ["setpriv", "lcm-logplayer"])
    network.choose_network(choice.private, this_command())
    folder = RunFolder(choice.out)
    folder.lock_if_used()
    check_options({name: [*library_option(name, choice), *getattr(choice, name)] for name in choice.only})
    folder.create()
    folder.lock()
    folder.remove_earlier_replay()
    network.tell_how_to_ask()
    return run_replay(choice, folder)


def run_replay(choice, folder):
    since = time.time() - 0.1  # the clock of a file system may be a little behind
    url = os.environ.get("LCM_DEFAULT_URL")
    player = Process("player", ["lcm-logplayer", *(["-l", url] if url else []), "-s", choice.speed,
                                "-e", REPLAYED_CHANNELS, choice.log], folder)
    own = {"segmenter": [f"--out={choice.out}", "--exit-on-final", f"--linger={UNTIL_TOLD}"],
           "detector": [*library_option(options.DETECTOR, choice), "--exit-on-final",
                        f"--json={folder.file('objects.json')}"],
           "viewer": [f"--out={choice.out}", "--exit-on-final"]}
    listeners = [Process(name, [*command_of(name), *with_given(own[name], getattr(choice, name))], folder)
                 for name in choice.only]
    with supervised(folder, [player, *listeners]) as supervisor:
        for process in listeners:
            process.start()
        wait_until_ready(supervisor, listeners)
        player.start()
        good = supervisor.watch()
        show_summary(folder, listeners, since)
        supervisor.tell_failures()
    return 0 if good else 1


def wait_until_ready(supervisor, processes):
    """All have to listen before a log is played, because nobody sends its slices again."""
    names = [process.name for process in processes]

    def give_up():
        return supervisor.num_stop_requests or not all(process.running for process in processes)

    if supervisor.status.hears(names, READY_TIMEOUT_S, give_up):
        return
    if supervisor.num_stop_requests:
        raise Problem("stopped before the log was played", INTERRUPTED)
    say(f"{','.join(names)} did not come up:")
    for process in processes:
        process.show_last_words()
    raise Problem("the log was not played")
