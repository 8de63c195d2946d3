"""The runs on which two revisions are compared, and the results compared for each: its exit status, and checksums of
its history and of its last frame."""

import concurrent.futures
import csv
import dataclasses
import hashlib
import json
import os
import pathlib
import signal
import subprocess
import tempfile
import tomllib

import h5py

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Settings of a method, tried in turn until a case is accepted: those of the case, then other masses.
DIAGONAL = (("mass.type=lumped",), ("mass.type=equivalent-lumped",))
METHODS = ((), ("mass.type=consistent",), ("mass.type=equivalent",), *DIAGONAL,
           ("mass.type=equivalent", "time.preset=textbook-half"))
# Cases for what no case of the collection uses.
OWN_CASES = sorted((pathlib.Path(__file__).resolve().parent / "cases").glob("*.toml"))
REFUSED = 2
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

    def results(self, runs):
        """Returns {name of the run: results compared}. All runs of a case and scheme use the plan with which the first
        of them is accepted."""
        groups = {}
        for run in runs:
            groups.setdefault((run.case, run.scheme), []).append(run)
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            return {name: result for found in pool.map(self.group, groups.values()) for name, result in found.items()}

    def group(self, runs):
        if not (self.root / runs[0].case).exists():
            return {str(run): NO_CASE for run in runs}
        for plan in plans(self.root / runs[0].case, runs[0].steps):
            first = self.result(runs[0], plan)
            if first["status"] != REFUSED:
                return {str(runs[0]): first} | {str(run): self.result(run, plan) for run in runs[1:]}
        return {str(run): first for run in runs}

    def result(self, run, plan):
        with tempfile.TemporaryDirectory() as folder:
            output = pathlib.Path(folder) / "out"
            status = self.execute(run, output, plan)
            return {"plan": str(plan), "status": status, "history": checksum(output),
                    "frame": frame_checksum(output / "results.h5"), "touches": has_contact(output / "history.csv")}

    def execute(self, run, output, plan):
        settings = [f"time.scheme={run.scheme}", "output.fields_every=1000000000", *plan.settings()]
        begin = [self.program, "run", run.case, "-o", output, "--threads", "2" if run.kind == "2 threads" else "1"]
        if run.kind == "2 ranks":
            begin = ["mpirun", "-n", "2", self.mpi_program, "run", run.case, "-o", output, "--threads", "1"]
        if run.kind != "resumed":
            return self.call(begin, settings, plan.end)
        settings.append("output.checkpoint_every=1000000000")
        status = self.call(begin, settings, plan.middle())
        if status not in (0, 5):
            return status
        return self.call([self.program, "run", "--resume", output], [], plan.end)

    def call(self, command, settings, end):
        more = [word for setting in (*settings, f"time.end={end!r}") for word in ("--set", setting)]
        environment = {name: value for name, value in os.environ.items() if name not in CHOSEN_KERNELS}
        with subprocess.Popen([*command, "--quiet", "--log-level", "off", *more], cwd=self.root, start_new_session=True,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                              env={**environment, **MPI, "OPENBLAS_NUM_THREADS": "1"}) as process:
            try:
                return process.wait(TIME_LIMIT)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                return "none within the time limit"


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


def frame_checksum(path):
    """Returns the checksum of all fields of the last frame, with their names."""
    if not path.exists():
        return ""
    total = hashlib.sha256()
    try:
        with h5py.File(path) as file:
            for name, values in sorted(file["frames"][max(file["frames"])].items()):
                total.update(name.encode() + values[()].tobytes())
    except (OSError, KeyError, ValueError):
        return "unreadable"
    return total.hexdigest()[:16]
