#!/usr/bin/env python3
"""large_contacts.py COUNTS.json: what contacts of up to 65,536 x 65,536 cells would take, on paper. Laws are fitted to
counts of some sizes, held to the sizes that were left out, and carried on to machines that are assumed. Prints Markdown,
which stands in docs/large-contacts.md."""

import json
import math
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

FIELDS = 2  # of tractions; the normal problem has one
COMPLEX = 16  # bytes
GIB = 2.0**30
MOST_NODES = 1024
GAIN = 1.5  # of time by twice the nodes, for which they are worth having
FITTED = (128, 256, 512)  # sizes; the others are left out
FITTED_IN_APPLICATIONS = (512, 1024, 2048)  # coarser meshes do not show all of a surface
FITTED_IN_MEMORY = (768, 1024, 1536)  # of seconds: smaller ones stay in a cache
FITTED_LENGTHS = (64, 256, 512, 1024, 2048)
# Bytes that one application of the tangential operator reads and writes for each cell, by the loops over it: tractions
# 16; the half-plane's columns written 32 (and fetched before 32), read and written in place 64, read 32; the kernel's
# spectrum 24; displacements 16 (and fetched before 16).
MOVED = 232
# With each application goes one of the preconditioner, on the grid without zeros: its half-plane is half as large.
PRECONDITIONED = 1.5


@dataclass
class Machine:
    """Assumptions that are not measured here."""

    name: str
    nodes: int
    cores: int  # of a node
    bandwidth: float  # bytes/s of a node's memory
    memory: float  # bytes of a node
    network: float = math.inf  # bytes/s that a node sends
    latency: float = 0.0  # s of a message


WORKSTATION = Machine("workstation", 1, 16, 80e9, 128 * GIB)
NODE = {"cores": 64, "bandwidth": 300e9, "memory": 512 * GIB, "network": 25e9, "latency": 2e-6}
CLUSTER = Machine("16 nodes", 16, **NODE)


def fit(rows, terms):
    """Factors of terms(row) with the least squares of relative residuals; rows: (size, value)."""
    values = np.array([value for _, value in rows])
    matrix = np.array([terms(n) for n, _ in rows]) / values[:, None]
    return np.linalg.lstsq(matrix, np.ones(len(rows)), rcond=None)[0]


class Law:
    """A sum of terms fitted to some of the rows; its largest relative error on the others."""

    def __init__(self, name, rows, terms, fitted):
        self.name, self.terms = name, terms
        self.factors = fit([row for row in rows if row[0] in fitted], terms)
        left = [(n, v) for n, v in rows if n not in fitted and n >= min(fitted)]
        self.fitted, self.left_out = fitted, [n for n, _ in left]
        self.error = max(abs(self(n) / v - 1.0) for n, v in left)

    def __call__(self, n):
        return sum(a * b for a, b in zip(self.factors, self.terms(n)))


def transforms(n):
    """Complex transforms of length n in one application: rows in pairs and the half-plane's columns, each in two halves,
    there and back."""
    return FIELDS * 2 * (n + 2 * (n + 1))


def sent(n, ranks):
    """Bytes that all ranks send in one application: each field's half-plane is transposed there and back."""
    return FIELDS * 2 * COMPLEX * n * (n + 1) * (1.0 - 1.0 / ranks)


def messages(ranks):
    """Messages that all ranks send in one application."""
    return FIELDS * 2 * ranks * (ranks - 1)


class Model:
    def __init__(self, counts):
        solves = counts["solves"]

        def law(name, key, terms, fitted):
            return Law(name, [(row["cells"], row[key]) for row in solves], terms, fitted)

        logarithm = (lambda n: (1.0, math.log2(n)))
        area = (lambda n: (1.0, n * n))
        area_alone = (lambda n: (n * n,))
        self.tangential = law("applications, tangential", "tangential", logarithm, FITTED_IN_APPLICATIONS)
        self.normal = law("applications, normal", "normal", logarithm, FITTED_IN_APPLICATIONS)
        self.memory = law("peak memory", "peak_bytes", area, FITTED)
        flops = [(row["length"], row["flops"] * transforms(row["length"])) for row in counts["transforms"]]
        self.flops = Law("flops of transforms", flops, lambda n: (n * n * math.log2(n),), FITTED_LENGTHS)
        rows = [(row["cells"], row["seconds"]) for row in counts["applications"]]
        self.seconds = Law("seconds of an application", rows, area_alone, FITTED_IN_MEMORY)
        rows = [(row["cells"], row["cpu_seconds"]) for row in solves if "cpu_seconds" in row]
        counted = {row["cells"]: row["tangential"] + 0.5 * row["normal"] for row in solves}
        self.solve = Law("seconds of a solve, by its applications", rows,
                         lambda n: (counted.get(n, 1.0) * self.seconds(n),), FITTED_IN_MEMORY)
        self.rest = self.solve.factors[0]  # applications that a solve takes the time of, for each that it does

    def laws(self):
        return self.tangential, self.normal, self.memory, self.flops, self.seconds, self.solve

    def applications(self, n):
        """Applications counted as tangential ones: the normal operator has half the fields."""
        return self.tangential(n) + 0.5 * self.normal(n)

    def computing(self, n, machine):
        """Seconds of one application and what a solve does beside it: no core is quicker than the one that was measured, no
        machine moves more than its memory does."""
        return self.rest * max(self.seconds(n) / machine.cores, MOVED * n * n / machine.bandwidth) / machine.nodes

    def sending(self, n, machine):
        """Seconds of one application, a rank a node, one message after the other."""
        ranks = machine.nodes
        return (PRECONDITIONED * sent(n, ranks) / ranks / machine.network +
                2.0 * messages(ranks) / ranks * machine.latency)

    def solve_seconds(self, n, machine):
        return self.applications(n) * (self.computing(n, machine) + self.sending(n, machine))

    def fits(self, n, machine):
        return self.memory(n) <= machine.nodes * machine.memory


