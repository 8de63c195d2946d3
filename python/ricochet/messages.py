"""Messages of the library, for Python's logger "ricochet". Unless a program changes this, warnings are shown and notes are not.
`logging.getLogger("ricochet").setLevel("INFO")`, with a handler such as that of logging.basicConfig(), shows the notes."""

import logging

from . import places

logger = logging.getLogger("ricochet")
# Python's levels in the order of the library's.
LEVELS = (logging.DEBUG, logging.DEBUG, logging.INFO, logging.WARNING, logging.ERROR)


def from_core(level, message):
    logger.log(LEVELS[min(level, len(LEVELS) - 1)], "%s", places.translate(message))
