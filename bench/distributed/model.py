"""Model of the cost of a step on more cores than this machine has; its numbers are measured or estimated, and marked as
such."""

import math

from measurement import table

# Estimates that cannot be measured here.
LATENCY = 1e-6          # s per message
NEIGHBOURS = 14         # of a part
OFF_MACHINE = 0.25      # of the boundary of a part
LINK = 0.2e9            # bytes/s per core between machines
CORES_PER_MACHINE, MACHINE_MEMORY = 64, 200e9  # bytes/s, shared by its cores
SUM = (5e-6, 2.5e-6)    # s of a global sum: first, and for each doubling
GATHER = 16.0 / 1e9     # additional s of a sum per process: each gathers the values of all
EXCHANGES = 12          # per iteration of contact, each with a barrier at its end
HOMES = 16              # largest number of processes that solve subdomains
PRESSED = 0.03          # of one face


def shared_nodes(dofs):
    """Nodes on the boundary of a part of so many dofs in three dimensions (docs/distributed.md: 3 n^(2/3) nodes)."""
    return 3.0 * (dofs / 3.0) ** (2.0 / 3.0)


class Step:
    """`measured` on one process: seconds per dof and iteration (on one core with the memory to itself), the bytes of
    these, gradient and contact iterations of a step, and seconds of a subdomain of 256 points per contact iteration."""

    def __init__(self, measured):
        self.measured = measured

    def iteration(self, dofs, cores):
        own, m = dofs / cores, self.measured
        sharing = min(cores, CORES_PER_MACHINE)
        rate = min(m["bytes"] / m["seconds"], MACHINE_MEMORY / sharing)
        work = own * m["bytes"] / rate
        bytes_of_boundary = shared_nodes(own) * 12.0
        exchange = NEIGHBOURS * LATENCY + OFF_MACHINE * bytes_of_boundary / LINK
        sums = 2.0 * self.sum_over_all(cores)
        return work + (exchange + sums if cores > 1 else 0.0)

    @staticmethod
    def sum_over_all(cores):
        return SUM[0] + SUM[1] * math.log2(max(cores, 2)) + GATHER * cores

    def zones(self, dofs, cores):
        """Each of these processes solves its share of subdomains one after another."""
        nodes_of_face = (dofs / 3.0) ** (2.0 / 3.0)
        zones = max(1, math.ceil(PRESSED * nodes_of_face / 256.0))
        return math.ceil(zones / min(HOMES, cores, zones)) * self.measured["zone"] + EXCHANGES * self.sum_over_all(cores)

    def seconds(self, dofs, cores):
        m = self.measured
        return m["iterations"] * self.iteration(dofs, cores), m["rounds"] * self.zones(dofs, cores)


def extrapolation(steps, memory_per_dof):
    """`steps`: name and Step. Seconds of gradients + of contact."""
    cores = (10, 100, 1000, 10000)
    rows = []
    for dofs in (1e7, 1e8, 1e9):
        for name, step in steps:
            cells = []
            for count in cores:
                gradients, contact = step.seconds(dofs, count)
                cells.append(f"{gradients:.2g} + {contact:.2g} s" if dofs / count > 1000 else "too small")
            memory = dofs * memory_per_dof
            text = f"{memory / 1e9:,.0f} GB" if memory < 1e12 else f"{memory / 1e12:.1f} TB"
            rows.append([f"10^{round(math.log10(dofs))}", text, name, *cells])
    return table(["dofs", "memory", "a wave crosses in a step", *(f"{c:,} cores" for c in cores)], rows)
