"""Names of quantities in [[expect]]."""

import re


def column_and_time(case, quantity):
    """The column and the time of history.COLUMN(t=T), or of the first or the last row of it; else no column."""
    found = re.fullmatch(r"history\.(.+)(?:\(t=(.+)\)|\[(0|-1)\])", quantity)
    if not found:
        return None, 0.0
    column, time, row = found.groups()
    return column, float(time) if time else 0.0 if row == "0" else case["time"]["end"]
