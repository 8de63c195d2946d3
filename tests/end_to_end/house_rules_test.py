"""House rules that can be counted: beginnings of comments, lengths of lines, files and pages."""

import importlib
import re
import sys
import tomllib
import unittest.mock

from harness import DISC, SOURCE

CODE = ("src", "apps", "tests", "bench", "python/bindings")
# A documentation comment begins with a noun phrase, or with a verb in the third person.
BEGINNING = re.compile(r"^\s*(?:[^/\"]*?\s)?///<? +(?:@file +)?(Of|What|Where|The same|Those|That)\b")


def files(folders, *suffixes):
    found = [path for folder in folders for path in sorted((SOURCE / folder).rglob("*"))
             if path.suffix in suffixes and "node_modules" not in path.parts and path.is_file()]
    return [path for path in found if not any(part.startswith("build") for part in path.relative_to(SOURCE).parts[:-1])]


def lines(path):
    return path.read_text(encoding="utf-8").splitlines()


def named(path, number):
    return f"{path.relative_to(SOURCE)}:{number}"


def tested_classes(script):
    """Returns the names of the classes of a script that have tests of their own, as unittest finds them."""
    with unittest.mock.patch.object(sys, "argv", [script, str(DISC)]):  # some take the file of a case or a page
        module = importlib.import_module(script)
    return sorted(name for name, value in vars(module).items() if isinstance(value, type) and issubclass(value, unittest.TestCase)
                  and value.__module__ == script and any(test in vars(value) for test in unittest.defaultTestLoader.getTestCaseNames(value)))


class Comments(unittest.TestCase):
    def test_documentation_comments_begin_with_a_noun_or_a_verb(self):
        sources = files(CODE, ".hpp", ".cpp")
        self.assertGreater(len(sources), 900)
        wrong = [f"{named(path, number)}: {line.strip()}" for path in sources
                 for number, line in enumerate(lines(path), 1) if BEGINNING.match(line)]
        self.assertEqual(wrong, [])

    def test_such_beginnings_are_found(self):
        for line in ("  /// What is here.", "int x;  ///< of which", "double y;  ///< Of the body.", "/// @file The same"):
            found = BEGINNING.match(line) is not None
            self.assertEqual(found, "of which" not in line, line)

    def test_files_named_in_comments_exist(self):
        """A file that was renamed must not live on in a comment."""
        sources = files((*CODE, "cmake"), ".hpp", ".cpp", ".py", ".cmake")
        names = {path.name for path in sources}
        comment = re.compile(r"(?://|#(?! *include)).*")
        named_file = re.compile(r"(?<![\w.{*-])([a-z_0-9]+\.[hc]pp)\b")
        wrong = [f"{named(path, number)}: {name}" for path in sources for number, line in enumerate(lines(path), 1)
                 for text in comment.findall(line) for name in named_file.findall(text) if name not in names]
        self.assertEqual(wrong, [])


class Entries(unittest.TestCase):
    """CMake finds the other tests by the names of their files."""

    def test_each_end_to_end_test_has_an_entry(self):
        folder = SOURCE / "tests" / "end_to_end"
        text = (folder / "CMakeLists.txt").read_text(encoding="utf-8")
        entries = [line.split() for line in re.findall(r"^ *ricochet_end_to_end\((.*)\)$", text, re.MULTILINE)]
        self.assertEqual({words[1] for words in entries}, {path.name.removesuffix("_test.py") for path in folder.glob("*_test.py")})
        tested = {path.stem.removesuffix("_test"): tested_classes(path.stem) for path in sorted(folder.glob("*_test.py"))}
        for script in (script for script in tested if not tested[script]):  # a script without tests that calls nothing succeeds
            main = r'(?m)^if __name__ == "__main__":\n(    .*\n|\n)*    (sys\.exit|main)\('
            self.assertRegex((folder / f"{script}_test.py").read_text(encoding="utf-8"), main)
        for script in {words[1] for words in entries}:
            # An entry for some classes of a script requires others for the rest.
            selections = [[word for word in words[2:] if word[0].isupper() and not word.isupper()]
                          for words in entries if words[1] == script]
            if all(selections):
                self.assertEqual(sorted(sum(selections, [])), tested[script], script)

    def test_each_test_of_several_processes_has_an_entry(self):
        names = re.search(r"foreach\(name ([\w ]+)\)\n *add_test\(NAME distributed",
                          (SOURCE / "tests" / "CMakeLists.txt").read_text(encoding="utf-8"))[1].split()
        found = (SOURCE / "tests" / "distributed").glob("*_test.py")
        self.assertEqual(sorted(names), sorted(path.name.removesuffix("_test.py") for path in found))

    def test_each_planted_fault_is_where_the_list_says(self):
        """`./dev faults` takes hours: a text that was rewritten must not come out only there."""
        faults = tomllib.loads((SOURCE / "tests/faults/faults.toml").read_text(encoding="utf-8"))["fault"]
        self.assertGreater(len(faults), 25)
        counts = {fault["name"]: (SOURCE / fault["file"]).read_text(encoding="utf-8").count(fault["old"]) for fault in faults}
        self.assertEqual({name: count for name, count in counts.items() if count != 1}, {})


class Sizes(unittest.TestCase):
    def test_no_file_has_more_than_400_lines(self):
        folders = (*CODE, "python", "benchmarks", "cases", "examples", "viewer/src", "viewer/test", "packaging", "cmake", ".ci")
        every = [*files(folders, ".hpp", ".cpp", ".py", ".ts", ".mjs", ".cmake"), SOURCE / "dev"]
        long = {str(path.relative_to(SOURCE)) for path in every if len(lines(path)) > 400}
        self.assertEqual(long, set())

    def test_pages_have_their_limits(self):
        self.assertLessEqual(len(lines(SOURCE / "README.md")), 150)
        self.assertLessEqual((SOURCE / "CONTRIBUTING.md").stat().st_size, 6000)
        recipes = sorted((SOURCE / "docs/developers").glob("add-*.md"))
        self.assertGreater(len(recipes), 10)
        self.assertEqual([path.name for path in recipes if len(lines(path)) > 40], [])

    def test_lines_of_pages_fit_a_screen(self):
        """160 characters, except tables, code, formulas, pictures and pages that programs write."""
        written = {"docs/case-file.md", "docs/summary-file.md", "docs/performance.md", "docs/scorecard.md", "docs/distributed.md"}
        pages = [SOURCE / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")]
        pages += files(("docs", "cases", "benchmarks", "examples", "bench"), ".md")
        self.assertGreater(len(pages), 80)
        wrong = []
        for path in pages:
            if str(path.relative_to(SOURCE)) in written:
                continue
            is_code = False
            for number, line in enumerate(lines(path), 1):
                is_code ^= line.lstrip().startswith(("```", "$$"))
                if len(line) > 160 and not is_code and not line.startswith(("|", "![")):
                    wrong.append(named(path, number))
        self.assertEqual(wrong, [])
