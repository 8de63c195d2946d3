"""The command line: exit statuses, use of the streams, and independence of results from threads."""

import json
import os
import re

import h5py

from harness import DISC, MESHES, PROGRAM, History, TestCase, block_case, run, settings, summary_of

NOWHERE = "/nowhere/at/all"


class CommandLine(TestCase):
    def setUp(self):
        super().setUp()
        self.case = self.write("block.toml", block_case())

    def test_wrong_use_is_status_1(self):
        for arguments, said in (((), "subcommand"),
                                (("simulate", self.case), ""),
                                (("block.toml",), "a command is missing: write `ricochet run block.toml`"),
                                (("runn", "block.toml"), 'there is no command "runn"; did you mean "run"?'),
                                (("run",), "a case file is required"),
                                (("info",), "path is required"),
                                (("validate",), "case is required"),
                                (("run", self.case, "--bogus"), "--bogus"),
                                (("run", self.case, "another"), "another"),
                                (("run", self.case, "--log-level", "loud"), "debug, info, warning, error or off"),
                                (("validate", self.case, "--log-level", "loud"), "debug, info, warning, error or off"),
                                (("run", self.case, "--threads", "0"), "threads"),
                                (("run", self.case, "--threads", "-1"), "threads"),
                                (("run", self.case, "--threads", "two"), "threads"),
                                (("run", self.case, "--set", "time.step"), "--set key.path=value"),
                                (("run", self.case, "--set", "=3"), "--set key.path=value"),
                                (("run", self.case, "-o"), "-o")):
            with self.subTest(arguments):
                process = self.expect_status(1, run(*arguments, directory=self.folder))
                self.assertIn(said, process.stderr)
                self.assertNotEqual(process.stderr, "")
                self.assertEqual(process.stdout, "")
        self.assertEqual(list(self.folder.iterdir()), [self.case], "wrong use writes nothing")

    def test_help_and_version(self):
        process = self.expect_status(0, run("--help"))
        for word in ("run", "validate", "info", "contact", "schema", "Exit status", "did not converge"):
            self.assertIn(word, process.stdout)
        for command, words in (("run", ("-o", "--set", "--threads", "--log-level", "--quiet", "--force",
                                        "--export-contact", "--export-contact-to")),
                               ("contact", ("--solver", "--tolerance", "-o", "--record", "--list")),
                               ("validate", ("CASE.toml",)), ("info", ("FILE_OR_DIR",)), ("schema", ("--markdown", "--columns"))):
            process = self.expect_status(0, run(command, "--help"))
            for word in words:
                self.assertIn(word, process.stdout)
            self.assertEqual(process.stderr, "")
        process = self.expect_status(0, run("--version"))
        self.assertRegex(process.stdout, r"^ricochet \d+\.\d+\.\d+\nOpenBLAS .* \(\w+\), CHOLMOD .*\n$")

    def test_invalid_case_is_status_2(self):
        self.case.write_text(block_case().replace("density", "densty"), encoding="utf-8")
        for arguments in (("validate", self.case), ("info", self.case), ("run", self.case, "-o", self.folder / "out")):
            process = self.expect_status(2, run(*arguments))
            self.assertIn('block.toml:6:1: unknown key "densty"', process.stderr)
            self.assertIn('did you mean "density"', process.stderr)
        self.assertFalse((self.folder / "out").exists())
        self.expect_status(2, run("validate", self.write("torn.toml", block_case()[:300])))

    def test_a_mesh_in_place_of_a_case_is_named_as_such(self):
        mesh = MESHES / "quadrilateral_o1_msh41_ascii.msh"
        for arguments in (("run", mesh, "-o", self.folder / "out"), ("validate", mesh), ("run", MESHES / "disc.geo", "-o", self.folder / "out")):
            process = self.expect_status(2, run(*arguments))
            self.assertIn(f"{arguments[1]}: a mesh or a geometry, not a case: a case file names it as \"file\" of its [mesh]", process.stderr)
            self.assertNotIn("TOML", process.stderr)

    def test_validate_begins_with_its_result(self):
        """The estimates follow, for those who read on."""
        first, *others = self.expect_status(0, run("validate", self.case)).stdout.splitlines()
        self.assertRegex(first, r"block\.toml: valid: \d+ nodes, ")
        self.assertTrue(any(line.startswith("estimate, stage 1 ") for line in others))

    def test_missing_files_are_status_4(self):
        missing = self.folder / "missing.toml"
        for arguments in (("run", missing), ("validate", missing), ("info", missing), ("info", NOWHERE),
                          ("run", self.folder), ("info", self.folder)):
            with self.subTest(arguments):
                process = self.expect_status(4, run(*arguments, directory=self.folder))
                self.assertIn(str(arguments[1]), process.stderr)
        process = self.expect_status(4, run("validate", self.case, "--set", f"mesh.file={NOWHERE}.msh"))
        self.assertIn(f"{NOWHERE}.msh", process.stderr)

    def test_unwritable_directory_is_status_4(self):
        # These hold for root as well: below a regular file, the file itself, and file systems that accept no folders.
        for output in (self.case / "out", self.case, "/proc/ricochet-test", "/proc/self/fd/out"):
            with self.subTest(output):
                process = self.expect_status(4, run("run", self.case, "-o", output))
                self.assertIn(str(output), process.stderr)

    def test_full_disk_is_status_4(self):
        """A limit on the size of files stands in for a full disk."""
        import resource
        import signal
        import subprocess

        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (40000, 40000))

        for name, values in (("history.csv", {"output.fields_every": 0}), ("results.h5", {"output.fields_every": 1})):
            with self.subTest(name):
                process = subprocess.run([PROGRAM, "run", self.case, "-o", self.folder / name, "--quiet",
                                          *settings(dict(values, **{"time.end": 3}))],
                                         text=True, capture_output=True, restore_signals=False, preexec_fn=limit)
                self.expect_status(4, process)
                self.assertIn(f"{name}: cannot write", process.stderr)

    def test_a_run_is_not_overwritten_without_force(self):
        output = self.simulate(self.case)
        before = {path.name: path.read_bytes() for path in output.iterdir()}
        self.assertEqual(sorted(before), ["checkpoint-000000030.ckpt", "history.csv", "obstacles.xdmf", "results.h5", "results.xdmf",
                                          "summary.json"])
        process = self.expect_status(4, run("run", self.case, "-o", output, "--quiet"))
        self.assertIn("--force", process.stderr)
        self.assertEqual({path.name: path.read_bytes() for path in output.iterdir()}, before)
        for name in before:  # any one of them marks a run
            folder = self.folder / ("only-" + name)
            folder.mkdir()
            (folder / name).write_bytes(before[name])
            self.expect_status(4, run("run", self.case, "-o", folder))
        (output / "notes.txt").write_text("mine", encoding="ascii")
        self.expect_status(0, run("run", self.case, "-o", output, "--quiet", "--force", "--set",
                                  "output.fields_every=0", "--set", "time.end=0.1"))
        self.assertEqual(sorted(path.name for path in output.iterdir()), ["checkpoint-000000010.ckpt", "history.csv", "notes.txt", "summary.json"],
                         "nothing of the old run stays, and nothing else goes")
        self.assertEqual(History(output / "history.csv")["step"], list(range(11)))

    def test_an_empty_value_is_not_the_default(self):
        """An unset variable of the shell gives one."""
        for arguments in (("run", self.case, "-o", ""), ("run", self.case, "-o", "", "--force"), ("run", ""),
                          ("run", self.case, "--export-contact", "1", "--export-contact-to", ""), ("study", self.case, "-o", ""),
                          ("benchmark", "-o", ""), ("report", "out", "-o", ""), ("report", ""), ("info", ""), ("contact", "")):
            process = self.expect_status(1, run(*arguments, directory=self.folder))
            self.assertIn("the value is empty", process.stderr, arguments)
        self.assertEqual(list(self.folder.glob("out*")), [])

    def test_a_run_does_not_write_over_what_it_is_read_from(self):
        """With --force, or through another name, it does not either."""
        folder = self.folder / "own"
        folder.mkdir()
        mesh = folder / "probes-7.csv"
        mesh.write_bytes((MESHES / "quadrilateral_o1_msh41_ascii.msh").read_bytes())
        table = folder / "history.csv"
        table.write_text("0 0 0\n1 0 0\n", encoding="ascii")
        (self.folder / "link").symlink_to(folder)
        text = block_case()
        of_mesh = self.write("mesh.toml", re.sub(r'file = ".*"', f'file = "{mesh}"', text))
        of_table = self.write("table.toml", text.replace('type = "plane"\n', f'type = "plane"\ntable = "{table}"\n'))
        case = folder / "summary.json"
        case.write_text(text, encoding="utf-8")
        for path, input_file in ((of_mesh, mesh), (of_table, table), (case, case)):
            before = {each.name: each.read_bytes() for each in folder.iterdir()}
            for output in (folder, self.folder / "link"):
                process = self.expect_status(4, run("run", path, "-o", output, "--force", "--quiet"))
                self.assertIn(f"{input_file}: the case is read from this file", process.stderr)
            self.assertEqual({each.name: each.read_bytes() for each in folder.iterdir()}, before)

    def test_a_list_without_quotes(self):
        for value, what in (("[bottom,body]", "list"), ("[bottom]", "list")):
            process = self.expect_status(2, run("validate", self.case, "--set", f"contact.0.group={value}"))
            self.assertIn(f"{value} is not a {what}: texts within it need double quotes", process.stderr)
            self.assertIn("""--set 'contact.0.group=["a", "b"]'""", process.stderr)
        self.expect_status(0, run("validate", self.case, "--set", 'contact.0.group=["bottom"]'))
        self.expect_status(0, run("validate", self.case, "--set", "title=[draft] a block"))

    def test_messages_of_quiet_runs_name_what_is_there(self):
        for arguments in (("--resume", "nothing"), ("nothing.toml",), ("block.toml", "--set", "time.step=-1")):
            process = run("run", "--quiet", *arguments, directory=self.folder)
            self.assertNotEqual(process.returncode, 0)
            self.assertNotIn("out/", process.stderr)

    def test_a_directory_of_results_is_no_case(self):
        output = self.folder / "out"
        self.expect_status(0, run("run", self.case, "-o", output, "--quiet"))
        process = self.expect_status(1, run("run", output))
        self.assertIn(f"`ricochet run --resume {output}` continues", process.stderr)

    def test_the_default_output_directory(self):
        self.expect_status(0, run("run", "block.toml", directory=self.folder))
        self.assertTrue((self.folder / "out" / "block" / "summary.json").exists())

    def test_expectation_that_does_not_hold_is_status_5(self):
        text = block_case() + '[[expect]]\nquantity = "history.total_energy[0]"\nvalue = 7.0\nrelative = 0.01\n'
        case = self.write("expecting.toml", text)
        process = self.expect_status(5, run("run", case, "-o", self.folder / "out", "--quiet"))
        self.assertRegex(process.stderr, r"expecting\.toml:\d+:\d+: expected history\.total_energy\[0\] to be 7 ")
        self.assertIn("DOES NOT HOLD", process.stdout)
        summary = summary_of(self.folder / "out")
        self.assertEqual([summary["status"], summary["expectations"][0]["holds"]], ["done", False])
        self.assertEqual(len(History(self.folder / "out" / "history.csv").rows), 31)
        case.write_text(text.replace("value = 7.0", "value = 0.0").replace("relative", "absolute"), encoding="utf-8")
        process = self.expect_status(0, run("run", case, "-o", self.folder / "held", "--quiet"))
        self.assertIn("holds", process.stdout)
        for quantity in ("history.totl_energy[0]", "summary.extrema.totl_energy.first"):
            case.write_text(text.replace("history.total_energy[0]", quantity), encoding="utf-8")
            for process in (run("run", case, "-o", self.folder / "unknown", "--quiet"), run("validate", case)):
                self.expect_status(2, process)
                self.assertRegex(process.stderr, r'expecting\.toml:\d+:\d+: history\.csv has no column "totl_energy"; did you mean "total_energy"')
        self.assertFalse((self.folder / "unknown").exists())
        # All wrong groups, and a missing mesh, are reported with their locations.
        case.write_text(text.replace('"body"', '"boddy"').replace('"bottom"', '"botom"'), encoding="utf-8")
        process = self.expect_status(2, run("validate", case))
        self.assertRegex(process.stderr, r'(?s)expecting\.toml:\d+:\d+: .*"boddy".*expecting\.toml:\d+:\d+: .*"botom"')
        for name in ("nothere.msh", "nothere.geo"):
            process = self.expect_status(4, run("validate", case, "--set", f"mesh.file={name}"))
            self.assertIn(f"nothere.{name[-3:]}; a relative path", process.stderr)

    def test_expectations_are_named_and_told_in_numbers(self):
        text = block_case() + ('[[expect]]\nname = "the energy"\nquantity = "history.total_energy(t=0)"\n'
                               'over = "max(history.step)"\ntimes = 2.0\nvalue = 7.0\nrelative = 0.01\n'
                               'published = "elsewhere: 6.9"\n')
        case = self.write("named.toml", text)
        process = self.expect_status(5, run("run", case, "-o", self.folder / "out", "--quiet"))
        self.assertIn(": expected the energy to be 7 within 0.01 relative, found ", process.stderr)
        for listed in (process.stdout, self.expect_status(0, run("info", self.folder / "out")).stdout):
            self.assertIn("DOES NOT HOLD: the energy (expected 7 within 0.01 relative, found ", listed)
            self.assertIn("published: elsewhere: 6.9", listed)
        found = summary_of(self.folder / "out")["expectations"][0]
        self.assertEqual((found["name"], found["published"]), ("the energy", "elsewhere: 6.9"))
        self.assertEqual(found["quantity"], "2 * history.total_energy(t=0) / max(history.step)")
        self.assertEqual((found["wanted_value"], found["tolerance"]), (7.0, 0.07))
        self.assertNotIn("minimum", found)
        history = History(self.folder / "out" / "history.csv")
        self.assertAlmostEqual(found["value"], 2.0 * history["total_energy"][0] / history["step"][-1], delta=1e-15)
        # A run changed by --set is not checked, and a time outside the run is reported before it begins.
        process = self.expect_status(0, run("run", case, "-o", self.folder / "changed", "--quiet", "--set", "title=other"))
        self.assertIn("1 does not apply to this run", process.stdout)
        case.write_text(text.replace("t=0)", "t=1e9)"), encoding="utf-8")
        process = self.expect_status(2, run("validate", case))
        self.assertRegex(process.stderr, r"named\.toml:\d+:\d+: the time 1e\+09 is outside the run, which extends from 0 to ")
        for wrong, meant in (("impacts.0.restituton", "impacts.0.restitution"), ("probe.0.node", "probes.0.node")):
            case.write_text(text.replace("history.total_energy(t=0)", f"summary.{wrong}"), encoding="utf-8")
            self.assertIn(f'named.toml:{text[:text.index("quantity")].count(chr(10)) + 1}:12: summary.json has no entry "{wrong}"; did you mean "{meant}"?',
                          self.expect_status(2, run("run", case, "-o", self.folder / "no")).stderr)

    def test_streams(self):
        output = self.folder / "out"
        process = self.expect_status(0, run("run", self.case, "-o", output))
        self.assertRegex(process.stderr, r"step \d+/30")
        self.assertNotRegex(process.stdout, r"step \d+/30")
        lines = process.stdout.splitlines()
        self.assertEqual(lines[0], "A block falls")
        self.assertEqual(lines[-1], f"  results in {output}")
        for said in ("30 steps of 0.01", "energy account closes to", "deepest interpenetration"):
            self.assertIn(said, process.stdout)
        # Half the time: before any warning.
        process = self.expect_status(0, run("run", self.case, "-o", output, "--force", "--quiet", "--set",
                                            "time.end=0.1"))
        self.assertEqual(process.stderr, "")
        self.assertIn("results in", process.stdout)
        process = self.expect_status(0, run("run", self.case, "-o", output, "--force", "--quiet", "--log-level",
                                            "error"))
        self.assertEqual(process.stderr, "")

    def test_progress_bar_on_a_terminal(self):
        import pty
        import subprocess
        try:
            ours, theirs = pty.openpty()
        except OSError as problem:  # a root without /dev/pts, as debootstrap leaves it
            self.skipTest(f"no terminal can be made here: {problem}")
        self.addCleanup(os.close, ours)
        process = subprocess.Popen([PROGRAM, "run", self.case, "-o", self.folder / "out"], stderr=theirs,
                                   stdout=subprocess.PIPE)
        os.close(theirs)
        shown = b""
        while True:
            try:
                piece = os.read(ours, 65536)
            except OSError:  # the other end is closed
                break
            if not piece:
                break
            shown += piece
        process.communicate()
        self.assertEqual(process.returncode, 0)
        self.assertIn(b"\r", shown.replace(b"\r\n", b"\n"))
        self.assertIn(b"30/30", shown)

    def test_overrides(self):
        def steps(*arguments):
            output = self.folder / "out"
            self.expect_status(0, run("run", self.case, "-o", output, "--force", "--quiet", *arguments))
            return summary_of(output)

        summary = steps("--set", "time.step=0.02", "--set", "time.end=0.2", "--set", "time.scheme=klr-conserving",
                        "--set", "load.gravity=[0,-5]", "--set", "title=Changed")
        self.assertEqual([summary["steps"], summary["time_step"], summary["scheme"], summary["title"]],
                         [10, 0.02, "klr-conserving", "Changed"])
        self.assertEqual(summary["overrides"], ["time.step", "time.end", "time.scheme", "load.gravity", "title"])
        self.assertEqual(steps("--set", "probe.0.name=heel")["probes"][0]["name"], "heel")
        process = self.expect_status(2, run("validate", self.case, "--set", "time.stp=1"))
        self.assertIn('--set time.stp=1: unknown key "stp" in [time]; did you mean "step"?', process.stderr)
        self.expect_status(2, run("validate", self.case, "--set", "time.step=-1"))

    def test_info(self):
        output = self.simulate(self.case)
        mesh = MESHES / "tetrahedron_o2_msh41_binary.msh"
        for path, said in ((mesh, ("dimension 3", "degree 2", "tetrahedr", '"bottom"')),
                           (self.case, ("A block falls", "newmark", "consistent", "30 steps")),
                           (output, ("A block falls", "30 steps", 'probe "foot"', "energy account closes"))):
            process = self.expect_status(0, run("info", path))
            for fragment in said:
                self.assertIn(fragment, process.stdout)
        # Energy that is missing counts as much as energy in excess.
        written = (output / "summary.json").read_text(encoding="utf-8")
        for extreme, share in (("minimum", -0.25), ("maximum", 0.25)):
            summary = json.loads(written)
            summary["extrema"]["energy_residual"][extreme] = share * summary["energy_scale"]
            (output / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
            self.assertIn("energy account closes to 2.5e-01 of the largest energy", run("info", output).stdout, extreme)
        (output / "summary.json").write_text(written, encoding="utf-8")
        other = self.simulate(self.case, "other", {"time.scheme": "midpoint"})
        process = self.expect_status(0, run("info", output, other))
        self.assertRegex(process.stdout, rf"{re.escape(str(output))} +newmark +consistent")
        self.assertRegex(process.stdout, rf"{re.escape(str(other))} +midpoint +consistent")
        methods, outcomes = process.stdout.split("\n\n")
        self.assertEqual(len(methods.splitlines()), 7)  # two of the head, two runs, a legend, and the probe of each
        for directory, line in zip((output, other), outcomes.splitlines()[1:]):
            self.assertTrue(line.startswith(f"{directory} "), line)
        self.assertIn("dimension 3", self.expect_status(0, run("info", self.case, mesh)).stdout)

    def test_info_on_garbage(self):
        for name, content in (("garbage", "garbage"), ("garbage.msh", "\0\1\2" * 100), ("garbage.toml", "]["),
                              ("empty.msh", "")):
            process = self.expect_status(2, run("info", self.write(name, content)))
            self.assertIn(name, process.stderr)
        folder = self.folder / "garbage-run"
        folder.mkdir()
        for content in ("", "{}", '{"status": 3}', "[1, 2]"):
            (folder / "summary.json").write_text(content, encoding="ascii")
            process = self.expect_status(2, run("info", folder))
            self.assertIn("not a summary of a run", process.stderr)

    def test_schema_is_json(self):
        process = self.expect_status(0, run("schema"))
        schema = json.loads(process.stdout)
        self.assertIn("$schema", schema)
        for section in ("mesh", "material", "time", "expect"):
            self.assertIn(section, schema["properties"])

    def test_same_bits_again_and_with_threads(self):
        for case, values in ((self.case, {}), (DISC, {"time.end": 0.01}),
                             (DISC, {"time.end": 0.01, "time.scheme": "klr-conserving", "mass.type": "consistent"})):
            outputs = [self.simulate(case, f"run{i}", values, ("--quiet", "--force", "--threads", str(threads)))
                       for i, threads in enumerate((1, 1, 2, 5))]
            for name in ("history.csv", "results.xdmf"):
                contents = {(output / name).read_bytes() for output in outputs}
                self.assertEqual(len(contents), 1, f"{name} of {case}")
            # HDF5 stores times of day: only the contents are the same.
            found = set()
            for output in outputs:
                pieces = []
                with h5py.File(output / "results.h5", "r") as file:
                    file.visititems(lambda path, item: pieces.append(
                        (path, item[()].tobytes() if isinstance(item, h5py.Dataset) else b"")))
                found.add(tuple(pieces))
            self.assertEqual(len(found), 1, f"results.h5 of {case}")

    def test_same_bits_with_any_number_of_blas_threads(self):
        """Shape functions of degree 2 in space come from linear systems that OpenBLAS solves."""
        text = block_case("tetrahedron_o1_msh41_ascii.msh").split("[[probe]]")[0]
        for plane, space in (("[0.0, 0.0]", "[0.0, 0.0, 0.0]"), ("[0.0, 1.0]", "[0.0, 0.0, 1.0]"),
                             ("[0.0, -10.0]", "[0.0, 0.0, -10.0]")):
            text = text.replace(plane, space)
        case = self.write("tetrahedra.toml", text)
        contents = set()
        for threads in (None, "1", "2", "3"):
            environment = {key: value for key, value in os.environ.items() if key != "OPENBLAS_NUM_THREADS"}
            if threads is not None:
                environment["OPENBLAS_NUM_THREADS"] = threads
            output = self.folder / f"blas{threads}"
            self.expect_status(0, run("run", case, "-o", output, "--quiet", "--set", "mesh.degree=2",
                                      environment=environment))
            contents.add((output / "history.csv").read_bytes())
        self.assertEqual(len(contents), 1)

    def test_motion_beyond_all_bounds_is_status_3(self):
        """Newmark's scheme below γ = ½ is unstable at any step: it gains energy until numbers overflow."""
        output = self.folder / "out"
        process = self.expect_status(3, run("run", self.case, "-o", output, "--quiet", *settings(
            {"time.beta": 0.25, "time.gamma": 0, "time.end": 1000, "output.fields_every": 100})))
        self.assertIn("unstable with gamma = 0", process.stderr)
        self.assertRegex(process.stderr, r"ricochet: \S+/out: step \d+ \(t = [\d.]+\): \w+ is no longer finite")
        self.assertIn('use a stable scheme (reduced-kane with mass "equivalent")', process.stderr)
        self.assertNotIn("smaller time.step", process.stderr, "none helps")
        summary = summary_of(output)
        self.assertEqual(summary["status"], "failed")
        self.assertIn("no longer finite", summary["message"])
        history = History(output / "history.csv")  # all numbers are finite
        self.assertGreater(len(history.rows), 100)
        self.assertIn("(FAILED)", self.expect_status(0, run("info", output)).stdout)
