"""Reading of runs: histories, fields, results, and the view in a notebook."""

import pickle
import tomllib

import numpy
import pytest

import ricochet as rc
from conftest import ROOT
from ricochet.page import penetration_of


def run_puck(folder, file_format):
    return rc.run(ROOT / "cases/puck/puck.toml", folder / file_format,
                  {"output.fields_every": 100, "output.fields": ["all"], "output.format": file_format})


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return run_puck(tmp_path_factory.mktemp("run"), "xdmf")


def test_history_is_what_is_in_the_file(run):
    table = numpy.genfromtxt(run.directory + "/history.csv", delimiter=",", names=True, deletechars="")
    assert list(table.dtype.names) == list(run.history)
    for name in run.history:
        assert (table[name] == run.history[name]).all()
    assert (run.time == table["time"]).all()
    assert not run.history["time"].flags.writeable
    with pytest.raises(KeyError, match="contact_force_y"):
        run.history["contact_force_z"]
    assert (run.history.to_pandas()["kinetic_energy"].to_numpy() == table["kinetic_energy"]).all()


def test_columns_of_probes_with_rows_of_their_own(tmp_path):
    run = rc.run(ROOT / "cases/puck/puck.toml", tmp_path / "out", {"time.end": 2e-5, "probe.1.every": 3, "output.fields_every": 0})
    names = list(run.history)
    assert "centre.displacement_y" in names
    assert len(set(names)) == len(names) == len(run.history)
    assert len(run.history["centre.displacement_y"]) < len(run.history["time"])


def test_columns_share_the_memory_that_was_read(run):
    column, once_more = run.history["time"], run.history["time"]
    # Both are kept: the memory of a discarded copy could be reused for the next one.
    assert column.ctypes.data == once_more.ctypes.data
    again = rc.open(run.directory)
    kept = again.history["time"]
    del again
    assert (kept == column).all()


def test_frames_agree_with_meshio(run):
    import meshio

    with meshio.xdmf.TimeSeriesReader(run.directory + "/results.xdmf") as reader:
        points, cells = reader.read_points_cells()
        assert (points[:, :2] == run.points).all()
        assert [(block.type, block.data.tolist()) for block in cells] == [(kind, nodes.tolist()) for kind, nodes in run.cells]
        assert reader.num_steps == len(run.frames)
        for number in range(reader.num_steps):
            time, at_points, at_cells = reader.read_data(number)
            frame = run.frames[number]
            assert frame.time == time
            for name, values in at_points.items():
                assert numpy.array_equal(frame[name], values, equal_nan=True)
            for name, values in at_cells.items():
                assert numpy.array_equal(frame[name], numpy.concatenate(values), equal_nan=True)
    mesh = run.frame(number=-1).to_meshio()
    assert numpy.array_equal(mesh.point_data["displacement"], run.frame(number=-1)["displacement"])


def test_frames_are_found_by_time(run):
    times = run.frames.times
    assert run.frame(t=times[3] * 1.001).number == 3
    assert [frame.number for frame in run.frames[1:4]] == [1, 2, 3]
    assert run.frames[-1].time == times[-1]
    for wrong in (-1e-3, 1.0, numpy.nan):
        with pytest.raises(rc.UsageError, match="outside"):
            run.frame(t=wrong)
    with pytest.raises(IndexError):
        run.frames[1000]
    with pytest.raises(KeyError, match="von_mises"):
        run.frames[0]["von_misses"]


def test_answers(run):
    peak = run.maximum("von_mises")
    assert peak.value == run.summary["peak_stress"]["von_mises"] and len(peak.place) == 2
    assert peak.value >= max(frame["von_mises"].max() for frame in run.frames)
    far = run.maximum("displacement")
    assert far.among == "frames" and far.value == numpy.linalg.norm(run.frame(t=far.time)["displacement"], axis=1).max()
    force = run.maximum("contact_force_y")
    assert force.value == run.history["contact_force_y"].max() and force.place is None
    assert 0.9 < run.impacts[0]["restitution"] < 1.0
    for entries, misspelt, meant in ((run.impacts[0], "restituton", "restitution"), (run.summary, "stepss", "steps")):
        with pytest.raises(KeyError, match=f'there is no entry "{misspelt}"; choose from .*{meant}'):
            entries[misspelt]
    assert run.summary.get("stepss") is None and "stepss" not in run.summary
    with pytest.raises(KeyError, match='no field or column of the history "nothing"'):
        run.maximum("nothing")
    with pytest.raises(KeyError, match="no field or column .*choose from von_mises"):
        run.maximum("von_misses")


