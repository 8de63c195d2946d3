"""What the benches share: arguments, runs of programs and their times, tables, and the pages of docs/ that have them."""

import argparse
import csv
import ctypes
import json
import os
import pathlib
import re
import resource
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
BUILD = ROOT / "build"
PHASES = (("open", "open"), ("changing", "closing"), ("closed", "closed"))  # of contact: as ricochet_step_bench names them, as tables do


def positive(text):
    """Type of an argument: a number of at least 1."""
    if int(text) < 1:
        raise argparse.ArgumentTypeError("must be at least 1")
    return int(text)


class Arguments(argparse.ArgumentParser):
    """Arguments of `./dev bench NAME`. All benches have --check, with which `parse` ends the program."""

    def __init__(self, name, text, repeat=None, directory=False, build="the programs"):
        """`repeat`: the default of --repeat; `directory`: whether there is --directory; `build`: what is in the folder of --build."""
        super().__init__(prog=f"./dev bench {name}".rstrip(), description=text, formatter_class=argparse.RawDescriptionHelpFormatter)
        if repeat:
            self.add_argument("--repeat", type=positive, default=repeat,
                              help="number of runs, which take turns; times are their medians (default: %(default)s)")
        if directory:
            self.add_argument("--directory", type=pathlib.Path, default=BUILD / f"bench-{name or 'step'}", help="directory of meshes and results")
        if build:
            self.add_argument("--build", type=pathlib.Path, default=BUILD, help=f"folder of {build}")
        self.add_argument("--check", action="store_true", help="only check the arguments")

    def parse(self):
        arguments = self.parse_args()
        if arguments.check:
            sys.exit(0)
        return arguments


def add_parts(parser, parts):
    """Adds --only and --report for measurements in parts, which `measure_parts` takes."""
    parser.add_argument("--only", choices=parts, nargs="+", default=list(parts), help="only these parts; the others are kept")
    parser.add_argument("--report", action="store_true", help="only rewrite the pages from the stored measurements")


def measure_parts(arguments, parts, entry_of=lambda records: records):
    """Returns the measurements of DIRECTORY/results.json after those of the chosen parts. `parts` names functions of (arguments,
    directory) that yield records; `entry_of` makes what is stored of the records of a part."""
    directory = arguments.directory.resolve()
    directory.mkdir(parents=True, exist_ok=True)
    results = directory / "results.json"
    everything = json.loads(results.read_text()) if results.exists() else {}
    for part in [] if arguments.report else arguments.only:
        records = []
        for record in parts[part](arguments, directory):
            records.append(record)
            print(part, {key: value for key, value in record.items() if not hasattr(value, "__len__") or len(value) < 4}, file=sys.stderr, flush=True)
        everything[part] = entry_of(records)
        results.write_text(json.dumps(everything, indent=1))
    if not everything:
        sys.exit(f"{results}: nothing has been measured yet; run without --report")
    return everything


def output_of(command, **options):
    """Returns what a command prints; the bench ends with its message if it fails."""
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: {done.stderr.strip()}")
    return done.stdout


def record_of_peer(command, kernels):
    """Runs a script of bench/ for another program with OpenBLAS on these kernels, those of ours, as a comparison requires. Returns
    the record that it prints, or {"failed": why}."""
    paths = os.pathsep.join(str(ROOT / "bench" / name) for name in ("", "step"))
    done = subprocess.run([sys.executable, *map(str, command)], capture_output=True, text=True, env=with_kernels(kernels) | {"PYTHONPATH": paths})
    if done.returncode != 0:
        return {"failed": done.stderr.strip().splitlines()[-1] if done.stderr else f"exit status {done.returncode}"}
    record = json.loads(done.stdout[done.stdout.index("{"):])
    if record["kernels"] != kernels:
        return {"failed": f"OpenBLAS uses the kernels for {record['kernels']}, ours those for {kernels}"}
    return record


def programs_seconds():
    """Returns the processor time of all programs that this process has run so far."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def processor_seconds(call, *arguments, **options):
    """Returns the processor time of the programs that a call runs."""
    before = programs_seconds()
    call(*arguments, **options)
    return programs_seconds() - before


def summary(directory):
    return json.loads((pathlib.Path(directory) / "summary.json").read_text(encoding="utf-8"))


def history(directory):
    """Returns the columns of a history: {name: numbers}."""
    with open(pathlib.Path(directory) / "history.csv", newline="", encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    return {name: [float(row[k]) for row in rows] for k, name in enumerate(header)}


def table(head, rows):
    """Returns a table in Markdown; cells are texts, or values as they print."""
    return "\n".join(["| " + " | ".join(head) + " |", "|" + "---|" * len(head)] + ["| " + " | ".join(map(str, row)) + " |" for row in rows])


def write_parts(page, parts):
    """Puts each part of {name: text} between the marks <!-- name --> and <!-- end --> of the page, the path of which is below docs/."""
    page = ROOT / "docs" / page
    text = page.read_text(encoding="utf-8")
    for name, content in parts.items():
        pattern = re.compile(f"(<!-- {name} -->\n).*?(<!-- end -->)", re.S)
        if not pattern.search(text):
            raise SystemExit(f"{page}: the mark <!-- {name} --> is missing")
        text = pattern.sub(lambda match: match[1] + content + "\n" + match[2], text)
    page.write_text(text, encoding="utf-8")


def libraries(program):
    """Returns the second line of `ricochet --version`: libraries, and the kernels of OpenBLAS and of ours."""
    return output_of([program, "--version"]).splitlines()[1]


def blas_kernels(text):
    """Returns OpenBLAS' kernels from the text of `libraries`."""
    return re.match(r"OpenBLAS \S+ \((\w+)\)", text)[1]


def loaded_kernels():
    """Returns the kernels of the OpenBLAS that this process uses."""
    function = ctypes.CDLL("libopenblas.so.0").openblas_get_corename
    function.restype = ctypes.c_char_p
    return function().decode()


def with_kernels(kernels):
    """Returns the environment in which another program's OpenBLAS uses these kernels."""
    return os.environ | {"OPENBLAS_CORETYPE": kernels}


def processor():
    """Returns the name of this machine's processor."""
    return next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), "unknown processor")
