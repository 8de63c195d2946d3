#!/usr/bin/python3
"""Siconos' solvers of the contact problem, each with the settings that served it best.

    siconos_solvers.py PROBLEM.hdf5 [--solver NAME] [--tolerance T] [--raw]     # a single run
    siconos_solvers.py --serve                                                  # the server of run.py

Preparation. W is first scaled to unit size at every point (r = S r', W' = S W S, q' = S q with one number S_i =
w_i^(-1/2) per point, which leaves the cones unchanged): their residual, a natural map with unit step, then differs from
ours only by its norm, and the fixed steps of their defaults are suitable. `--raw` omits the scaling. Only the call of
the driver is timed, not the preparation; each call starts from zero (or from a given reaction) with fresh options.
"""

import argparse
import json
import os
import sys
import time
import warnings

for threads in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[threads] = "1"

import numpy as np
import scipy.sparse

import fclib
import measure

warnings.simplefilter("ignore")  # about index widths
try:
    import siconos.numerics as sn
except ModuleNotFoundError:  # the tables of solvers can be read without it, which is all that a check of options needs
    sn = None


class Setting:
    """A driver's solver with options: iparam and dparam by index or by name, and those of its inner solver likewise."""

    def __init__(self, text, name, iparam=None, dparam=None, inner=None, inner_iparam=None, storage="dense"):
        self.text, self.name, self.inner, self.storage = text, name, inner, storage
        self.iparam, self.dparam, self.inner_iparam = iparam or {}, dparam or {}, inner_iparam or {}

    def options(self, dimension, tolerance):
        def constant(key):
            return key if isinstance(key, int) else getattr(sn, f"SICONOS_FRICTION_{dimension}D_{key}")

        options = sn.SolverOptions(constant(self.name))
        options.dparam[0] = tolerance
        for key, value in self.iparam.items():
            options.iparam[constant(key)] = value if isinstance(value, int) else constant(value)
        for key, value in self.dparam.items():
            options.dparam[constant(key)] = value
        if self.inner:
            sn.solver_options_update_internal(options, 0, constant(self.inner))
        if self.inner_iparam:
            inner = sn.solver_options_get_internal_solver(options, 0)
            for key, value in self.inner_iparam.items():
                inner.iparam[constant(key)] = value
        return options


SWEEPS = {0: 100000}  # the default of 1000 is too few for long steps
STEPS = {0: 1000}
FREEZE = {0: 100000, "NSGS_FREEZING_CONTACT": 10}
EXTRAGRADIENT = {0: 1000, "NSN_HYBRID_STRATEGY": "NSN_HYBRID_STRATEGY_VI_EG_NSN"}
NEWTON, PROJECTION = "ONECONTACT_NSN", "ONECONTACT_ProjectionOnCone"

