"""A document with a place for each section, between `<!-- bench:NAME -->` and `<!-- /bench:NAME -->`."""

import os
import re
from pathlib import Path

from trio.messages import Problem


def place(name):
    return re.compile(rf"(<!-- bench:{re.escape(name)} -->\n)(.*?)(<!-- /bench:{re.escape(name)} -->)", re.DOTALL)


class Document:
    def __init__(self, file):
        self.file = Path(file)

    def text(self):
        try:
            return self.file.read_text()
        except FileNotFoundError:
            raise Problem(f"there is no file {self.file}") from None

    def check(self, names):
        """Raises Problem unless each section has exactly one place."""
        text = self.text()
        for name in names:
            count = len(place(name).findall(text))
            if count != 1:
                raise Problem(f"{self.file} has {count or 'no'} places for section '{name}': expected one "
                              f"'<!-- bench:{name} -->' line and, below it, one '<!-- /bench:{name} -->' line")

    def sections(self):
        """What stands in each place."""
        names = re.findall(r"<!-- bench:([\w-]+) -->", self.text())
        return {name: match[2] for name in names if (match := place(name).search(self.text()))}

    def replace(self, name, content):
        """The file is written beside and renamed, so that it is never half written."""
        self.check([name])
        text = place(name).sub(lambda match: f"{match[1]}\n{content.strip()}\n\n{match[3]}", self.text())
        beside = self.file.with_name(self.file.name + ".partial")
        try:
            beside.write_text(text)
            os.replace(beside, self.file)
        finally:
            beside.unlink(missing_ok=True)
