"""The version in every file of a run, files of other versions, and what is written of the entries of summary.json: its schema,
its page, and the types of the viewer and of Python."""

import importlib.util
import json
import shutil
import struct
import unittest
import zlib

import h5py

from harness import DISC, SOURCE, TestCase, run, settings

SHORT = {"time.step": 1e-3, "time.end": 0.01, "output.fields_every": 5, "output.checkpoint_every": 5}
OTHERS = ("0.2.9", "1000.0.0")

specification = importlib.util.spec_from_file_location("summary_files", SOURCE / "docs" / "summary_files.py")
summary_files = importlib.util.module_from_spec(specification)
specification.loader.exec_module(summary_files)


def types_of(value):
    if value is None:
        return {"null"}
    if isinstance(value, bool):
        return {"boolean"}
    return {int: {"integer", "number"}, float: {"number"}, str: {"string"}, list: {"array"}, dict: {"object"}}[type(value)]


class Versions(TestCase):
    def setUp(self):
        super().setUp()
        self.version = run("--version").stdout.split()[1]

    def refused(self, *command, file, version, advice="repeat the run with --force, or "):
        process = self.expect_status(2, run(*command))
        for part in (str(file) + ": written by ", f"Ricochet {version}" if version else "before 0.3.0", f"this is Ricochet {self.version}", advice):
            self.assertIn(part, process.stderr)
        self.assertNotIn("versions 0.3.0 to 0.3.0", process.stderr)
        return process

    def simulated(self, kind):
        return self.simulate(DISC, kind, SHORT | {"output.format": kind}, ("--quiet", "--export-contact", "8"))

    def test_fields(self):
        for kind, names in (("xdmf", ("results.h5", "results.xdmf", "obstacles.xdmf")), ("vtkhdf", ("results.vtkhdf", "obstacles.vtkhdf"))):
            output = self.simulated(kind)
            self.assertEqual({path.name for path in output.glob("*.xdmf")} | {path.name for path in output.glob("*.h*5")}
                             | {path.name for path in output.glob("*.vtkhdf")}, set(names))
            for name in names:
                for other in (*OTHERS, None):
                    changed = self.folder / "changed"
                    shutil.rmtree(changed, ignore_errors=True)
                    shutil.copytree(output, changed)
                    file = changed / name
                    if name.endswith("xdmf"):
                        line = f'    <Information Name="ricochet_version" Value="{self.version}"/>\n'
                        text = file.read_text(encoding="utf-8")
                        self.assertEqual(text.count(line), 1)
                        file.write_text(text.replace(line, line.replace(self.version, other) if other else ""), encoding="utf-8")
                    else:
                        with h5py.File(file, "r+") as data:
                            self.assertEqual(data.attrs["ricochet_version"].decode(), self.version)
                            del data.attrs["ricochet_version"]
                            if other:
                                data.attrs.create("ricochet_version", other, dtype=f"S{len(other)}")
                    self.refused("report", changed, file=file, version=other)

    def test_summary(self):
        output = self.simulated("xdmf")
        file = output / "summary.json"
        summary = json.loads(file.read_text(encoding="utf-8"))
        self.assertEqual(summary["ricochet_version"], self.version)
        for other in OTHERS:
            file.write_text(json.dumps(summary | {"ricochet_version": other}), encoding="utf-8")
            for command in (("info", output), ("info", output, output), ("report", output), ("plot", output, "--what", "energy", "-o", self.folder / "a.svg"),
                            ("run", "--resume", output, "--quiet"), ("run", DISC, "-o", output, "--resume", "--quiet", *settings(SHORT))):
                self.refused(*command, file=file, version=other)
        # Results of another version can be replaced.
        self.expect_status(0, run("run", DISC, "-o", output, "--force", "--quiet", *settings(SHORT)))

    def change_version(self, file, other):
        """Writes a checkpoint with another version, or without any."""
        content = file.read_bytes()
        begin = content.index(b"identity.version")
        text = begin + 16 + 1 + 8  # its name, its kind, its number of entries
        [size] = struct.unpack_from("<I", content, text)
        entry = content[begin - 4:text] + struct.pack("<I", len(other)) + other.encode() if other else b""
        body = content[20:begin - 4] + entry + content[text + 4 + size:-4]
        changed = content[:12] + struct.pack("<Q", len(body)) + body
        file.write_bytes(changed + struct.pack("<I", zlib.crc32(changed)))

    def test_checkpoints(self):
        output = self.simulated("xdmf")
        (output / "summary.json").unlink()
        files = sorted(output.glob("*.ckpt"))
        for other in (*OTHERS, None):
            for file in files:
                self.change_version(file, other)
            stated = {"file": files[-1], "version": other, "advice": "repeat the run with --force, or continue it with the version"}
            self.refused("info", files[-1], **stated)
            self.assertNotIn("--resume", self.refused("info", output, **stated).stdout)
            self.refused("run", DISC, "-o", output, "--resume", "--quiet", *settings(SHORT), **stated)
        self.expect_status(0, run("run", DISC, "-o", output, "--force", "--quiet", *settings(SHORT)))

    def test_contact_problems(self):
        [file] = (self.simulated("xdmf") / "contact").iterdir()
        with h5py.File(file) as data:
            self.assertIn(f"Ricochet {self.version}", data["fclib_local/info/description"][()].decode())

    def test_studies_and_benchmarks(self):
        output, benchmarks = self.folder / "study", self.folder / "benchmarks"
        study = ("study", DISC, "--vary", "time.step=1e-3,2e-3", "--quiet", *settings({"time.end": 0.01, "output.fields_every": 0}))
        self.expect_status(0, run(*study, "-o", output))
        self.expect_status(0, run("benchmark", "rod", "-o", benchmarks, "--quiet"))
        for file, commands in ((output / "study.json", (("study", "--resume", output), ("report", output), (*study, "-o", output, "--force"))),
                               (benchmarks / "benchmark.json", (("report", benchmarks), ("benchmark", "rod", "-o", benchmarks, "--force")))):
            plan = json.loads(file.read_text(encoding="utf-8"))
            self.assertEqual(plan["ricochet_version"], self.version)
            for other in (*OTHERS, None):
                file.write_text(json.dumps(plan | {"ricochet_version": other or ""}), encoding="utf-8")
                for command in commands:
                    self.refused(*command, file=file, version=other, advice="in another directory (-o), or use the version that wrote")
            file.write_text(json.dumps(plan), encoding="utf-8")
        page = self.folder / "study.html"
        self.expect_status(0, run("report", output, "-o", page))
        self.assertIn(f"Ricochet {self.version}", page.read_text(encoding="utf-8"))

    def test_a_run_of_a_study_or_benchmark(self):
        """Such a run is repeated, and nothing else; a warning names both versions and says that its results are overwritten."""
        output, benchmarks = self.folder / "study", self.folder / "benchmarks"
        self.expect_status(0, run("study", DISC, "--vary", "time.step=1e-3,2e-3", "-o", output, "--quiet",
                                  *settings({"time.end": 0.01, "output.fields_every": 0})))
        self.expect_status(0, run("benchmark", "rod", "-o", benchmarks, "--quiet"))
        for folder, command in ((output, ("study", "--resume", output)), (benchmarks, ("benchmark", "rod", "-o", benchmarks, "--resume"))):
            file, *others = sorted(folder.glob("runs/*/summary.json"))
            kept = [other.read_bytes() for other in others]
            file.write_text(file.read_text(encoding="utf-8").replace(f'"{self.version}"', '"0.2.9"'), encoding="utf-8")
            if folder == output:
                self.assertIn(f"written by Ricochet 0.2.9; this is Ricochet {self.version}", self.expect_status(0, run("info", output)).stdout)
                for count, pages in ((1, ["runs.html"]), (2, [])):
                    for other in others[:count - 1]:
                        other.write_bytes(file.read_bytes())
                    self.expect_status(0, run("report", output))
                    self.assertIn("written by Ricochet 0.2.9", (output / "report.html").read_text(encoding="utf-8"))
                    self.assertEqual([path.name for path in output.glob("runs.html")], pages)
                    (output / "report.html").unlink()
                    (output / "runs.html").unlink(missing_ok=True)
                for other, content in zip(others, kept):
                    other.write_bytes(content)
            said = self.expect_status(0, run(*command, "--quiet")).stderr
            for part in (f"{file}: written by Ricochet 0.2.9; this is Ricochet {self.version}", "this run is repeated, and its results are overwritten"):
                self.assertIn(part, said)
            self.assertIn(f'"ricochet_version": "{self.version}"', file.read_text(encoding="utf-8"))
            self.assertEqual([other.read_bytes() for other in others], kept)
            self.assertNotIn("written by", self.expect_status(0, run(*command, "--quiet")).stderr)


