"""What the library says goes to Python's logger "ricochet": warnings are shown unless a program decides otherwise, notes are
not. `logging.getLogger("ricochet").setLevel("INFO")` (with a handler, as logging.basicConfig() makes one) shows them."""

import logging

from . import places

logger = logging.getLogger("ricochet")
# In the order of the library's levels.
LEVELS = (logging.DEBUG, logging.DEBUG, logging.INFO, logging.WARNING, logging.ERROR)


def from_core(level, message):
    logger.log(LEVELS[min(level, len(LEVELS) - 1)], "%s", places.translate(message))
