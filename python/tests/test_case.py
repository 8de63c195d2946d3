"""Cases made in Python have the same checks and messages as those from files."""

import tomllib

import numpy
import pytest

import ricochet as rc


def dictionary(path):
    with open(path, "rb") as file:
        return tomllib.load(file)


def test_dictionaries_are_what_files_are(puck, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path / "puck")  # the mesh is here
    from_file, made = rc.Case(puck), rc.Case(dictionary(puck))
    same = {key: value for key, value in made.values.items() if key != "mesh.file"}
    assert same == {key: value for key, value in from_file.values.items() if key != "mesh.file"}
    assert made.title == from_file.title


def test_every_shipped_case_survives_being_a_dictionary(cases, monkeypatch):
    for path in sorted(cases.glob("*/*.toml")):
        monkeypatch.chdir(path.parent)
        from_file, made = rc.Case(path), rc.Case(dictionary(path))
        files = {key for key in made.values if key.endswith((".file", ".table"))}
        assert {k: v for k, v in made.values.items() if k not in files} == {k: v for k, v in from_file.values.items() if k not in files}


def test_messages_name_the_entry(puck):
    table = dictionary(puck)
    table["time"]["step"] = -1.0
    table["contact"][0]["frction"] = 0.3
    with pytest.raises(rc.InputError) as caught:
        rc.Case(table)
    assert 'case["time"]["step"]: "step" must be a positive number' in str(caught.value)
    assert 'case["contact"][0]["frction"]: unknown key "frction"' in str(caught.value)
    assert 'did you mean "friction"?' in str(caught.value)
    assert "<case" not in str(caught.value)


def test_messages_of_files_name_the_line(puck):
    text = open(puck).read().replace("friction = 0.3", "friction = -0.3")
    with open(puck, "w") as file:
        file.write(text)
    with pytest.raises(rc.InputError) as caught:
        rc.Case(puck)
    line = next(number for number, content in enumerate(text.splitlines(), 1) if "friction = -0.3" in content)
    assert [(place.file, place.line) for place in caught.value.places] == [(puck, line)]
    assert isinstance(caught.value, ValueError) and caught.value.exit_status == 2


def test_what_the_mesh_says_names_the_entry_too(puck, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path / "puck")
    table = dictionary(puck)
    table["contact"][0]["group"] = "skinn"
    with pytest.raises(rc.InputError, match=r'case\["contact"\]\[0\]\["group"\]: .*skinn'):
        rc.Case(table).check()


def test_values_of_numpy_and_odd_texts(puck, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path / "puck")
    table = dictionary(puck)
    table["title"] = 'quotes " and \\ and\nlines, Grüße, \x07'
    table["initial"]["velocity"] = numpy.array([1.5, -0.5])
    table["time"]["step"] = numpy.float64(1e-6)
    table["mesh"]["degree"] = numpy.int32(1)
    assert rc.Case(table).title == table["title"]
    table["time"]["step"] = {1, 2}
    with pytest.raises(rc.InputError, match=r'case\["time"\]\["step"\]: a value of type set'):
        rc.Case(table)


def test_values_that_no_case_has(puck, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path / "puck")
    for wrong in (2**63, -10**30, 10**5000, numpy.uint64(2**64 - 1)):
        table = dictionary(puck)
        table["mesh"]["degree"] = wrong
        with pytest.raises(rc.InputError, match=r'case\["mesh"\]\["degree"\]: integers'):
            rc.Case(table)
    table = dictionary(puck)
    around = []
    around.append(around)
    for itself in (table, around):
        table["mesh"]["own"] = itself
        with pytest.raises(rc.InputError, match="contains itself"):
            rc.Case(table)


def test_numbers_are_exact(puck):
    for value in (0.1, 1 / 3, 1e-300, 5e-324, 123456789.123456789):
        assert float(rc.Case(puck, {"material.0.damping.mass": value}).values["material.0.damping.mass"]) == value


def test_changes(puck):
    assert rc.Case(puck, {"contact.0.friction": 0.2}).values["contact.0.friction"] == "0.2"
    assert rc.Case(rc.Case(puck, {"contact.0.friction": 0.2}), ["time.step=2e-6"]).values["contact.0.friction"] == "0.2"
    with pytest.raises(rc.InputError, match="did you mean"):
        rc.Case(puck, {"time.stp": 1})
    with pytest.raises(rc.UsageError, match="a dictionary"):
        rc.Case(puck, "time.step=1")
    with pytest.raises(rc.FileAccessError):
        rc.Case("nowhere.toml")
    with pytest.raises(OSError):
        rc.Case("nowhere.toml")


def test_a_run_of_a_dictionary_goes_on_with_the_program(puck, monkeypatch, tmp_path, program):
    import subprocess

    monkeypatch.chdir(tmp_path / "puck")
    table = dictionary(puck)
    table["time"]["end"] = 4e-5
    del table["expect"]
    with rc.Session(table) as session:
        session.write_to(tmp_path / "out")
        session.run(lambda s: s.step_number < 20)
    monkeypatch.chdir(tmp_path)
    outcome = subprocess.run([program, "run", "--resume", tmp_path / "out"], capture_output=True, text=True)
    assert outcome.returncode in (0, 5), outcome.stderr
    assert rc.open(tmp_path / "out").status == "done"
    whole = rc.run(puck, tmp_path / "whole", {"time.end": 4e-5})
    assert (whole.history["total_energy"] == rc.open(tmp_path / "out").history["total_energy"]).all()
