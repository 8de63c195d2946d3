"""The program as a process: closed and full standard streams, signals at any moment, limits, odd files."""

import contextlib
import itertools
import os
import pathlib
import re
import signal
import subprocess
import time

from harness import PROGRAM, TestCase, block_case, body_case, gravity, run, settings, summary_of, wait_for

# After a signal the process must end within two seconds, apart from the machine's own delays.
AT_MOST = 2.0
RESULTS = ("history.csv", "results.h5", "results.xdmf", "obstacles.xdmf")


def redirected(redirections, *arguments, **more):
    """Starts the program by a shell with such redirections (`>&-` closes)."""
    return subprocess.run(["sh", "-c", f'exec "$@" {redirections}', "sh", str(PROGRAM), *map(str, arguments)],
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=100, **more)


def start(*arguments, **more):
    return subprocess.Popen([str(PROGRAM), *map(str, arguments)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True, **more)


def box(n):
    """Writes a mesh of n × n × n hexahedra with the groups body, bottom: arbitrarily large, and quickly written."""
    nodes, cells, bottom = [], [], []
    m = n + 1
    for k, j, i in itertools.product(range(m), repeat=3):
        nodes.append(f"{i + m * (j + m * k) + 1} {i / n:.9g} {j / n:.9g} {k / n:.9g}")
    def corner(i, j, k):
        return i + m * (j + m * k) + 1
    def quad(i, j, k):
        return [corner(i, j, k), corner(i + 1, j, k), corner(i + 1, j + 1, k), corner(i, j + 1, k)]
    for j, i in itertools.product(range(n), repeat=2):
        bottom.append(quad(i, j, 0))
    for k, j, i in itertools.product(range(n), repeat=3):
        cells.append(quad(i, j, k) + quad(i, j, k + 1))
    elements = [f"{e} 3 2 1 1 " + " ".join(map(str, q)) for e, q in enumerate(bottom, 1)]
    elements += [f"{e} 5 2 2 2 " + " ".join(map(str, c)) for e, c in enumerate(cells, len(bottom) + 1)]
    return ("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"bottom\"\n3 2 \"body\"\n$EndPhysicalNames\n"
            f"$Nodes\n{len(nodes)}\n" + "\n".join(nodes) + f"\n$EndNodes\n$Elements\n{len(elements)}\n"
            + "\n".join(elements) + "\n$EndElements\n")


def box_case(mesh="box.msh", degree=2):
    return body_case(mesh, [0.0, 0.0, 0.0], [0.0, 0.0, 1.0], gravity(0.0, 0.0, -10.0), degree=degree, end=10.0)


class Streams(TestCase):
    def setUp(self):
        super().setUp()
        self.case = self.write("block.toml", block_case())

    def test_closed_streams_change_no_results(self):
        expected = self.simulate(self.case, "expected")
        for closed in itertools.product((False, True), repeat=3):
            marks = " ".join(mark for mark, is_closed in zip(("<&-", ">&-", "2>&-"), closed) if is_closed)
            output = self.folder / f"out{''.join(str(int(c)) for c in closed)}"
            self.expect_status(0, redirected(marks, "run", self.case, "-o", output))
            for name in RESULTS:
                self.assertEqual((expected / name).read_bytes(), (output / name).read_bytes(), f"{name} with {marks}")
            self.assertEqual(summary_of(output)["status"], "done")
            problem = self.folder / "exported"
            self.expect_status(0, redirected(marks, "run", self.case, "-o", output, "--force", "--quiet", "--export-contact",
                                             "20", "--export-contact-to", problem))
            exported = next(problem.iterdir())
            solution = self.folder / f"solution{len(marks)}.hdf5"
            self.expect_status(0, redirected(marks, "contact", exported, "-o", solution))
            self.assertEqual(solution.read_bytes()[:8], b"\x89HDF\r\n\x1a\n")
            page = self.folder / "report.html"
            self.expect_status(0, redirected(marks, "report", output, "-o", page))
            self.assertTrue(page.read_text().startswith("<!doctype html>"))
            figure = self.folder / "figure.svg"
            self.expect_status(0, redirected(marks, "plot", output, "--what", "energy", "-o", figure))
            self.assertIn("<svg", figure.read_text())
            # Output that nobody can read is an error.
            for command in (("info", output), ("info", self.case), ("validate", self.case), ("schema",), ("--help",),
                            ("--version",), ("contact", "--list"), ("contact", exported)):
                answer = self.expect_status(4 if closed[1] else 0, redirected(marks, *command))
                if closed[1] and not closed[2]:
                    self.assertIn("standard output is closed", answer.stderr)

    def test_a_full_standard_error_ends_no_run(self):
        expected = self.simulate(self.case, "expected")
        self.expect_status(0, redirected("2>/dev/full", "run", self.case, "-o", self.folder / "out"))
        self.assertEqual((expected / "history.csv").read_bytes(), (self.folder / "out" / "history.csv").read_bytes())

    def test_full_standard_output(self):
        output = self.simulate(self.case)
        for command in (("schema",), ("schema", "--markdown"), ("schema", "--columns"), ("info", output), ("info", self.case),
                        ("validate", self.case), ("--help",), ("run", "--help"), ("--version",), ("contact", "--list"),
                        ("run", self.case, "-o", output, "--force", "--quiet")):
            answer = self.expect_status(4, redirected(">/dev/full", *command))
            self.assertIn("standard output", answer.stderr)
            self.assertIn("No space left on device", answer.stderr)
        self.assertEqual(summary_of(output)["status"], "done")


class Files(TestCase):
    def test_names_and_directories_that_are_no_files(self):
        long_name = "x" * 300
        case = self.write("block.toml", block_case())
        for command in (("info", long_name), ("info", long_name + ".toml"), ("info", long_name + ".ckpt"),
                        ("run", long_name + ".toml"), ("validate", long_name), ("run", case, "-o", self.folder / long_name),
                        ("contact", long_name), ("report", long_name), ("run", "--resume", long_name)):
            answer = self.expect_status(4, run(*command))
            self.assertRegex(answer.stderr, "File name too long|no such file", command)
        output = self.simulate(case, values={"output.checkpoint_every": 10})
        newest = sorted(output.glob("checkpoint-*.ckpt"))[-1]
        newest.unlink()
        newest.mkdir()
        self.expect_status(4, run("info", newest))
        summary = output / "summary.json"
        summary.write_text(summary.read_text().replace('"status": "done"', '"status": "running"'))
        answer = self.expect_status(0, run("run", case, "-o", output, "--resume", "--set", "output.checkpoint_every=10"))
        self.assertIn("it is not a regular file", answer.stderr)

    def test_pipes(self):
        """They are refused without waiting, as nobody might ever write into them."""
        obstacle = '[obstacle.floor]\ntype = "plane"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\n'
        for suffix in (".toml", ".msh", ".geo", ".vtk", ".stl", ".csv"):
            os.mkfifo(self.folder / f"pipe{suffix}")
        text = block_case()
        commands = [("run", "pipe.toml"), ("validate", "pipe.toml"), ("info", "pipe.toml"), ("info", "pipe.msh"), ("run", "--resume", "pipe.toml")]
        for name, changed in (("mesh", re.sub(r'file = ".*"', 'file = "pipe.msh"', text)), ("geometry", re.sub(r'file = ".*"', 'file = "pipe.geo"', text)),
                              ("foreign", re.sub(r'file = ".*"', 'file = "pipe.vtk"', text)),
                              ("surface", text.replace(obstacle, '[obstacle.floor]\ntype = "surface"\nfile = "pipe.csv"\n')),
                              ("motion", text.replace(obstacle, obstacle + 'table = "pipe.csv"\n'))):
            self.assertNotEqual(changed, text, name)
            self.write(f"{name}.toml", changed)
            commands.append(("validate", f"{name}.toml"))
        for command in commands:
            answer = subprocess.run([str(PROGRAM), *command], cwd=self.folder, capture_output=True, text=True, timeout=30,
                                    stdin=subprocess.DEVNULL)
            self.assertEqual(answer.returncode, 4, f"{command}: {answer.stderr}")
            self.assertIn("it is a pipe, not a file", answer.stderr, command)

    def test_files_without_end(self):
        hole = self.folder / "hole"
        with hole.open("wb") as file:
            file.truncate(2 << 30)
        for suffix in ("", ".toml", ".msh", ".ckpt", ".hdf5"):
            device, sparse = self.folder / f"zero{suffix}", self.folder / f"sparse{suffix}"
            with contextlib.suppress(FileExistsError):
                device.symlink_to("/dev/zero")
            os.link(hole, sparse)
            for path in (device, sparse):
                begun = time.monotonic()
                # With a limit on memory smaller than such a file.
                answer = redirected("", "info", path, preexec_fn=lambda: __import__("resource").setrlimit(
                    __import__("resource").RLIMIT_AS, (1 << 30, 1 << 30)))
                self.assertIn(answer.returncode, (2, 4), f"{path}: {answer.stderr}")
                self.assertIn(path.name, answer.stderr)
                self.assertLess(time.monotonic() - begun, 5.0)

    def test_a_limit_on_memory(self):
        """OpenBLAS requests memory again and again without success."""
        case = self.write("block.toml", block_case())
        environment = {key: value for key, value in os.environ.items() if key != "OPENBLAS_NUM_THREADS"}
        for megabytes in (150, 200, 250, 300, 300, 300, 350, 400, 600, 1000):
            answer = subprocess.run(["sh", "-c", f'ulimit -v {megabytes}000; exec "$@"', "sh", str(PROGRAM), "run", str(case),
                                     "-o", str(self.folder / "out"), "--force", "--quiet"], env=environment,
                                    capture_output=True, text=True, timeout=60)
            self.assertIn(answer.returncode, (0, 3), f"{megabytes} MB: {answer.stderr}")
            if answer.returncode == 3:
                self.assertRegex(answer.stderr, "memory limit|out of memory")
        self.assertEqual(answer.returncode, 0, answer.stderr)


class Messages(TestCase):
    def test_an_end_between_two_steps(self):
        case = self.write("block.toml", block_case())
        values = {"time.step": 0.01, "time.end": 0.025}
        wanted = "time.end = 0.025 is not a whole number of steps of 0.01: the run ends at t = 0.03, after step 3"
        answer = self.expect_status(0, run("run", case, "-o", self.folder / "out", *settings(values)))
        self.assertIn(wanted, answer.stderr)
        self.assertEqual(summary_of(self.folder / "out")["warnings"], [wanted])
        self.assertIn(wanted, run("validate", case, *settings(values)).stderr)
        # Excludes steps that reach the end, up to rounding, in a whole number of steps.
        values = {"time.step": 0.1, "time.end": 0.3}
        self.assertNotIn("whole number", run("run", case, "-o", self.folder / "even", *settings(values)).stderr)

    def test_quiet_runs_say_which_they_are(self):
        case = self.write("block.toml", block_case())
        output = self.folder / "one of many"
        answer = self.expect_status(0, run("run", case, "-o", output, "--quiet", "--set", "time.end=0.025"))
        self.assertIn(f"warning: {output}: time.end", answer.stderr)
        self.assertTrue(summary_of(output)["warnings"][0].startswith("time.end"))
        answer = self.expect_status(4, run("run", case, "-o", output, "--quiet"))
        self.assertIn(f"ricochet: {output}: ", answer.stderr)
        # A position in the case says enough: every run of it has this error.
        case.write_text(block_case().replace('group = "bottom"', 'group = "botom"'), encoding="utf-8")
        answer = self.expect_status(2, run("run", case, "-o", self.folder / "wrong", "--quiet"))
        self.assertIn(f"ricochet: {case}:", answer.stderr)
        self.assertNotIn("wrong", answer.stderr)


class Signals(TestCase):
    def end(self, process, number, status, seconds=AT_MOST):
        begun = time.monotonic()
        process.send_signal(number)
        text, errors = process.communicate(timeout=60)
        self.assertLess(time.monotonic() - begun, seconds, errors)
        self.assertEqual(process.returncode, status, errors)
        return text, errors

    def test_while_a_run_is_prepared(self):
        """A body that takes seconds to order and to factorize: the signal arrives somewhere in this work."""
        self.write("box.msh", box(28))
        case = self.write("box.toml", box_case())
        output = self.folder / "out"
        process = start("run", case, "-o", output, "--set", "solver.method=direct")
        said = ""
        while "preparing the steps" not in said:
            line = process.stderr.readline()
            self.assertNotEqual(line, "", said)
            said += line
        time.sleep(0.5)
        self.assertIsNone(process.poll())
        self.assertFalse((output / "summary.json").exists(), "it is prepared already: take a larger body")
        self.end(process, signal.SIGTERM, 143)
        # Nothing is left, and the same command starts.
        self.assertFalse(output.exists())
        process = start("validate", case)
        time.sleep(0.5)
        self.assertIsNone(process.poll())
        self.end(process, signal.SIGINT, 130)

    def test_while_a_step_takes_long(self):
        """A step that does not end for a long time: contact and conjugate gradients disagree, as the step is far too
        large."""
        self.write("box.msh", box(14))
        case = self.write("box.toml", box_case())
        output = self.folder / "out"
        process = start("run", case, "-o", output, *settings(
            {"solver.method": "iterative", "solver.tolerance": 1e-14, "initial.velocity": '["0", "0", "-1"]',
             "time.step": 0.3}))
        wait_for((output / "results.xdmf").exists)
        time.sleep(1.0)
        _, errors = self.end(process, signal.SIGTERM, 143)
        summary = summary_of(output)
        self.assertEqual(summary["status"], "interrupted")
        self.assertIn("stopped during a step", summary["message"])
        self.assertIn("continues from the last checkpoint, if there is one", errors)
        self.assertIn("(interrupted)", run("info", output).stdout)

    def test_the_state_before_a_long_step_is_kept(self):
        self.write("box.msh", box(9))
        case = self.write("box.toml", box_case())
        # Conjugate gradients to the last digit.
        values = {"solver.method": "iterative", "solver.tolerance": 1e-14, "output.fields_every": 1,
                  "initial.velocity": '["0", "0", "-1"]'}
        output = self.folder / "out"
        process = start("run", case, "-o", output, *settings(values))
        history = output / "history.csv"
        wait_for(lambda: history.exists() and history.read_text().count("\n") >= 4)
        self.end(process, signal.SIGTERM, 143)
        summary = summary_of(output)
        self.assertEqual(summary["status"], "interrupted")
        # The end of the step if it was reached in time, else its start.
        step = int(sorted(output.glob("checkpoint-*.ckpt"))[-1].stem.split("-")[1])
        self.assertEqual(summary["checkpoint_step"], step)
        self.assertGreater(step, 0)
        end = 0.01 * (step + 1)
        self.expect_status(0, run("run", "--resume", output, "--quiet", "--set", f"time.end={end:g}"))
        expected = self.simulate(case, "expected", {**values, "time.end": f"{end:g}"})
        for name in RESULTS:
            self.assertEqual((expected / name).read_bytes(), (output / name).read_bytes(), name)

    def test_a_second_one_stops_at_once(self):
        case = self.write("block.toml", block_case())
        output = self.folder / "out"
        process = start("run", case, "-o", output, *settings({"time.end": 1e5, "output.fields_every": 0}))
        wait_for((output / "summary.json").exists)
        process.send_signal(signal.SIGSTOP)
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGTERM)
        process.send_signal(signal.SIGCONT)
        begun = time.monotonic()
        process.communicate(timeout=60)
        self.assertLess(time.monotonic() - begun, 1.0)
        self.assertIn(process.returncode, (130, 143))

    def test_while_gmsh_works(self):
        """It ends with the program, and its folder is removed."""
        geometry = self.write("fine.geo", 'SetFactory("OpenCASCADE");\nSphere(1) = {0, 0, 0, 1};\n'
                              'Physical Volume("body") = {1};\nPhysical Surface("bottom") = {1};\n')
        case = self.write("ball.toml", box_case(geometry.name, degree=1).replace(
            "[mesh]\n", "[mesh]\nsize = 0.02\n"))
        cache = self.folder / "cache"
        cache.mkdir()
        process = start("run", case, "-o", self.folder / "out", "--quiet",
                        env={**os.environ, "RICOCHET_CACHE": str(cache)})
        children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children")
        wait_for(lambda: list(cache.glob("meshing-*/gmsh.log")) and children.read_text().strip())
        child = int(children.read_text().split()[0])
        time.sleep(0.3)
        self.end(process, signal.SIGTERM, 143)
        self.assertEqual(list(cache.iterdir()), [])
        self.assertFalse((self.folder / "out").exists())
        with contextlib.suppress(FileNotFoundError):  # it is gone, or a zombie
            self.assertIn("\nState:\tZ", pathlib.Path(f"/proc/{child}/status").read_text())

    def test_an_ignored_one_stays_ignored(self):
        case = self.write("block.toml", block_case())
        output = self.folder / "out"
        process = start("run", case, "-o", output, *settings({"time.end": 1e5, "output.fields_every": 0}),
                        preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        wait_for((output / "summary.json").exists)
        process.send_signal(signal.SIGHUP)
        time.sleep(0.3)
        self.assertIsNone(process.poll())
        self.end(process, signal.SIGTERM, 143)
        self.assertEqual(summary_of(output)["status"], "interrupted")
