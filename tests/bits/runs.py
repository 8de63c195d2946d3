"""The runs on which two revisions are compared, and the results compared for each: its exit status, and checksums of
its history and of its last frame."""

import concurrent.futures
import csv
import dataclasses
import hashlib
import json
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import tomllib

import h5py

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Settings of a method, tried in turn until a case is accepted: those of the case, then other masses.
DIAGONAL = (("mass.type=lumped",), ("mass.type=equivalent-lumped",))
NEWMARK = ("mass.type=equivalent", "time.preset=textbook-half")
METHODS = ((), ("mass.type=consistent",), ("mass.type=equivalent",), *DIAGONAL, NEWMARK)
# Cases for what no case of the collection uses.
OWN_CASES = sorted((pathlib.Path(__file__).resolve().parent / "cases").glob("*.toml"))
REFUSED = 2
# A method whose refusal has these words may be accepted with another step.
ABOUT_STEPS = re.compile(r"time\.step\b|\b(first|critical|stable) step")
# Statuses with which a run ends: done, refused, not converged, failed expectations. Others are faults of the machine or
# of the program.
ENDS = (0, REFUSED, 3, 5)
TIME_LIMIT = 1800  # seconds
NO_CASE = {"plan": "no such case", "status": None, "history": "", "frame": "", "touches": False}
# Settings of the user's shell that choose other kernels.
CHOSEN_KERNELS = ("OPENBLAS_CORETYPE", "RICOCHET_INSTRUCTION_SET")
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
       "OMPI_MCA_mpi_yield_when_idle": "1"}


@dataclasses.dataclass(frozen=True)
class Run:
    case: str  # relative to the root of the sources, or absolute
    scheme: str
    kind: str  # "1 thread", "2 threads", "resumed", "2 ranks"
    steps: int

    def __str__(self):
        return f"{self.case.removeprefix(f'{ROOT}/')} {self.scheme} ({self.kind})"


