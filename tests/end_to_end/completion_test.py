"""Shells complete the words of the program's own help and table of keys: bash is queried as if TAB were pressed."""

import json
import re
import shlex
import shutil
import subprocess
import unittest

from harness import PROGRAM, SOURCE, TestCase, block_case, run

CASE = SOURCE / "cases" / "oblique" / "oblique.toml"


def words_of_help(text, heading):
    """Returns the first words of the lines below a heading of --help."""
    part = re.search(rf"^{heading}:\n(.*?)(?=^\S|\Z)", text, re.M | re.S)
    return set(re.findall(r"^  (\S+)", part[1], re.M)) if part else set()


def options_of_help(*command):
    text = run(*command, "--help").stdout
    part = re.search(r"^Options:\n(.*?)(?=^\S|\Z)", text, re.M | re.S)[1]
    lines = re.findall(r"^  (-\S+)", part, re.M)
    return {option for line in lines for option in line.split(",") if option}


class Completion(TestCase):
    def setUp(self):
        super().setUp()
        self.script = self.write("completion.bash", self.expect_status(0, run("completion", "bash")).stdout)
        (self.folder / "bin").mkdir()
        (self.folder / "bin" / "ricochet").symlink_to(PROGRAM)

    def complete(self, line):
        """Returns the completions of bash at the end of the line. It also splits words at "=" and ":", according to
        COMP_WORDBREAKS."""
        words = [part for word in line.split(" ") for part in (re.findall(r"[=:]+|[^=:]+", word) or [""])]
        # After a "=" at the end bash starts a new word itself.
        text = f"""
            . {self.script}
            PATH={self.folder}/bin:$PATH
            COMP_WORDS=({' '.join(shlex.quote(word) for word in words)}) COMP_CWORD={len(words) - 1}
            COMP_LINE={shlex.quote(line)} COMP_POINT={len(line)}
            _ricochet && printf '%s\\n' "${{COMPREPLY[@]}}" """
        process = subprocess.run(["bash", "--norc", "-uc", text], cwd=self.folder, text=True, capture_output=True)
        self.assertEqual(process.returncode, 0, process.stderr)
        return set(process.stdout.split())

    def test_commands_and_options_are_those_of_help(self):
        commands = words_of_help(run("--help").stdout, "Subcommands")
        self.assertGreater(len(commands), 9)
        self.assertEqual(self.complete("ricochet "), commands)
        self.assertEqual(self.complete("ricochet -"), options_of_help())
        for command in commands:
            with self.subTest(command):
                options = options_of_help(command)
                self.assertIn("--help", options)
                self.assertEqual(self.complete(f"ricochet {command} -"), options)
        self.assertEqual(self.complete("ricochet run --for"), {"--force"})
        self.assertEqual(self.complete("ricochet bogus "), set())

    def test_keys_are_those_of_the_schema(self):
        schema = json.loads(run("schema").stdout)
        table = {f"time.{key}=" for key in schema["properties"]["time"]["properties"]}
        self.assertEqual(self.complete(f"ricochet run {CASE} --set time."), table)
        for name, heading in (("obstacle", r"\[obstacle\.(\w+)\]"), ("contact", None)):
            entries = re.findall(heading, CASE.read_text(encoding="utf-8")) if heading else ["0"]
            self.assertTrue(entries)
            inner = schema["properties"][name].get("additionalProperties") or schema["properties"][name]["items"]
            keys = {key for key, value in inner["properties"].items() if value.get("type") != "object"}
            found = self.complete(f"ricochet run {CASE} --set {name}.")
            self.assertLessEqual({f"{name}.{entry}.{key}=" for entry in entries for key in keys}, found)
            self.assertTrue(all(word.startswith(tuple(f"{name}.{entry}." for entry in entries)) for word in found))
        # Without a case there are no entries, and every section without entries is offered.
        self.assertEqual(self.complete("ricochet run --set contact."), set())
        self.assertIn("mass.type=", self.complete("ricochet run --set mass."))

    def test_values_of_keys_have_names(self):
        schema = json.loads(run("schema").stdout)["properties"]
        for section, key in (("time", "scheme"), ("mass", "type"), ("mesh", "plane")):
            values = set(schema[section]["properties"][key]["enum"])
            self.assertGreater(len(values), 2)
            # bash has split at "=", so that the completion is the part after it.
            self.assertEqual(self.complete(f"ricochet run {CASE} --set {section}.{key}="), values)
        self.assertEqual(self.complete("ricochet study --vary time.scheme=midpoint,reduced-k"), {"midpoint,reduced-kane"})
        self.assertEqual(self.complete("ricochet validate --set time.no-such-key="), set())
        self.assertEqual(self.complete("ricochet benchmark --scheme paoli"), {"paoli-schatzman"})

    def test_names(self):
        listed = run("benchmark", "--list").stdout.splitlines()
        self.assertEqual(self.complete("ricochet benchmark sdn"), {line.split()[0] for line in listed if line.startswith("sdn")})
        solvers = {line.split()[0] for line in run("contact", "--list").stdout.splitlines() if line.split()}
        self.assertLessEqual(self.complete("ricochet contact --solver "), solvers)
        self.assertIn("gauss-seidel", self.complete("ricochet contact --solver g"))
        levels = re.search(r"--log-level LEVEL\s+(.*)", run("run", "--help").stdout)[1]
        self.assertEqual(self.complete("ricochet run --log-level "), set(re.findall(r"\w+", levels)) - {"or"})
        shells = self.complete("ricochet completion ")
        self.assertEqual(shells, {"bash", "zsh", "fish"})
        for shell in shells:
            self.expect_status(0, run("completion", shell))
        self.expect_status(1, run("completion", "tcsh"))
        what = re.search(r"--what WHAT (.*?)(?=^  -)", run("plot", "--help").stdout, re.M | re.S)[1]
        for word in self.complete("ricochet plot --what "):
            self.assertIn(word, what)

    def test_files_and_runs(self):
        case = self.write("block.toml", block_case())
        self.write("notes.txt", "")
        (self.folder / "out" / "empty").mkdir(parents=True)
        self.expect_status(0, run("run", case, "-o", self.folder / "out" / "first", "--quiet", "--set", "output.fields_every=0"))
        self.assertEqual(self.complete("ricochet run b"), {"block.toml", "bin/"})
        self.assertEqual(self.complete("ricochet run n"), set())
        self.assertEqual(self.complete("ricochet info n"), {"notes.txt"})
        # A run is a complete word; other folders may contain one.
        self.assertEqual(self.complete("ricochet report out/"), {"out/first", "out/empty/"})
        self.assertEqual(self.complete("ricochet run --resume out/f"), {"out/first"})
        self.assertEqual(self.complete("ricochet run block.toml -o out/f"), {"out/first"})
        self.assertEqual(self.complete("ricochet run block.toml other"), set())
        (self.folder / "a name.toml").write_text("", encoding="utf-8")
        self.assertEqual(self.complete("ricochet run a"), {"a\\", "name.toml"})  # one word, quoted for bash

    def test_scripts_are_read_by_their_shells(self):
        for shell, check in (("bash", ["bash", "-n"]), ("zsh", ["zsh", "-n"]), ("fish", ["fish", "--no-execute"])):
            if shutil.which(shell) is None:
                continue
            script = self.write(f"script.{shell}", run("completion", shell).stdout)
            self.expect_status(0, subprocess.run([*check, script], text=True, capture_output=True))

    @unittest.skipUnless(shutil.which("fish"), "fish is not here")
    def test_fish(self):
        script = self.write("script.fish", run("completion", "fish").stdout)
        said = subprocess.run(["fish", "--no-config", "-c", f"set PATH {self.folder}/bin $PATH; source {script}; complete -C 'ricochet va'"],
                              text=True, capture_output=True)
        self.assertEqual(said.stdout.split("\t")[0].strip(), "validate", said.stderr)
