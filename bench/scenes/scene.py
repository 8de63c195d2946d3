"""A scene: meshes and the sections of a case, as quantities that can be transformed to another observer, and its
files."""

import dataclasses
import math

import meshes
from quantities import Course, LENGTH, NONE, Quantity, TIME, mechanical, plain


@dataclasses.dataclass(frozen=True)
class Surface:
    """A polygon, or triangles, in a file beside the case."""
    vertices: tuple
    facets: tuple

    def seen(self, frame):
        facets = tuple(f[::-1] for f in self.facets) if frame.handedness() < 0 else self.facets
        return Surface(tuple(frame.apply(v, "point", LENGTH) for v in self.vertices), facets)

    def file_text(self):
        line = lambda k: " ".join(f"{x:.17g}" for x in self.vertices[k])
        if len(self.vertices[0]) == 2:
            return "\n\n".join("\n".join(line(k) for k in chain) for chain in self.facets) + "\n"
        loops = ["facet normal 0 0 0\nouter loop\n" + "\n".join(f"vertex {line(k)}" for k in f) + "\nendloop\nendfacet"
                 for f in self.facets]
        return "\n".join(["solid surface", *loops, "endsolid", ""])


@dataclasses.dataclass(frozen=True)
class Table:
    """Motion given by rows of a file: time, displacement and rotation."""
    times: tuple
    displacements: tuple
    rotations: tuple

    def seen(self, frame):
        return Table(tuple(t * frame.time for t in self.times),
                     tuple(frame.apply(u, "vector", LENGTH) for u in self.displacements),
                     tuple(frame.apply(r, "axial", NONE) for r in self.rotations))

    def file_text(self):
        flat = lambda value: value if isinstance(value, tuple) else (value,)
        return "".join(" ".join(f"{x:.17g}" for x in (t, *u, *flat(r))) + "\n"
                       for t, u, r in zip(self.times, self.displacements, self.rotations))


@dataclasses.dataclass
class Section:
    """[NAME] or [[NAME]] with its keys; a [[support]] may have a vector of courses, which makes a section per
    component."""
    name: str
    keys: dict
    many: bool = False

    def seen(self, frame):
        change = lambda value: value.seen(frame) if hasattr(value, "seen") else value
        return Section(self.name, {key: change(value) for key, value in self.keys.items()}, self.many)

    def text(self, files, stem):
        if self.name == "support" and isinstance(self.keys.get("value"), Course):
            course = self.keys["value"]
            return "".join(f'[[support]]\ngroup = {plain(self.keys["group"])}\ncomponents = ["{axis}"]\n'
                           f"value = {plain(course.component(k))}\n"
                           for k, axis in enumerate("xyz"[:len(course.terms[0][0].values)]))
        lines = [f"[[{self.name}]]" if self.many else f"[{self.name}]"]
        for key, value in self.keys.items():
            if hasattr(value, "file_text"):
                ending = "stl" if isinstance(value, Surface) and len(value.vertices[0]) == 3 else "txt"
                file = f"{stem}-{self.name.replace('.', '-')}-{key}.{ending}"
                files[file] = value.file_text()
                text = plain(file)
            else:
                text = value.text() if hasattr(value, "text") else plain(value)
            if "." in key:  # an inline table with one entry
                key, entry = key.split(".")
                text = f"{{ {entry} = {text} }}"
            lines.append(f"{key} = {text}")
        return "\n".join(lines) + "\n"


@dataclasses.dataclass
class Scene:
    seed: int
    family: str
    meshes: list
    sections: list
    plane: str = "strain"
    degree: int = 1
    as_parts: bool = False
    facts: dict = dataclasses.field(default_factory=dict)  # of the draw, for the properties

    @property
    def dimension(self):
        return self.meshes[0].dimension

    @property
    def dims(self):
        return mechanical(self.dimension == 2 and self.plane != "axisymmetric")

    def replace(self, **changes):
        return dataclasses.replace(self, **changes)

    def seen(self, frame):
        return self.replace(meshes=[m.seen(frame) for m in self.meshes], sections=[s.seen(frame) for s in self.sections])

    def section(self, name):
        return next((s for s in self.sections if s.name == name), None)

    def obstacles(self):
        return [s for s in self.sections if s.name.startswith("obstacle.")]

    def with_section(self, old, new):
        return self.replace(sections=[new if s is old else s for s in self.sections])

    def size(self):
        """Returns the largest extent of the meshes along an axis."""
        points = [p for m in self.meshes for p in m.points]
        return max(max(p[k] for p in points) - min(p[k] for p in points) for k in range(self.dimension))

    def mass(self):
        """Returns the approximate mass of the bodies: the density times their bounding box."""
        points = [p for m in self.meshes for p in m.points]
        box = math.prod(max(p[k] for p in points) - min(p[k] for p in points) for k in range(self.dimension))
        return box * max(s.keys["density"].values for s in self.sections if s.name == "material")

    def write(self, folder, stem):
        """Writes all files of the case. Returns its path."""
        files = {}
        more = (f"degree = {self.degree}\n" if self.degree != 1 else "") + (f'plane = "{self.plane}"\n' if self.dimension == 2 else "")
        if self.as_parts:
            head = f"[mesh]\n{more}"
            for mesh in self.meshes:
                files[f"{stem}-{mesh.name}.msh"] = mesh.text()
                head += f'[part.{mesh.name}]\nfile = "{stem}-{mesh.name}.msh"\n'
        else:
            write = meshes.text_22 if self.meshes[0].version == "2.2" else meshes.text_41
            files[f"{stem}.msh"] = write(self.meshes)
            head = f'[mesh]\nfile = "{stem}.msh"\n{more}'
        text = f'title = "scene {self.seed}, {self.family}"\n' + head + "".join(s.text(files, stem) for s in self.sections)
        files[f"{stem}.toml"] = text
        for name, content in files.items():
            (folder / name).write_text(content, encoding="utf-8")
        return folder / f"{stem}.toml"


def time_section(step, steps, **more):
    return Section("time", {"step": Quantity(step, "scalar", TIME), "end": Quantity(step * steps, "scalar", TIME),
                            **more})
