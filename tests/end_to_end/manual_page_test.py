"""The manual page renders without a warning, and has every command and option of --help."""

import os
import pathlib
import re
import subprocess

from harness import SOURCE, TestCase, run

PAGE = pathlib.Path(os.environ["RICOCHET_BUILD_DIR"]) / "share" / "user_files" / "man" / "man1" / "ricochet.1"


class ManualPage(TestCase):
    def rendered(self):
        process = subprocess.run(["man", "--warnings=w", "-E", "UTF-8", "-P", "cat", "-l", PAGE], text=True, capture_output=True,
                                 env={**os.environ, "MANWIDTH": "200", "LC_ALL": "C.UTF-8", "MAN_KEEP_FORMATTING": ""})
        self.expect_status(0, process)
        self.assertEqual(process.stderr, "")
        return re.sub(r".\x08", "", process.stdout)

    def test_renders_without_warnings(self):
        text = self.rendered()
        for heading in ("NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "COMMANDS", "EXIT STATUS", "FILES", "ENVIRONMENT", "EXAMPLES"):
            self.assertRegex(text, rf"(?m)^{heading}$")
        self.assertIn(run("--version").stdout.splitlines()[0].replace("ricochet", "Ricochet"), text)

    def test_has_all_of_help(self):
        text = self.rendered()
        commands = re.split(r"(?m)^   (\w+)$", re.search(r"(?ms)^COMMANDS$(.*?)^EXIT STATUS$", text)[1])
        parts = dict(zip(commands[1::2], commands[2::2]))
        known = re.search(r"(?ms)^Subcommands:\n(.*?)(?=^\S|\Z)", run("--help").stdout)[1]
        self.assertEqual(list(parts), re.findall(r"(?m)^  (\w+)", known))
        for command, part in parts.items():
            with self.subTest(command):
                helped = run(command, "--help").stdout
                options = re.findall(r"(?m)^  (-\S+)(?: ([A-Za-z][^ \n]*))?", helped.split("Options:")[1])
                self.assertGreater(len(options), 0)
                for names, value in options:
                    for name in names.split(","):
                        self.assertRegex(part, rf"(?m)^ +.*{re.escape(name)}(?![\w-])")
                words = " ".join(part.split())
                for line in set(helped.splitlines()) - set(run("--help").stdout.splitlines()):
                    if line.startswith("Exit status"):
                        self.assertIn(line.split(";")[0].strip(), words)

    def test_names_what_the_program_looks_at(self):
        """The environment variables in the sources are those of the page."""
        source = "".join(path.read_text(encoding="utf-8") for folder in ("src", "apps") for path in (SOURCE / folder).rglob("*.cpp"))
        read = set(re.findall(r'"((?:RICOCHET|OPENBLAS)_[A-Z_]+)"', source))
        self.assertGreater(len(read), 3)
        text = self.rendered()
        for name in read:
            self.assertIn(name, text)