@dataclasses.dataclass(frozen=True)
class Plan:
    """Time steps of a run, and settings of the method."""
    step: float  # None: adaptive, with the settings of the case
    count: int
    end: float
    method: tuple

    def __str__(self):
        steps = "adaptive steps" if self.step is None else f"{self.count} steps of {self.step:g}"
        return " ".join((steps, *self.method))

    def middle(self):
        return 0.5 * self.end if self.step is None else self.step * (self.count // 2)

    def settings(self):
        return [*([] if self.step is None else [f"time.step={self.step!r}"]), *self.method]


def schemes(program):
    schema = json.loads(subprocess.run([program, "schema"], check=True, capture_output=True, text=True).stdout)
    return schema["properties"]["time"]["properties"]["scheme"]["enum"]


def cases(root):
    """Returns the cases of a tree of sources, and those beside this file, which both sides run."""
    return {str(path.relative_to(root)) for path in root.glob("cases/*/*.toml")} | {str(path) for path in OWN_CASES}


def all_runs(of_cases, program, kinds, steps):
    """Returns every case under every scheme, with at most so many steps."""
    names = schemes(program)
    return [Run(case, scheme, kind, steps) for case in sorted(of_cases) for scheme in names for kind in kinds]


def plans(case, steps):
    """Returns the plans of a case. The steps cover its time, so that there is contact. If they are refused as too long,
    the case's own steps follow, and then those of explicit schemes, which end earlier."""
    time = tomllib.loads(case.read_text())["time"]
    adaptive = time["step"] == "adaptive"
    longest = time["largest"] if adaptive else time["step"]
    own = max(round(time["end"] / longest), 1)
    grids = [(longest, own)] if own <= steps else [(time["end"] / steps, steps), (longest, steps)]
    return ([Plan(None, 0, float(time["end"]), method) for method in METHODS if adaptive] +
            [Plan(step, count, step * count, method) for step, count in grids for method in METHODS] +
            [Plan(longest / 20, steps, longest / 20 * steps, method) for method in DIAGONAL])


class Side:
    """One of two revisions: its sources and its programs."""

    def __init__(self, root):
        self.root = pathlib.Path(root)
        self.program = self.root / "build" / "ricochet"
        self.mpi_program = self.root / "build" / "ricochet-mpi"
        self.cache = ""  # of meshes: none

    def results(self, runs):
        """Returns {name of the run: results compared}. All runs of a case and scheme use the plan with which the first
        of them is accepted."""
        groups = {}
        for run in runs:
            groups.setdefault((run.case, run.scheme), []).append(run)
        # Each side makes its meshes itself.
        with (tempfile.TemporaryDirectory() as self.cache, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool):
            return {name: result for found in pool.map(self.group, groups.values()) for name, result in found.items()}

    def group(self, runs):
        if not (self.root / runs[0].case).exists():
            return {str(run): NO_CASE for run in runs}
        # Methods that are refused with steps of any length.
        hopeless = set() if runs[0].scheme == "newmark" else {NEWMARK}
        for plan in plans(self.root / runs[0].case, runs[0].steps):
            if plan.method in hopeless:
                continue
            first, message = self.result(runs[0], plan)
            if first["status"] != REFUSED:
                return {str(runs[0]): first} | {str(run): self.result(run, plan)[0] for run in runs[1:]}
            if not ABOUT_STEPS.search(message):
                hopeless.add(plan.method)
        return {str(run): first for run in runs}

    def result(self, run, plan):
        """Returns the results compared, and what the run wrote to stderr."""
        with tempfile.TemporaryDirectory() as folder:
            output = pathlib.Path(folder) / "out"
            status, message = self.execute(run, output, plan)
            return {"plan": str(plan), "status": status, "history": checksum(output),
                    "frame": frame_checksum(output), "touches": has_contact(output / "history.csv")}, message

    def execute(self, run, output, plan):
        settings = [f"time.scheme={run.scheme}", "output.fields_every=1000000000", *plan.settings()]
        begin = [self.program, "run", run.case, "-o", output, "--threads", "2" if run.kind == "2 threads" else "1"]
        if run.kind == "2 ranks":
            begin = ["mpirun", "-n", "2", self.mpi_program, "run", run.case, "-o", output, "--threads", "1"]
        if run.kind != "resumed":
            return self.call(begin, settings, plan.end)
        settings.append("output.checkpoint_every=1000000000")
        status, message = self.call(begin, settings, plan.middle())
        if status not in (0, 5):
            return status, message
        return self.call([self.program, "run", "--resume", output], [], plan.end)

    def call(self, command, settings, end):
        """Returns the status of the program and what it wrote to stderr."""
        more = [word for setting in (*settings, f"time.end={end!r}") for word in ("--set", setting)]
        environment = {name: value for name, value in os.environ.items() if name not in CHOSEN_KERNELS} | MPI
        with subprocess.Popen([*command, "--quiet", "--log-level", "off", *more], cwd=self.root, start_new_session=True,
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                              env={**environment, "RICOCHET_CACHE": self.cache, "OPENBLAS_NUM_THREADS": "1"}) as process:
            try:
                message = process.communicate(timeout=TIME_LIMIT)[1]
                return process.returncode, message
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                return "none within the time limit", ""


def checksum(output):
    """Returns the checksum of the history and of the probes with rows of their own."""
    if not (output / "history.csv").exists():
        return ""
    files = [output / "history.csv", *sorted(output.glob("probes-*.csv"))]
    return hashlib.sha256(b"".join(path.read_bytes() for path in files)).hexdigest()[:16]


def has_contact(path):
    """Returns whether any step had contact."""
    if not path.exists():
        return False
    with path.open(newline="", encoding="utf-8") as file:
        return any(float(row["active_contacts"]) > 0.0 for row in csv.DictReader(file))


def frame_checksum(output):
    """Returns the checksum of all fields of the last frame of results.h5, or of all of results.vtkhdf, with their names."""
    total = hashlib.sha256()

    def add(name, item):
        if isinstance(item, h5py.Dataset):
            total.update(name.encode() + item[()].tobytes())

    paths = [path for path in (output / "results.h5", output / "results.vtkhdf") if path.exists()]
    try:
        for path in paths:
            with h5py.File(path) as file:
                (file["frames"][max(file["frames"])] if path.suffix == ".h5" else file).visititems(add)
    except (OSError, KeyError, ValueError):
        return "unreadable"
    return total.hexdigest()[:16] if paths else ""