def test_fields_that_were_not_written(tmp_path):
    """They are told from names that no field has, with the key that writes them."""
    short = rc.run(ROOT / "cases/puck/puck.toml", tmp_path / "short", {"time.end": 1e-5})
    for look in (short.maximum, short.frames[-1].__getitem__):
        with pytest.raises(KeyError, match='has not written the field "nodal_von_mises": add it to output.fields .* displacement, '):
            look("nodal_von_mises")


def test_expectations(run, tmp_path, caplog):
    assert run.check() is run
    case = {"expect": [{"quantity": "max(history.total_energy)", "maximum": 1.0}]}
    path = ROOT / "cases/puck/puck.toml"
    table = {**tomllib.loads(path.read_text()), **case}
    table["mesh"]["file"] = str(path.parent / "puck.msh")
    table["time"]["end"] = 1e-5
    broken = rc.run(table, tmp_path / "out")
    assert "expected max(history.total_energy)" in caplog.text
    with pytest.raises(rc.ExpectationError, match="expected max"):
        broken.check()


def test_a_page_shows_answers_warnings_and_a_picture(run):
    page = run._repr_html_()
    assert "restitution" in page and "von Mises" in page and "data:image/png;base64" in page
    assert "interpenetration" in page and "of contact nodes" in page and "not watched" not in page
    assert page.count("<div>") == page.count("</div>")


def test_a_page_names_what_was_not_watched():
    summary = {"extrema": {"max_penetration": {"maximum": 0.0}}, "unwatched_penetration": {"found": [
        {"obstacle": None, "bodies": ["the body"], "depth": 0.25, "time": 2.0}], "not_watched": ["this"]}}
    assert penetration_of(summary) == ("0 of contact nodes; the body in itself, 0.25 at t = 2; "
                                                      "not watched: this")


def test_what_is_no_run(tmp_path):
    with pytest.raises(rc.FileAccessError):
        rc.open(tmp_path)
    with pytest.raises(rc.FileAccessError):
        rc.open(tmp_path / "nothing")


def test_both_formats_hold_the_same(run, tmp_path):
    other = run_puck(tmp_path, "vtkhdf")
    assert other.fields == run.fields and (other.frames.times == run.frames.times).all()
    assert (other.points == run.points).all()
    assert all(kind == theirs and (nodes == those).all() for (kind, nodes), (theirs, those) in zip(other.cells, run.cells))
    for mine, theirs in zip(run.frames, other.frames):
        for name in run.fields:
            assert numpy.array_equal(mine[name], theirs[name], equal_nan=True), name
    assert other.maximum("displacement") == run.maximum("displacement")


@pytest.mark.parametrize("file_format", ["xdmf", "vtkhdf"])
def test_a_run_that_was_written_over_is_not_mixed_with_the_old_one(tmp_path, file_format):
    path, short = ROOT / "cases/puck/puck.toml", {"time.end": 1e-5, "output.fields_every": 5, "output.format": file_format}
    old = rc.run(path, tmp_path / "out", short)
    rc.run(path, tmp_path / "out", {**short, "contact.0.friction": 0.0}, force=True)
    with pytest.raises(rc.InputError, match="read them again"):
        old.frame(number=-1)["displacement"]
    assert old.reload().frame(number=-1)["displacement"].shape == (len(old.points), 3)


@pytest.mark.parametrize("file_format", ["xdmf", "vtkhdf"])
def test_a_run_that_goes_on_can_be_read(puck, tmp_path, file_format):
    session = rc.Session(puck, {"time.end": 1e-4, "output.fields_every": 10, "output.format": file_format})
    session.write_to(tmp_path / "out")
    session.run(lambda s: s.step_number < 50)
    # Recent data may still be in memory; the data in the files are consistent.
    run = rc.open(tmp_path / "out")
    assert run.status == "running"
    assert len(run.time) >= 1
    kept = [frame["displacement"].copy() for frame in run.frames]
    session.run()
    session.finish()
    assert len(kept) >= 1 and all((run.frames[number]["displacement"] == kept[number]).all() for number in range(len(kept)))
    assert run.reload().status == "done" and len(run.time) == 101 and len(run.frames) == 11


