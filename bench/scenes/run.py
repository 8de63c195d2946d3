#!/usr/bin/env python3
"""Random scenes: properties on which all observers, all descriptions and the energy account must agree.

    ./dev bench scenes [--count 1000] [--first 1] [--only FAMILY…] [--seed N] [--keep FOLDER]

A scene is drawn from its seed: bodies in the plane, axisymmetric and in space, at small and finite strain, against obstacles of
every kind at rest, moving and rotating, against free rigid bodies, against each other and themselves. Each is run with some twins.
Prints a line for each finding, with the seed, the property, its size and the folder that has the cases, then tables; those of
the first 1,000 scenes are written into docs/energy.md. Status 1: there are findings.
"""

import collections
import concurrent.futures
import os
import pathlib
import random
import shutil
import sys
import tempfile
import time

BENCH = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(BENCH), str(BENCH / "scenes")]
import energy
import properties
from draw import FAMILIES, scene_of
from measurement import BUILD, Arguments, positive, programs_seconds, table, write_parts

PROGRAM = pathlib.Path(os.environ.get("RICOCHET_PROGRAM") or BUILD / "ricochet")
TWINS = 5  # properties per scene
DOCUMENTED = (0, 2, 3)  # statuses in which a run may end


def judge_run(scene, run, name):
    """Returns the findings of one run by itself."""
    found = []
    if run.status not in DOCUMENTED or run.status != 0 and not run.error():
        found.append(("status", float("inf"), f"{run.status}: {run.error()[:300]}"))
    if run.columns:
        found += energy.findings(scene, run)
    return [(name, *finding) for finding in found]


def draw_names(choices, seed):
    """Draws properties, each at most once; those that are listed several times are drawn more often."""
    names, chosen = [], random.Random(seed + 1)
    while choices and len(names) < TWINS:
        name = chosen.choice(choices)
        choices = [c for c in choices if c != name]
        names.append(name)
    return names


def examine(seed, folder, wanted=None):
    """Returns (scene, its run, whether it touches, [(run, property, size, text)], properties, processor seconds)."""
    scene, before = scene_of(seed), programs_seconds()
    folder.mkdir(parents=True, exist_ok=True)
    twins = properties.Twins(scene, PROGRAM, folder)
    base, found = twins.base, judge_run(scene, twins.base, "base")
    names = []
    # A case that is refused has nothing to compare.
    if base.columns:
        choices = properties.properties_of(scene)
        names = list(dict.fromkeys(c for c in choices if c in wanted)) if wanted else draw_names(choices, seed)
    for name in names:
        differences, twin = properties.check(twins, name)
        found += [("twin", *d) for d in differences]
        # The twin's units differ, and its findings are relative.
        if twin.columns and name not in ("units", "heavy"):
            found += judge_run(twin.scene, twin, name)
        elif twin.status not in DOCUMENTED:
            found.append((name, "status", float("inf"), f"{twin.status}: {twin.error()[:300]}"))
    touches = max(base.columns.get("active_contacts", [0])) > 0
    return scene, base, touches, found, names, programs_seconds() - before


def report_of(seed, folder, keep, wanted):
    """Returns the output and counts of a scene; its files are kept if something is found, or on request."""
    scene, base, touches, found, names, seconds = examine(seed, folder, wanted)
    if not keep and not found:
        shutil.rmtree(folder, ignore_errors=True)
    kind = f"{scene.dimension}D" if scene.plane != "axisymmetric" else "axisymmetric"
    law = "finite" if scene.facts["finite"] else "linear"
    lines = [f"{seed} {scene.family} {kind} {law} friction {scene.facts['friction']:.2g} {' '.join(scene.facts.get('kinds', []))}: "
             f"{run}: {name}: {size:.1e}: {text} ({folder})" for run, name, size, text in found]
    return scene.family, base.status, touches, lines, [f[1] for f in found], names, seconds


def seeds_of(options):
    """Returns the first seeds whose scenes belong to the wanted families."""
    if options.seed is not None:
        return [options.seed]
    seeds, seed = [], options.first
    while len(seeds) < options.count:
        if not options.only or scene_of(seed).family in options.only:
            seeds.append(seed)
        seed += 1
    return seeds


def parse():
    parser = Arguments("scenes", __doc__, build="")
    parser.add_argument("--count", type=positive, default=1000, help="number of scenes (default: %(default)s)")
    parser.add_argument("--first", type=int, default=1, help="seed of the first scene (default: %(default)s)")
    parser.add_argument("--seed", type=int, help="only this scene")
    parser.add_argument("--only", nargs="+", choices=sorted(set(FAMILIES)), help="only these families of scenes")
    parser.add_argument("--properties", nargs="+", metavar="NAME", help="only these properties, wherever they apply")
    parser.add_argument("--keep", type=pathlib.Path, help="folder in which the cases and results of all scenes are kept")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="number of scenes at a time (default: %(default)s)")
    return parser.parse()


def main():
    options = parse()
    folder = options.keep or pathlib.Path(tempfile.mkdtemp(prefix="ricochet-scenes-"))
    begin, total, bad = time.monotonic(), 0.0, 0
    families = collections.defaultdict(collections.Counter)
    compared, broken = collections.Counter(), collections.Counter()
    with concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
        jobs = [pool.submit(report_of, seed, folder / f"scene-{seed}", options.keep is not None, options.properties)
                for seed in seeds_of(options)]
        for job in concurrent.futures.as_completed(jobs):
            family, status, touches, lines, kinds, names, seconds = job.result()
            families[family].update({"scenes": 1, "touch": touches, f"status {status}": 1, "findings": bool(lines)})
            compared.update(names)
            broken.update(set(kinds))
            total += seconds
            bad += bool(lines)
            for line in lines:
                print(line, flush=True)
    tables = family_table(families), property_table(compared, broken)
    print("\n\n".join(tables))
    print(f"\n{total:.0f} s of processor time, {time.monotonic() - begin:.0f} s")
    if not bad and not options.keep:
        shutil.rmtree(folder, ignore_errors=True)
    # Tables of other scenes would not match the text of the page.
    if options.count >= 1000 and options.first == 1 and options.seed is None and not options.only and not options.properties:
        write_parts("energy.md", {"random-scenes": tables[0], "random-scenes-properties": tables[1]})
    return 1 if bad else 0


def family_table(families):
    counts = ("scenes", "touch", "status 2", "status 3", "findings")
    return table(["family", "scenes", "with contact", "refused", "stopped", "with findings"],
                 [[name, *(families[name][count] for count in counts)] for name in sorted(families)])


def property_table(compared, broken):
    return table(["property", "twins", "scenes with findings"],
                 [[name, compared[name] or "–", broken[name]] for name in sorted({*compared, *broken, *energy.PROPERTIES})])


if __name__ == "__main__":
    sys.exit(main())