def transpose_errors(counts):
    """Largest relative errors of sent() and messages(), and the most bytes over 64 N^2, of all that was counted."""
    rows = [row for row in counts["transposes"] if row["ranks"] > 1]
    return (max(abs(sent(row["cells"], row["ranks"]) / row["bytes"] - 1.0) for row in rows),
            max(abs(messages(row["ranks"]) / row["messages"] - 1.0) for row in rows),
            max(row["bytes"] / (64.0 * row["cells"]**2) for row in rows))


def duration(seconds):
    for size, unit in ((86400.0, "d"), (3600.0, "h"), (60.0, "min")):
        if seconds >= size:
            return f"{seconds / size:.1f} {unit}"
    return f"{seconds:.2g} s"


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)


def sizes_text(sizes):
    return ", ".join(map(str, sizes))


def time_and_memory(model):
    rows = []
    for n in (1024, 4096, 8192, 16384, 32768, 65536):
        row = [f"{n:,}²", f"{model.memory(n) / GIB:,.3g} GiB", f"{model.flops(n):.2g}", f"{MOVED * n * n:.2g}"]
        for machine in (WORKSTATION, CLUSTER):
            fits = model.fits(n, machine)
            row.append(duration(model.solve_seconds(n, machine)) if fits else "does not fit")
        rows.append(row)
    return rows


def strong(model, n):
    """On twice as many nodes each time, from as many as hold the contact."""
    rows = []
    nodes = first = max(1, 2 ** math.ceil(math.log2(model.memory(n) / NODE["memory"])))
    while nodes <= MOST_NODES:
        machine = Machine("", nodes, **NODE)
        seconds = model.solve_seconds(n, machine)
        begun = rows[0][1] if rows else seconds
        sending = model.sending(n, machine) / (model.sending(n, machine) + model.computing(n, machine))
        rows.append((nodes, seconds, begun * first / (seconds * nodes), sending))
        nodes *= 2
    return rows


def pays_to(rows):
    """The largest number of nodes at which the last doubling took at most two thirds of the time."""
    return max((after[0] for before, after in zip(rows, rows[1:]) if before[1] / after[1] >= GAIN), default=rows[0][0])


def weak(model):
    """8,192 x 8,192 cells a node."""
    rows = []
    for nodes in (1, 4, 16, 64):
        n, machine = 8192 * math.isqrt(nodes), Machine("", nodes, **NODE)
        rows.append((nodes, n, model.computing(n, machine) + model.sending(n, machine), model.solve_seconds(n, machine)))
    return rows


def tables(counts):
    model = Model(counts)
    size_error, message_error, part = transpose_errors(counts)
    strong_tables = []
    for n in (4096, 16384, 65536):
        rows = strong(model, n)
        strong_tables.append(f"{n:,}² pays up to {pays_to(rows)} nodes:\n\n" + table(
            ["nodes", "time", "efficiency", "of it sending"],
            [[nodes, duration(s), f"{100.0 * e:.0f} %", f"{100.0 * part_sent:.0f} %"] for nodes, s, e, part_sent in rows]))
    first = weak(model)[0]
    return {
        "laws": table(["law", "fitted to", "left out", "largest error there"], [
            [law.name, sizes_text(law.fitted), sizes_text(law.left_out), f"{100.0 * law.error:.1f} %"] for law in model.laws()]),
        "transposes": (f"{sum(row['ranks'] > 1 for row in counts['transposes'])} transposes were counted: bytes are right to "
                       f"{100.0 * size_error:.1g} % and messages to {100.0 * message_error:.1g} %; the most that was sent is "
                       f"{part:.2f} of 64 N²."),
        "sizes": table(["cells", "memory", "flops", "bytes moved", f"time, {WORKSTATION.name}", f"time, {CLUSTER.name}"],
                       time_and_memory(model)),
        "strong": "\n\n".join(strong_tables),
        "weak": table(["nodes", "cells", "an application", "efficiency", "a solve"],
                      [[nodes, f"{n:,}²", duration(s), f"{100.0 * first[2] / s:.0f} %", duration(all_of_it)]
                       for nodes, n, s, all_of_it in weak(model)]),
    }


def main():
    counts = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    for name, text in tables(counts).items():
        print(f"<!-- {name} -->\n{text}\n")


if __name__ == "__main__":
    main()
