"""Distribution of the processor time of a run, from perf's samples."""

import re
import shutil
import subprocess

import problems

# The first pattern that matches a line "library symbol" counts.
GROUPS = [("triangular solves", r"supernode_(for|back)ward|panels_(for|back)ward|SupernodalFactor::(gather|forward|backward)"),
          ("internal forces and energies: cells, law", r"run_in_packs|CellPacks|for_each_part|find_strains|find_gradients|add_forces|libm\.so|libm-"),
          ("factors and tangents", r"multiply_avx|subtract_panel|factor|metis|amd|camd|tangent|add_rows|matrix_on_graph|CellKernel|PointLaw|NeoHookean|Elastic|"
                                   r"inverse_metric|add_dyad|add_symmetric_product|Matrix<double, [236], [236]"),
          ("products with the mass, vectors", r"multiply_scalars|multiply_blocks|NodeMatrix|memcpy|memset|memmove|Eigen"),
          ("kernel of the system", r"kernel\.kallsyms|\[kernel")]


def samples(program, case, directory, until):
    """Returns {group: samples}, or None if perf is not installed."""
    if not shutil.which("perf"):
        return None
    data = directory / "perf.data"
    command = ["perf", "record", "-q", "-F", "1999", "-e", "cpu-clock", "-o", str(data), str(program), "run", str(case), "-o", str(directory / "run"), "--force",
               "--quiet", "--threads", "1", "--log-level", "error", "--set", f"time.end={until!r}", "--set", "output.history_every=1000000"]
    if subprocess.run(command, capture_output=True).returncode != 0:
        return None
    text = subprocess.run(["perf", "report", "-i", str(data), "--no-children", "--stdio", "-n", "--sort", "dso,symbol"], capture_output=True, text=True).stdout
    counts = {name: 0 for name, _ in GROUPS} | {"else": 0}
    for line in text.splitlines():
        match = re.match(r"\s*[\d.]+%\s+(\d+)\s+(.*)", line)
        if match:
            group = next((name for name, pattern in GROUPS if re.search(pattern, match[2])), "else")
            counts[group] += int(match[1])
    return counts


def of_steps(program, case, directory, steps):
    """Returns the samples of the steps with contact: those of a run less those of one that ends before contact."""
    long = samples(program, case, directory, steps * problems.STEP)
    short = samples(program, case, directory, problems.FLIGHT * problems.STEP)
    return long and short and {name: max(0, long[name] - short[name]) for name in long}