class SummarySchema(TestCase):
    def schema(self):
        return json.loads(self.expect_status(0, run("schema", "--summary")).stdout)

    def check(self, value, schema, where):
        """Everything that is written is described, and the reverse."""
        self.assertTrue(types_of(value) & set(summary_files.kinds(schema)), f"{where}: {value!r} is not {schema.get('type')}")
        if isinstance(value, list):
            for number, element in enumerate(value):
                self.check(element, schema["items"], f"{where}.{number}")
        if not isinstance(value, dict):
            return
        if "properties" not in schema:
            for name, entry in value.items():
                self.check(entry, schema["additionalProperties"], f"{where}.{name}")
            return
        self.assertEqual(set(schema["required"]) - set(value), set(), where)
        self.assertEqual(list(value), [name for name in schema["properties"] if name in value], where)
        for name, entry in value.items():
            self.check(entry, schema["properties"][name], f"{where}.{name}")

    def test_runs_keep_to_it(self):
        schema = self.schema()
        for case, values in ((DISC, {"time.step": 1e-3, "time.end": 0.05}),
                             (SOURCE / "cases" / "cradle" / "cradle.toml", {"time.end": 0.5}),
                             (SOURCE / "cases" / "ball" / "ball.toml", {"time.step": 1e-3, "time.end": 2e-3}),
                             (SOURCE / "cases" / "stack" / "stack.toml", {"time.step": 0.01, "time.end": 0.1})):
            output = self.folder / case.stem
            self.assertIn(run("run", case, "-o", output, "--quiet", *settings(values)).returncode, (0, 5), case)
            self.check(json.loads((output / "summary.json").read_text(encoding="utf-8")), schema, case.stem)

    def test_nothing_is_known_before_the_first_row(self):
        """Of a run that cannot write its files: no energy, no rotation and no penetration has been computed."""
        output = self.folder / "disc"
        (output / "results.h5" / "mine").mkdir(parents=True)
        self.expect_status(4, run("run", DISC, "-o", output, "--force", "--quiet"))
        summary = json.loads((output / "summary.json").read_text(encoding="utf-8"))
        self.check(summary, self.schema(), "disc")
        self.assertEqual(summary["extrema"], {})
        self.assertIsNone(summary["energy_budget"])
        self.assertIsNone(summary["rotation"])
        self.assertIs(summary["unwatched_penetration"]["checked"], False)
        self.assertEqual(summary["unwatched_penetration"]["not_watched"], ["everything except contact nodes"])
        self.assertIn("not checked for interpenetration: everything except contact nodes", self.expect_status(0, run("info", output)).stdout)
        self.assertIn("≥ 0", self.expect_status(0, run("info", output, output)).stdout)

    def test_every_entry_has_a_text(self):
        for title, schema in summary_files.objects(self.schema()).items():
            for name, entry in schema["properties"].items():
                self.assertGreater(len(entry["description"]), 5, f"{title}.{name}")
        self.expect_status(1, run("schema", "--summary", "--markdown"))

    def test_generated_files(self):
        for path, content in summary_files.files(self.schema()).items():
            with self.subTest(path=path):
                self.assertEqual((SOURCE / path).read_text(encoding="utf-8"), content, "write it anew: docs/summary_files.py build/ricochet")


if __name__ == "__main__":
    unittest.main()