def test_a_session_that_is_dropped_leaves_an_interrupted_run(puck, tmp_path):
    session = rc.Session(puck, {"time.end": 1e-4})
    session.write_to(tmp_path / "out")
    session.run(lambda s: s.step_number < 50)
    assert rc.open(tmp_path / "out").status == "running"
    del session
    assert rc.open(tmp_path / "out").status == "interrupted"
    assert rc.run(puck, tmp_path / "out", {"time.end": 1e-4}, resume=True).status == "done"


def test_a_loop_that_ends_early_leaves_its_last_state(puck, tmp_path):
    """Also if no frame was due; a run that continues from there has the bytes of one that was never stopped."""
    changes = {"time.end": 1e-4, "output.fields_every": 40, "output.history_every": 20}
    session = rc.Session(puck, changes)
    session.write_to(tmp_path / "out")
    session.run(lambda s: s.step_number < 53)
    displacement = session.displacement.copy()
    session.finish()
    run = rc.open(tmp_path / "out")
    assert run.status == "interrupted" and run.time[-1] == run.frames.times[-1] == pytest.approx(53e-6, rel=1e-12)
    assert (run.frames[-1]["displacement"][:, :2] == displacement).all()
    assert "--resume continues" in run.summary["message"]
    rc.run(puck, tmp_path / "out", changes, resume=True)
    rc.run(puck, tmp_path / "whole", changes)
    for name in ("history.csv", "results.h5", "results.xdmf"):
        assert (tmp_path / "out" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes(), name


def test_a_steered_run_says_who_goes_on(puck, tmp_path):
    session = rc.Session(puck, {"time.end": 1e-4})
    session.set_obstacle_velocity("wall", [0.0, 0.0])
    session.write_to(tmp_path / "out")
    session.run(lambda s: s.step_number < 5)
    session.finish()
    assert "the program that steers the run continues" in rc.open(tmp_path / "out").summary["message"]


def test_messages_speak_of_arguments(run, puck):
    with pytest.raises(rc.FileAccessError, match="resume=True.*force=True") as caught:
        rc.run(puck, run.directory)
    assert "--" not in str(caught.value)[len(run.directory):]


def test_a_frame_is_found_by_a_time(run):
    with pytest.raises(rc.UsageError, match="is not a time"):
        run.frame("von_mises")


def test_errors_can_be_pickled():
    problem = pickle.loads(pickle.dumps(rc.InputError("a.toml:3:4: wrong")))
    assert problem.places == [rc.Place("a.toml", 3, 4)] and str(problem) == "a.toml:3:4: wrong"


@pytest.mark.parametrize("file_format", ["xdmf", "vtkhdf"])
def test_damaged_fields_are_errors(tmp_path, file_format):
    """They do not end the process, as HDF5 itself would on some of them."""
    made = run_puck(tmp_path, file_format)
    path = tmp_path / file_format / ("results.h5" if file_format == "xdmf" else "results.vtkhdf")
    whole, field = path.read_bytes(), made.frame(number=0)["von_mises"]
    at = whole.find(b"FHDB")
    if at >= 0:
        path.write_bytes(whole[:at + 64] + b"\xff" * 64 + whole[at + 128:])
        with pytest.raises(rc.InputError, match="damaged"):
            rc.open(made.directory)
        with pytest.raises(rc.InputError, match="damaged"):
            made.frame(number=0)["von_mises"]
    chance = numpy.random.default_rng(1)
    for _ in range(40):
        content = numpy.frombuffer(whole, dtype=numpy.uint8).copy()
        begin = int(chance.integers(len(content)))
        content[begin:begin + 256] ^= chance.integers(256, size=len(content[begin:begin + 256]), dtype=numpy.uint8)
        path.write_bytes(content.tobytes())
        try:
            for frame in rc.open(made.directory).frames:
                dict(frame)
        except rc.InputError as problem:
            assert "damaged" in str(problem) or "where" in str(problem)
    path.write_bytes(whole)
    assert (rc.open(made.directory).frame(number=0)["von_mises"] == field).all()
