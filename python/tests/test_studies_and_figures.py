"""Studies and figures have the results of the program."""

import csv
import subprocess

import matplotlib
import numpy
import pytest

import ricochet as rc

matplotlib.use("Agg")
SHORT = {"time.end": 6e-4}


def test_a_study_is_that_of_the_program(puck, tmp_path, program):
    study = rc.study(puck, {"contact.0.friction": [0.0, 0.3]}, tmp_path / "python", SHORT, jobs=2)
    arguments = ["--vary", "contact.0.friction=0,0.3", "--set", "time.end=6e-4", "-o", tmp_path / "program", "--jobs", "2"]
    subprocess.run([program, "study", puck, *arguments], check=True, capture_output=True)
    with open(tmp_path / "program/study.csv") as file:
        rows = list(csv.DictReader(file))
    assert [row["contact.0.friction"] for row in rows] == ["0", "0.3"]
    for name in rows[0]:
        if "seconds" in name:
            continue
        expected, found = [row[name] for row in rows], study[name]
        if found.dtype.kind == "f":
            expected = [float(text) if text else numpy.nan for text in expected]
            assert numpy.array_equal(found, expected, equal_nan=True), name
    assert study.done == 2
    assert study.table["contact.0.friction"].tolist() == study["contact.0.friction"].tolist()
    runs = study.runs
    assert len(runs) == 2 and runs[0].history["friction_work"][-1] == 0 > runs[1].history["friction_work"][-1]
    assert "<table>" in study._repr_html_()
    again = rc.open_study(tmp_path / "python")
    assert again.columns == study.columns and again.done == 2
    more = rc.study(puck, {"contact.0.friction": [0.0, 0.3, 0.5]}, tmp_path / "python", SHORT, resume=True)
    assert more.done == 3
    with pytest.raises(rc.FileAccessError, match="already contains a study"):
        rc.study(puck, {"contact.0.friction": [0.0]}, tmp_path / "python", SHORT)
    with pytest.raises(KeyError):
        study["nothing"]


def test_a_study_of_a_dictionary(tmp_path):
    from test_mesh import CASE, square

    points, quads = square()
    mesh = rc.Mesh(points, {"quad": quads}, {"bottom": numpy.flatnonzero(points[:, 1] < 0.01)})
    study = rc.study(CASE, {("time.step", "time.end"): [(1e-4, 2e-3), (5e-5, 2e-3)]}, tmp_path / "study", mesh=mesh)
    assert study.done == 2 and study["time.step"].tolist() == [1e-4, 5e-5]


def test_reports_go_where_paths_say(puck, tmp_path):
    run = rc.run(puck, tmp_path / "out", SHORT)
    for path in (tmp_path / "a.html", str(tmp_path / "b.html")):
        assert run.report(path) == str(path)
    assert (tmp_path / "a.html").read_bytes() == (tmp_path / "b.html").read_bytes()
    with pytest.raises(rc.FileAccessError, match="none"):
        run.report(tmp_path / "none" / "a.html")


def test_wrong_studies(puck, tmp_path):
    with pytest.raises(rc.UsageError, match="must be a list"):
        rc.study(puck, {"time.step": 1e-6}, tmp_path / "study")
    with pytest.raises(rc.UsageError, match="change together"):
        rc.study(puck, {("time.step", "time.end"): [1e-6]}, tmp_path / "study")
    for wrong in ({"threads": 0}, {"threads": -1}, {"threads": 1.5}, {"jobs": -1}, {"jobs": "2"}, {"jobs": 2000}):
        with pytest.raises(rc.UsageError, match="must be an integer"):
            rc.study(puck, {"time.step": [1e-6]}, tmp_path / "study", **wrong)
    with pytest.raises(rc.UsageError, match="a dictionary of keys"):
        rc.study(puck, ["time.step"], tmp_path / "study")
    with pytest.raises(rc.Error, match="stp"):
        rc.study(puck, {"time.stp": [1e-6]}, tmp_path / "study")


def test_figures_have_the_bytes_of_the_program(puck, tmp_path, program):
    run = rc.run(puck, tmp_path / "out", SHORT)
    figure = run.plot("energy", "contact_force_y", title="A title")
    assert [axes.get_ylabel() for axes in figure.axes][1] != ""
    settings = dict(matplotlib.rcParams)
    with matplotlib.rc_context():
        from ricochet.figure import STYLE

        matplotlib.rcdefaults()
        matplotlib.rcParams.update(STYLE)
        run.plot("energy", "contact_force_y", title="A title").savefig(tmp_path / "python.png")
    arguments = ["--what", "energy", "--what", "contact_force_y", "--title", "A title", "-o", tmp_path / "program.png"]
    outcome = subprocess.run([program, "plot", tmp_path / "out", *arguments], capture_output=True, text=True)
    assert outcome.returncode == 0, outcome.stderr
    assert (tmp_path / "python.png").read_bytes() == (tmp_path / "program.png").read_bytes()
    assert dict(matplotlib.rcParams) == settings, "a user's own settings stay"
    with pytest.raises(rc.Error, match="nothing"):
        run.plot("nothing")


def test_pictures_show_what_the_fields_say(puck, tmp_path):
    run = rc.run(puck, tmp_path / "out", {"time.end": 6e-4, "output.fields_every": 200})
    frame = run.frame(number=-1)
    figure = frame.plot("von_mises", limits=(0, 1e5))
    (collection,) = [c for c in figure.axes[0].collections if len(c.get_facecolor()) > 10]
    assert len(collection.get_facecolor()) == sum(len(nodes) for _, nodes in run.cells)
    assert figure.axes[1].get_ylabel() == "von Mises stress"
    low, high = figure.axes[0].get_xlim()
    assert low < frame.positions[:, 0].min() and high > frame.positions[:, 0].max()
    report = run.report()
    assert open(report).read().startswith("<!")
    named = run.report(tmp_path / "named.html")
    assert named == str(tmp_path / "named.html") and open(named).read() == open(report).read()


def test_a_picture_comes_near_to_what_touches(puck, tmp_path):
    run = rc.run(puck, tmp_path / "out", {"time.end": 6e-4, "output.fields_every": 200})
    frame = run.frame(number=-1)
    touching = frame.positions[frame["contact_pressure"] > 0.0]
    assert 0 < len(touching) < len(run.points)
    figure = frame.plot("von_mises", zoom=True)
    for axis, limits in enumerate((figure.axes[0].get_xlim(), figure.axes[0].get_ylim())):
        assert limits[0] < touching[:, axis].min() and touching[:, axis].max() < limits[1]
    whole = frame.plot("von_mises")
    assert numpy.diff(figure.axes[0].get_xlim()) < numpy.diff(whole.axes[0].get_xlim())


def test_an_animation_is_written_whole_or_not_at_all(puck, tmp_path):
    from PIL import Image

    run = rc.run(puck, tmp_path / "out", {"time.end": 6e-4, "output.fields_every": 200})
    path = run.animate(tmp_path / "run.gif", "velocity", size=(8, 7))
    with Image.open(path) as image:
        assert image.n_frames == len(run.frames)
    assert [file.name for file in tmp_path.iterdir() if file.is_file()] == ["run.gif"]
    with pytest.raises(rc.UsageError, match=".gif or .mp4"):
        run.animate(tmp_path / "run.avi")
    with pytest.raises(rc.UsageError, match="fewer than two frames"):
        run.animate(tmp_path / "none.gif", time=(0.1, 0.2))