# Error evaluation: NSGS keeps its default, the cheap error while sweeping and the full one at the end
# (LIGHT_WITH_FULL_FINAL): FULL at every sweep gives the same answers later; the other solvers evaluate the full error
# at every iteration. Tried and nowhere faster: relaxation and shuffling in 3D, filtering, adaptive inner tolerances,
# the other three formulations and line searches of NSN_AC, sparse storage (W is dense). Crashes or no convergence: the
# quartic and diagonalized local solvers, NSN_AC's adaptive rho and its loops with projections, ADMM with rho from
# eigenvalues or without acceleration, PFP, NSGSV, DSFP, and in 2D the enumerative solver and relaxed NSGS on blocks.
SOLVERS = {
    3: {
        "NSGS": Setting("Gauss-Seidel, local solver by default (Newton, hybrid)", "NSGS", SWEEPS),
        "NSGS-newton": Setting("with plain local Newton", "NSGS", SWEEPS, inner=NEWTON),
        "NSGS-newton-blocks": Setting("the same, W stored by blocks", "NSGS", SWEEPS, inner=NEWTON, storage="blocks"),
        "NSGS-projection-blocks": Setting(
            "with one local projection, W by blocks", "NSGS", SWEEPS, inner=PROJECTION, storage="blocks"
        ),
        "NSGS-newton-freeze": Setting(
            "local Newton, freezing contacts that do not move, W by blocks", "NSGS", FREEZE, inner=NEWTON, storage="blocks"
        ),
        "NSGS-projection-freeze": Setting(
            "local projection, freezing, W by blocks", "NSGS", FREEZE, inner=PROJECTION, storage="blocks"
        ),
        "NSN_AC": Setting("nonsmooth Newton, Alart-Curnier", "NSN_AC", STEPS),
        "NSN_AC-extragradient": Setting("the same after an extragradient start", "NSN_AC", EXTRAGRADIENT),
        "NSN_JM-extragradient": Setting(
            "Jean-Moreau after an extragradient start",
            "NSN_AC",
            {**EXTRAGRADIENT, "NSN_FORMULATION": "NSN_FORMULATION_JEANMOREAU_GENERATED"},
        ),
        "NSN_FB": Setting("nonsmooth Newton, Fischer-Burmeister", "NSN_FB", STEPS),
        "NSN_NM": Setting("nonsmooth Newton, natural map", "NSN_NM", STEPS),
        "PROX": Setting("proximal point, inner NSN_AC", "PROX"),
        "PROX-NSGS": Setting("proximal point, inner NSGS", "PROX", inner="NSGS", inner_iparam=SWEEPS),
        "ADMM": Setting("its defaults", "ADMM"),
        "ADMM-norm": Setting("initial rho from the norm", "ADMM", {"ADMM_IPARAM_INITIAL_RHO": "ADMM_INITIAL_RHO_NORM_INF"}),
        "ADMM-balancing": Setting(
            "rho by residual balancing", "ADMM", {"ADMM_IPARAM_RHO_STRATEGY": "ADMM_RHO_STRATEGY_RESIDUAL_BALANCING"}
        ),
        "ACLMFP": Setting("fixed point of convex problems", "ACLMFP"),
        "VI_EG": Setting("extragradient", "VI_EG", SWEEPS),
        "VI_FPP": Setting("fixed-point projection", "VI_FPP", SWEEPS),
    },
    2: {
        "NSGS": Setting("Gauss-Seidel, exact local solver", "NSGS", SWEEPS),
        "NSGS-shuffle": Setting("in random order", "NSGS", {0: 100000, 5: 1}),
        "NSGS-blocks": Setting("W by blocks", "NSGS", SWEEPS, storage="blocks"),
        "LEMKE": Setting("Lemke's pivoting on the LCP", "LEMKE", SWEEPS),
        "CPG": Setting("conjugate projected gradient", "CPG", SWEEPS),
    },
}
# Solvers that are also shown without the scaling to unit size.
RAW = {3: ("NSGS-newton-blocks", "NSN_AC", "NSN_AC-extragradient", "PROX", "ADMM", "ADMM-norm", "VI_EG"), 2: ("NSGS", "LEMKE", "CPG")}


