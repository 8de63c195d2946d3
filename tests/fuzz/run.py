#!/usr/bin/env python3
"""Runs the fuzzers for some seconds each, as many at a time as there are processors, and reports the results.

    ./dev fuzz [--seconds 60] [NAME...]

Seeds come from the repository: tests/fuzz/corpus/NAME, the meshes of the tests, the cases of the collection. Inputs that
a fuzzer adds stay in build-fuzz/corpus/NAME as seeds of its next run; an input that crashes it, hangs it (10 s) or makes
it request absurd memory (256 MB at once, 1 GB in all) is left in build-fuzz/found/NAME-*. Status 1 if there is one.
"""

import argparse
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
MESHES = ROOT / "tests" / "data" / "meshes"
CORPUS = ROOT / "tests" / "fuzz" / "corpus"
LIMITS = ["-timeout=10", "-rss_limit_mb=1024", "-malloc_limit_mb=256", "-max_len=16384"]

MESH_WORDS = ["$MeshFormat", "$EndMeshFormat", "$PhysicalNames", "$EndPhysicalNames", "$Entities", "$EndEntities",
              "$Nodes", "$EndNodes", "$Elements", "$EndElements", "$Periodic", "$Comments",
              "2.2 0 8", "2.2 1 8", "4.1 0 8", "4.1 1 8",
              "\\x01\\x00\\x00\\x00", "\\xff\\xff\\xff\\xff", "\\xff\\xff\\xff\\xff\\xff\\xff\\xff\\x7f", "4294967295",
              "9223372036854775807", "-1", "1e308", "nan", "inf"]

# Lengths of names, kinds of values, counts: see io/checkpoint.hpp.
CHECKPOINT_WORDS = ["RICOCHET", "\\x01\\x00\\x00\\x00", "\\x00\\x01\\x00\\x00\\x00\\x00\\x00\\x00\\x00",
                    "\\x01\\xff\\xff\\xff\\xff\\xff\\xff\\xff\\xff", "\\x02\\xff\\xff\\xff\\x1f\\x00\\x00\\x00\\x00"]


def mesh_seeds(dialect, kind):
    return sorted(path for path in MESHES.glob(f"*msh{dialect}_{kind}.msh"))


# Returns, by name, the program, the seeds, and the words that a fuzzer may insert.
def targets():
    documented = (ROOT / "docs" / "case-file.md").read_text(encoding="utf-8")
    words = sorted(set(re.findall(r"`\"?([a-zA-Z_][a-zA-Z_0-9-]*)\"?`", documented)))
    words += ["[[", "]]", "= [", "= {", "\\x22\\x22\\x22", "#--set ", "1e400", "-0.0", "nan", "inf",
              "9223372036854775807", "sin(2*pi*t)", "1979-05-27", "0xffff", "\\x00", "\\xff"]
    cases = sorted((CORPUS / "case").iterdir()) + sorted((ROOT / "cases").glob("*/*.toml"))
    result = {"case": ("fuzz_case", cases, words)}
    for dialect in ("22", "41"):
        for kind in ("ascii", "binary"):
            result[f"msh{dialect}-{kind}"] = ("fuzz_mesh", mesh_seeds(dialect, kind), MESH_WORDS)
    result["checkpoint"] = ("fuzz_checkpoint", sorted((CORPUS / "checkpoint").iterdir()), CHECKPOINT_WORDS)
    return result


def run(build, name, target, seconds):
    program, seeds, words = target
    assert seeds, f"{name} has no seeds"
    corpus, given, found = build / "corpus" / name, build / "seeds" / name, build / "found"
    for directory in (corpus, given, found):
        directory.mkdir(parents=True, exist_ok=True)
    for number, seed in enumerate(seeds):
        (given / f"{number}-{seed.name}").write_bytes(seed.read_bytes())
    dictionary = build / f"{name}.dict"
    dictionary.write_text("".join(f'"{word}"\n' for word in words), encoding="utf-8")
    started = time.monotonic()
    done = subprocess.run(
        [build / program, corpus, given, f"-max_total_time={seconds}", f"-dict={dictionary}", "-print_final_stats=1",
         "-reload=0", f"-artifact_prefix={found / name}-", *LIMITS],
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace", check=False,
        env=dict(os.environ, ASAN_OPTIONS="detect_leaks=0:" + os.environ.get("ASAN_OPTIONS", "")))
    figures = dict(re.findall(r"stat::(\w+):\s+(\d+)", done.stderr))
    coverage = re.findall(r"cov: (\d+)", done.stderr)
    return {"name": name, "failed": done.returncode != 0, "seconds": time.monotonic() - started,
            "executions": int(figures.get("number_of_executed_units", 0)), "memory": int(figures.get("peak_rss_mb", 0)),
            "slowest": int(figures.get("slowest_unit_time_sec", 0)), "coverage": int(coverage[-1]) if coverage else 0,
            "log": done.stderr}


def main():
    known = targets()
    parser = argparse.ArgumentParser(prog="./dev fuzz", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=int, default=60, help="seconds per fuzzer (default: %(default)s)")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build-fuzz", help="folder of the fuzzers")
    parser.add_argument("--check", action="store_true", help="only check the arguments")
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(known))
    arguments = parser.parse_args()
    unknown = [name for name in arguments.names if name not in known]
    if unknown:
        parser.error(f"there is no fuzzer {unknown[0]}; available: {', '.join(known)}")
    if arguments.seconds < 1:
        parser.error("--seconds must be at least 1")
    if arguments.check:
        return 0
    names = arguments.names or list(known)
    print(f"{'fuzzer':<14}{'executions':>12}{'seconds':>9}{'edges':>8}{'slowest, s':>12}{'memory, MB':>12}", flush=True)
    failures = []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        runs = [pool.submit(run, arguments.build.resolve(), name, known[name], arguments.seconds) for name in names]
        for each in runs:
            r = each.result()
            print(f"{r['name']:<14}{r['executions']:>12}{r['seconds']:>9.0f}{r['coverage']:>8}{r['slowest']:>12}"
                  f"{r['memory']:>12}{'  FAILED' if r['failed'] else ''}", flush=True)
            if r["failed"]:
                failures.append(r)
    for r in failures:
        print(f"\n{r['name']}:\n" + "\n".join(r["log"].splitlines()[-60:]), file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
