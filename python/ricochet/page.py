"""View of a run in a notebook: its results, warnings and a picture."""

import base64
import html
import io

from .messages import logger


def rows_of(run):
    """Yields (name, value) of the main results."""
    summary = run.summary
    yield "status", run.status + (f": {summary['message']}" if summary["message"] else "")
    yield "scheme, mass", f"{summary['scheme']}, {summary['mass']}"
    yield "size", f"{summary['nodes']} nodes, {summary['contact_points']} contact points, {summary['steps']} steps"
    energy = summary["extrema"].get("total_energy")
    if energy:
        yield "total energy", f"{energy['first']:.6g} at the start, {energy['last']:.6g} at the end"
    for number, impact in enumerate(run.impacts[:3]):
        restitution = impact["restitution"]
        if restitution is None:
            restitution = "none" + (f" ({impact['why_no_restitution']})" if impact["why_no_restitution"] else "")
        else:
            restitution = f"{restitution:.4g}" + (" (inexact)" if impact["restitution_inexact"] else "")
            if abs(impact["restitution_by_turning"]) > 0.01:
                restitution += " (beyond small strain)"
        yield f"impact {number + 1}", (f"t = {impact['begin']:.4g}, for {impact['duration']:.4g}; restitution {restitution}; largest "
                                       f"force {impact['largest_force']:.4g}")
    if len(run.impacts) > 3:
        yield "", f"and {len(run.impacts) - 3} more impacts: run.impacts"
    yield "interpenetration", penetration_of(summary)
    peak = summary["peak_stress"]
    if peak:
        place = ", ".join(f"{x:.4g}" for x in peak["place"])
        remark = f"; grows with refinement: it sits on {peak['sits_on']}" if peak["sits_on"] else ""
        yield "largest von Mises stress", f"{peak['von_mises']:.4g} at t = {peak['time']:.4g}, position ({place}){remark}"
    for entry in run._broken_expectations():
        yield "expectation", run._text_of(entry)


def penetration_of(summary):
    """Returns the deepest penetration of contact nodes, penetrations that no contact prevents, and the checks left out."""
    watched = summary["unwatched_penetration"]
    of_contacts = f"{summary['extrema'].get('max_penetration', {'maximum': 0.0})['maximum']:.3g} of contact nodes"
    texts = [of_contacts] + [f"{' and '.join(found['bodies'])}{_where(found)}, {found['depth']:.3g} at t = {found['time']:.4g}"
                             for found in watched["found"]]
    return "; ".join(texts + [f"not watched: {what}" for what in watched["not_watched"]])


def _where(found):
    if found["obstacle"]:
        return f" in {found['obstacle']}"
    return " in itself" if len(found["bodies"]) == 1 else ""


def image_of(run):
    """Returns the body in the frame closest to the largest stress, as PNG in base64; None if nothing can be shown."""
    try:
        import matplotlib
        from matplotlib import pyplot
    except ImportError:
        return None
    if len(run.frames) == 0:
        return None
    peak = run.summary["peak_stress"]
    frame = run.frames[int(abs(run.frames.times - peak["time"]).argmin())] if peak else run.frames[-1]
    field = "von_mises" if "von_mises" in run.fields else "displacement"
    with matplotlib.rc_context():
        drawn = frame.plot(field)
        file = io.BytesIO()
        drawn.savefig(file, format="png", dpi=80)
        pyplot.close(drawn)
    return base64.b64encode(file.getvalue()).decode()


def page_of(run):
    rows = "".join(f"<tr><td style='text-align:left'>{html.escape(what)}</td><td style='text-align:left'>{html.escape(str(value))}</td></tr>"
                   for what, value in rows_of(run))
    warnings = "".join(f"<li>{html.escape(text)}</li>" for text in run.warnings)
    try:
        image = image_of(run)
    except Exception as problem:  # the table still shows the results
        logger.warning("the picture of %s cannot be drawn: %s", run.directory, problem)
        image = None
    picture = f"<img alt='the body' src='data:image/png;base64,{image}'>" if image else ""
    return (f"<div><b>{html.escape(run.summary['title'] or run.directory)}</b><table>{rows}</table>"
            + (f"<details open><summary>{len(run.warnings)} warnings</summary><ul>{warnings}</ul></details>" if warnings else "")
            + picture + "</div>")
