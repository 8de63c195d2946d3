"""Cases that were made of dictionaries are read as texts under names that no file has. Where a message names a line of such a
text, users see the entry of the dictionary."""

import itertools
import re
import weakref

_numbers = itertools.count(1)
_known: "weakref.WeakValueDictionary[str, Lines]" = weakref.WeakValueDictionary()


class Lines:
    """Of the lines of a text the entries that they are made from."""

    def __init__(self, entries):
        self.entries = entries
        self.name = f"<case {next(_numbers)}>"
        _known[self.name] = self


def entry(path):
    """A path of keys and numbers as Python would write it: case["contact"][0]["group"]."""
    return "case" + "".join(f"[{key!r}]" if isinstance(key, int) else f'["{key}"]' for key in path)


# What messages call options of the program are arguments here.
ARGUMENTS = (("with --force", "with force=True"), ("(--force)", "(force=True)"), ("with --resume", "with resume=True"),
              (" with -o", ""), (" (-o)", ""))


def translate(message):
    """The message with entries in the place of lines, and arguments in that of options."""
    for option, argument in ARGUMENTS:
        message = message.replace(option, argument)

    def named(match):
        lines = _known.get(match.group(1))
        number = int(match.group(2) or 0)
        if lines is None or not number:
            return "case" if lines is not None else match.group(0)
        return entry(lines.entries[min(number, len(lines.entries)) - 1])

    return re.sub(r"(<case \d+>)(?::(\d+)(?::\d+)?)?", named, message)
