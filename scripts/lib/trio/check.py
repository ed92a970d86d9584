"""Whether the processes of a run accept their options, asked before anything of the run is started or written."""

import subprocess

from .messages import Problem
from .programs import called, command_of

HINT = "Run with --help for more information."  # CLI11's, without the name of the program


def check_options(commands, folder=None):
    """Raises Problem, with exit code 2, unless each command of a process ({name: words}) accepts its options, and
    the mapper its device. `folder`: for relative paths; None: the current one."""
    for name, words in commands.items():
        done = subprocess.run([*command_of(name), "--check", *words], cwd=folder, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, errors="replace", check=False)
        if done.returncode:
            raise Problem(f"{name}: {reason(name, done)}", 2)


def reason(name, done):
    """What a process said, in one line if it said one."""
    text = done.stderr.strip().removeprefix(f"{called(name).split()[0]}: ")
    if HINT in text:
        text = f"{text.replace(HINT, '').strip()}; see {called(name)} --help"
    if text:
        return text
    return f"--check ended with exit code {done.returncode}, without a word"