class Loaded:
    """A problem in the storages that its solvers need."""

    def __init__(self, path):
        self.problem = fclib.read(path)
        self.measure = measure.Measure(self.problem)
        self.matrices = {}
        weights = np.where(self.measure.weights > 0, self.measure.weights, 1.0)
        self.factors = {True: np.ones(self.problem.offset.size), False: np.repeat(weights**-0.5, self.problem.dimension)}

    def matrix(self, storage, raw):
        key = storage, raw
        if key not in self.matrices:
            factor = self.factors[raw]
            scaled = np.asfortranarray(factor[:, None] * self.problem.operator * factor)
            if storage == "blocks":
                dimension = self.problem.dimension
                blocks = scipy.sparse.bsr_matrix(scaled, blocksize=(dimension, dimension)).tocsc()
                scaled = sn.SBM_from_csparse(dimension, blocks)[1]
            self.matrices[key] = scaled
        return self.matrices[key]

    def own_tolerance(self, tolerance, raw):
        """Returns the tolerance with which an evenly accurate answer meets `tolerance` in our measure.

        Theirs is the 2-norm over all points relative to |q|, ours the largest over the points relative to the largest
        at r = 0.
        """
        norm = np.linalg.norm(self.factors[raw] * self.problem.offset)
        if raw or norm == 0.0:
            return tolerance
        return tolerance * self.measure.scale * self.problem.points**0.5 / norm

    def solve(self, name, tolerance, raw=False, start=None, repeat=1, budget=0.3):
        """Returns the times of `repeat` calls, fewer if together they take longer than `budget` seconds, and the
        reactions."""
        problem, factor = self.problem, self.factors[raw]
        setting = SOLVERS[problem.dimension][name]
        siconos = sn.FrictionContactProblem(
            problem.dimension, problem.points, self.matrix(setting.storage, raw), factor * problem.offset, problem.coefficient
        )
        driver = sn.fc3d_driver if problem.dimension == 3 else sn.fc2d_driver
        seconds = []
        while len(seconds) < repeat and (not seconds or sum(seconds) < budget):
            options = setting.options(problem.dimension, tolerance)
            reaction, motion = np.zeros(problem.offset.size), np.zeros(problem.offset.size)
            if start is not None:
                reaction[:] = np.asarray(start) / factor
                motion[:] = factor * (problem.operator @ np.asarray(start) + problem.offset)
            begin = time.process_time()
            status = driver(siconos, reaction, motion, options)
            seconds.append(time.process_time() - begin)
        return {
            "seconds": float(np.median(seconds)),
            "status": int(status),
            "claimed": float(options.dparam[1]),
            "iterations": int(options.iparam[1]),
        }, factor * reaction


def serve():
    """Serves one JSON request per line on standard input with one JSON answer per line; the problem stays loaded."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # Siconos prints
    loaded, path = None, None
    for line in sys.stdin:
        request = json.loads(line)
        if request["problem"] != path:
            loaded, path = Loaded(request["problem"]), request["problem"]
        start = np.load(request["start"]) if request.get("start") else None
        raw = request.get("raw", False)
        tolerance = request["tolerance"]
        if request.get("ours", True):
            tolerance = loaded.own_tolerance(tolerance, raw)
        answer, reaction = loaded.solve(
            request["solver"], tolerance * request.get("tighten", 1.0), raw, start, request.get("repeat", 1)
        )
        np.save(request["reaction"], reaction)
        print(json.dumps(answer), file=answers, flush=True)


def main():
    parser = argparse.ArgumentParser(description="Siconos' solvers on one problem in FCLib's format")
    parser.add_argument("problem", nargs="?")
    parser.add_argument("--solver", help="only this solver (default: all)")
    parser.add_argument("--tolerance", type=float, default=1e-8)
    parser.add_argument("--raw", action="store_true", help="without the scaling to unit size")
    parser.add_argument("--serve", action="store_true")
    arguments = parser.parse_args()
    if sn is None:
        sys.exit("siconos_solvers.py: Siconos is missing: apt-get install python3-siconos")
    sn.numerics_set_verbose(0)
    if arguments.serve:
        serve()
        return
    if not arguments.problem:
        parser.error("a problem file is required")
    loaded = Loaded(arguments.problem)
    for name in [arguments.solver] if arguments.solver else SOLVERS[loaded.problem.dimension]:
        tolerance = loaded.own_tolerance(arguments.tolerance, arguments.raw)
        answer, reaction = loaded.solve(name, tolerance, arguments.raw, repeat=5)
        print(f"{name:24s} {answer['seconds'] * 1e3:10.3f} ms {answer['iterations']:6d} iterations, claims "
              f"{answer['claimed']:.1e}, residual {loaded.measure.residual(reaction):.1e}", flush=True)


if __name__ == "__main__":
    main()
