"""Reads .inp files of Abaqus and CalculiX.

meshio's reader loses surfaces, the numbers of elements, instances, and the sets of included files, so it is not used
here.
"""

import os
import re
import stat

import numpy

from file_mesh import TYPES, Block, FileMesh, Refusal, choices, dimension_of

# Numbers of nodes of the kinds that Abaqus has, which are those without nodes on faces: some are refused by name later.
SIZES = {"quad8": 8, "hexahedron20": 20, "wedge": 6, "wedge15": 15, "pyramid": 5, "pyramid13": 13,
         **{name: kind.nodes for name, kind in TYPES.items() if not kind.has_face_nodes}}
LINES, PLANES, SOLIDS = ({str(size): kind for kind, size in SIZES.items() if dimension_of(kind) == dimension}
                         for dimension in (1, 2, 3))
# Keywords that generate nodes, elements or sets in ways not read here: ignoring them would give another mesh.
GENERATORS = {"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM", "SUBSTRUCTURE PATH", "SYMMETRIC MODEL GENERATION"}
# A number with more digits does not fit into 64 bits; Abaqus itself accepts nine.
LONGEST_NUMBER = 18
# Python's float() and int() also accept "nan" and "1_0".
NUMBER = {int: re.compile(r"[+-]?\d+", re.ASCII),
          float: re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([EeDd][+-]?\d+)?", re.ASCII)}


def element_kind(name, fail):
    """Returns the kind of an element type, or None for types outside the mesh of a body (masses, springs)."""
    name = name.upper()
    for pattern, kinds in ((r"(?:C3D|DC3D|AC3D)(\d+)", SOLIDS), (r"(?:CPS|CPE|CPEG|DC2D|AC2D)(\d)", PLANES),
                           (r"(?:S|M3D|SFM3D|R3D|DS|STRI|SC)(\d+)", PLANES),
                           (r"(?:T2D|T3D|R2D|SAX)(\d)", LINES)):
        match = re.fullmatch(pattern + r"[A-Z]*\d?[A-Z]*", name)
        if match and match.group(1) in kinds:
            return kinds[match.group(1)]
    if re.match(r"B[23][123]", name):
        return LINES["3" if name[2] == "2" else "2"]
    if re.match(r"(DC|C)?CAX|CGAX|MAX|SAX|DCAX", name):
        fail(f"elements of type {name} are not supported; write the section of an axisymmetric body with CPE3, CPE4 or "
             "CPE6, and set mesh.plane = \"axisymmetric\"")
    if re.match(r"(C|DC|AC)(3D|PS|PE)", name):
        solids, planes = ([f"{prefix}{kind.nodes}" for kind in TYPES.values() for prefix in prefixes
                           if kind.dimension == dimension and not kind.has_face_nodes]
                          for dimension, prefixes in ((3, ["C3D"]), (2, ["CPS", "CPE"])))
        fail(f"elements of type {name} are not supported; use {choices(solids)}, or in the plane {choices(planes)}")
    return None


class InpReader:
    def __init__(self, path):
        self.path = path
        self.nodes = {}  # id: coordinates
        self.elements, self.element_ids = {}, set()  # name of type: [(id, nodes)]
        self.kinds = {}
        self.nsets, self.elsets, self.surfaces, self.names = {}, {}, {}, {}
        self.internal = set()
        self.parts, self.instances = [], []
        self.aside, self.aside_elements = {}, {}
        self.at = (path, 0)

    def fail(self, message):
        raise Refusal(f"{self.at[0]}:{self.at[1]}: {message}")

    # Lines without comments and blank ones, with those of included files inserted.
    def lines(self, path, depth=0):
        if depth > 20:
            self.fail("*INCLUDE is nested more than 20 files deep")
        try:
            # The program has checked the main file. Devices and pipes may have no end.
            if depth > 0 and not stat.S_ISREG(os.stat(path).st_mode):
                self.fail(f"*INCLUDE: {path}: it is not a regular file")
            file = open(path, encoding="latin-1")
        except OSError as problem:
            if depth == 0:
                raise Refusal(problem.strerror)
            self.fail(f"*INCLUDE: {path}: {problem.strerror}")
        with file:
            number = 0
            for line in file:
                number += 1
                self.at = (path, number)
                line = line.strip()
                if not line or line.startswith("**"):
                    continue
                if line.startswith("*"):
                    while line.endswith(","):
                        line += next(file, "").strip()
                        number += 1
                    keyword, parameters = self.split(line)
                    if keyword == "INCLUDE":
                        included = parameters.get("INPUT", "")
                        yield from self.lines(os.path.join(os.path.dirname(path), included), depth + 1)
                        self.at = (path, number)
                        continue
                yield line

    @staticmethod
    def split(line):
        words = line[1:].split(",")
        parameters = {}
        for word in words[1:]:
            key, _, value = word.partition("=")
            parameters["".join(key.split()).upper()] = value.strip().strip('"')
        return " ".join(words[0].split()).upper(), parameters

    def read(self):
        keyword, parameters, handle = None, {}, None
        for line in self.lines(self.path):
            if line.startswith("*"):
                if handle:
                    handle(None)
                keyword, parameters = self.split(line)
                handle = self.begin(keyword, parameters)
            elif handle:
                handle(line)
            elif keyword is None:
                self.fail(f"data before any keyword: {line[:60]}; a keyword begins with *, as in *NODE")
        if handle:
            handle(None)
        return self.mesh()

    def begin(self, keyword, parameters):
        """Returns the function to call with each data line behind a keyword and None at their end; None to skip."""
        if keyword in GENERATORS:
            self.fail(f"*{keyword} is not supported; write the input file with all nodes and elements listed (in Abaqus/CAE: "
                      "Job > Write Input), or mesh the part in Gmsh")
        if keyword == "NODE":
            if parameters.get("SYSTEM", "R").upper() != "R":
                self.fail("*NODE with cylindrical or spherical coordinates is not supported; use Cartesian coordinates")
            return self.node_reader(parameters)
        if keyword == "ELEMENT":
            return self.element_reader(parameters)
        if keyword in ("NSET", "ELSET"):
            return self.set_reader(keyword, parameters)
        if keyword == "SURFACE":
            return self.surface_reader(parameters)
        if keyword == "PART":
            self.only_one(self.parts, parameters.get("NAME", ""), "part")
        elif keyword == "INSTANCE":
            self.only_one(self.instances, parameters.get("NAME", ""), "instance")
            return self.refuse_placement
        elif keyword not in ("HEADING", "END PART", "ASSEMBLY", "END ASSEMBLY", "END INSTANCE", "PREPRINT"):
            self.aside[keyword] = self.aside.get(keyword, 0) + 1
        return None

    def only_one(self, seen, name, what):
        seen.append(name)
        if len(seen) > 1:
            self.fail(f'a second {what}, "{name}": files with several parts or instances are not supported; merge them into '
                      "one part (in Abaqus/CAE: Assembly > Instance > Merge/Cut), or write a separate file for each")

    def refuse_placement(self, line):
        words = [] if line is None else [word for word in self.words(line) if word]
        if any(number != 0.0 for number in self.numbers(words, float, "the placement of an instance")):
            self.fail("an instance that is moved or rotated is not supported; place the body with `move` and `turn` in "
                      "[mesh] and remove this line")

    def numbers(self, words, kind, what):
        for word in words if kind is int else []:
            if len(word) > LONGEST_NUMBER:
                self.fail(f"{what} should be here; {word[:60]} has more than {LONGEST_NUMBER} digits")
        if not all(NUMBER[kind].fullmatch(word) for word in words):
            self.fail(f"{what} should be here; found {', '.join(words)[:60]}")
        return [kind(word.replace("D", "E").replace("d", "e") if kind is float else word) for word in words]

    @staticmethod
    def words(line):
        words = [word.strip() for word in line.split(",")]
        return words[:-1] if words[-1] == "" else words

    def node_reader(self, parameters):
        made = []

        def handle(line):
            if line is None:
                self.extend(self.nsets, parameters.get("NSET"), made)
                return
            words = self.words(line)
            values = self.numbers(words[1:4], float, "the coordinates of a node") + [0.0, 0.0, 0.0]
            number = self.numbers(words[:1], int, "the number of a node")[0]
            if number in self.nodes and self.nodes[number] != values[:3]:
                self.fail(f"node {number} is already defined, at another position")
            self.nodes[number] = values[:3]
            made.append(number)
        return handle

    def extend(self, sets, name, members):
        if not name:
            return
        self.names.setdefault((id(sets), name.upper()), name)
        sets.setdefault(name.upper(), []).extend(members)

    def element_reader(self, parameters):
        name = parameters.get("TYPE", "").upper()
        kind = element_kind(name, self.fail)
        if kind is None:
            def count(line):
                if line is not None:
                    self.aside_elements[name] = self.aside_elements.get(name, 0) + 1
            return count
        self.kinds[name] = kind
        size = SIZES[kind]
        rows, made, pending = self.elements.setdefault(name, []), [], []

        def handle(line):
            if line is None:
                if pending:
                    self.fail(f"an element of type {name} has {size} nodes, this one has {len(pending) - 1}")
                self.extend(self.elsets, parameters.get("ELSET"), made)
                return
            pending.extend(self.numbers(self.words(line), int, "the numbers of an element and of its nodes"))
            if len(pending) > size + 1:
                self.fail(f"an element of type {name} has {size} nodes, this one has {len(pending) - 1}")
            if len(pending) == size + 1:
                rows.append(tuple(pending))
                made.append(pending[0])
                self.element_ids.add(pending[0])
                pending.clear()
        return handle

    def named(self, sets, word, what):
        for name in (word, word.split(".", 1)[-1]):  # a set of an instance: INSTANCE.SET
            if name.strip('"').upper() in sets:
                return sets[name.strip('"').upper()]
        self.fail(f'there is no {what} "{word}" before this line')

    def members(self, sets, word, what):
        last = word.split(".")[-1]
        return self.numbers([last], int, f"a number or the name of a {what}") if last.isdecimal() else self.named(sets, word, what)

    def set_reader(self, keyword, parameters):
        sets, what = (self.nsets, "set of nodes") if keyword == "NSET" else (self.elsets, "set of elements")
        name = parameters.get(keyword)
        if not name:
            self.fail(f"*{keyword} requires a name ({keyword}=...)")
        self.extend(sets, name, [])
        if "INTERNAL" in parameters:
            self.internal.add((id(sets), name.upper()))
        if keyword == "NSET" and "ELSET" in parameters:
            wanted = set(self.named(self.elsets, parameters["ELSET"], "set of elements"))
            for rows in self.elements.values():
                for row in rows:
                    if row[0] in wanted:
                        sets[name.upper()].extend(row[1:])

        def handle(line):
            if line is None:
                return
            words = self.words(line)
            if "GENERATE" not in parameters:
                for word in words:
                    sets[name.upper()].extend(self.members(sets, word, what))
                return
            values = self.numbers(words, int, "first, last and increment of a generated set")
            if len(values) not in (2, 3) or (len(values) == 3 and values[2] <= 0):
                self.fail("a generated set requires first, last and a positive increment")
            known = self.nodes if keyword == "NSET" else self.element_ids
            numbers = range(values[0], values[1] + 1, values[2] if len(values) == 3 else 1)
            # Iterate over the shorter of the two: a generated set may name far more numbers than exist.
            if len(numbers) <= len(known):
                sets[name.upper()].extend(number for number in numbers if number in known)
            else:
                sets[name.upper()].extend(sorted(number for number in known if number in numbers))
        return handle

    def surface_reader(self, parameters):
        name = parameters.get("NAME", "")
        kind = parameters.get("TYPE", "ELEMENT").upper()
        if kind in ("SEGMENTS", "CYLINDER", "REVOLUTION"):  # an analytical rigid surface, not part of a body
            self.aside[f"SURFACE of type {kind}, which an [obstacle.NAME] of the case can replace"] = 1
            return None
        if "COMBINE" in parameters or kind not in ("ELEMENT", "NODE"):
            self.fail(f'surface "{name}": only surfaces of element faces and of nodes are supported, not combined surfaces or '
                      f"surfaces of type {kind}")
        sides = self.surfaces.setdefault(name, [])

        def handle(line):
            if line is None:
                return
            words = self.words(line)
            if kind == "NODE":
                self.extend(self.nsets, name, self.members(self.nsets, words[0], "set of nodes"))
                self.surfaces.pop(name, None)
                return
            label = words[1].upper() if len(words) > 1 and words[1] else ""
            if not re.fullmatch(r"S[1-6]|SPOS|SNEG|", label):
                self.fail(f'"{words[1]}" is not a face of an element; use S1 to S6, SPOS or SNEG')
            sides.append((self.members(self.elsets, words[0], "set of elements"), label, self.at))
        return handle

    # Conversion of numbers to indices.
    def mesh(self):
        mesh = FileMesh()
        ids = numpy.array(sorted(self.nodes), dtype=numpy.int64)
        mesh.node_ids, mesh.points = ids, numpy.array([self.nodes[i] for i in ids.tolist()], dtype=float).reshape(-1, 3)
        if len(ids) == 0:
            raise Refusal("there is no *NODE in this file")
        self.place = {}
        for name, rows in self.elements.items():
            table = numpy.array(rows, dtype=numpy.int64).reshape(len(rows), -1)
            if len(rows) == 0:
                continue
            for i, number in enumerate(table[:, 0].tolist()):
                if number in self.place:
                    raise Refusal(f"element {number} is defined twice")
                self.place[number] = (len(mesh.blocks), i)
            nodes = numpy.searchsorted(ids, table[:, 1:]).clip(max=len(ids) - 1)
            wrong = numpy.nonzero((ids[nodes] != table[:, 1:]).any(axis=1))[0]
            if len(wrong):
                row = table[wrong[0]]
                missing = row[1:][~numpy.isin(row[1:], ids)][0]
                raise Refusal(f"element {row[0]} refers to node {missing}, which does not exist")
            mesh.blocks.append(Block(self.kinds[name], nodes, table[:, 0], name))
        self.add_groups(mesh, ids)
        self.add_notes(mesh)
        return mesh

    def places(self, numbers, what):
        parts = {}
        for number in dict.fromkeys(numbers):
            if number not in self.place:
                raise Refusal(f"{what} names element {number}, which does not exist")
            block, i = self.place[number]
            parts.setdefault(block, []).append(i)
        return {block: numpy.array(indices) for block, indices in parts.items()}

    def spelling(self, sets, name):
        return self.names[id(sets), name]

    def add_groups(self, mesh, ids):
        for name, sides in self.surfaces.items():
            parts = []
            for numbers, label, at in sides:
                self.at = at
                for block, indices in self.places(numbers, f'surface "{name}"').items():
                    kind = TYPES.get(mesh.blocks[block].kind)
                    if kind is None:
                        continue  # refused by name later
                    if label in ("SPOS", "SNEG"):
                        mesh.cell_groups.append((name, {block: indices}))
                        continue
                    side = int(label[1]) - 1 if label else None
                    if side is not None and side >= len(kind.facets):
                        self.fail(f"{label} is not a face of an element of type {mesh.blocks[block].name}")
                    parts.append((block, indices, side))
            mesh.side_groups.append((name, parts))
        for name, numbers in self.elsets.items():
            if (id(self.elsets), name) not in self.internal:
                spelling = self.spelling(self.elsets, name)
                mesh.cell_groups.append((spelling, self.places(numbers, f'the set of elements "{spelling}"')))
        for name, numbers in self.nsets.items():
            if (id(self.nsets), name) in self.internal:
                continue
            wanted = numpy.unique(numpy.array(numbers, dtype=numpy.int64))
            found = numpy.searchsorted(ids, wanted).clip(max=len(ids) - 1)
            spelling = self.spelling(self.nsets, name)
            if (ids[found] != wanted).any():
                missing = wanted[ids[found] != wanted][0]
                raise Refusal(f'the set of nodes "{spelling}" names node {missing}, which does not exist')
            mesh.node_groups.append((spelling, found))

    def add_notes(self, mesh):
        if self.aside:
            mesh.notes.append("note: only the mesh is read; ignored: "
                              + ", ".join(f"*{keyword}" for keyword in sorted(self.aside)))
        if self.aside_elements:
            mesh.notes.append("warning: elements that are not part of a body's mesh are ignored: "
                              + ", ".join(f"{count} of type {name or '(none)'}"
                                          for name, count in sorted(self.aside_elements.items())))
