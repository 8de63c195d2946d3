"""Positions in cases made from dictionaries. Such a case is read as a text, under a name that no file has; messages about a line
of the text show the entry of the dictionary."""

import itertools
import re
import weakref

_numbers = itertools.count(1)
_known: "weakref.WeakValueDictionary[str, Lines]" = weakref.WeakValueDictionary()


class Lines:
    """The entries from which the lines of a text are made."""

    def __init__(self, entries):
        self.entries = entries
        self.name = f"<case {next(_numbers)}>"
        _known[self.name] = self


def entry(path):
    """Returns a path of keys and numbers in Python's notation: case["contact"][0]["group"]."""
    return "case" + "".join(f"[{key!r}]" if isinstance(key, int) else f'["{key}"]' for key in path)


# Options of the program in messages, and the corresponding arguments.
ARGUMENTS = (("with --force", "with force=True"), ("(--force)", "(force=True)"), ("with --resume", "with resume=True"),
              (" with -o", ""), (" (-o)", ""))


def translate(message):
    """Returns the message with entries instead of lines and arguments instead of options."""
    for option, argument in ARGUMENTS:
        message = message.replace(option, argument)

    def named(match):
        lines = _known.get(match.group(1))
        number = int(match.group(2) or 0)
        if lines is None or not number:
            return "case" if lines is not None else match.group(0)
        return entry(lines.entries[min(number, len(lines.entries)) - 1])

    return re.sub(r"(<case \d+>)(?::(\d+)(?::\d+)?)?", named, message)
