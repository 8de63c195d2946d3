"""A body of plane P1 triangles, assembled independently of Ricochet and its peers."""

import pathlib
import tomllib

import meshio
import numpy as np
import scipy.sparse


class Body:
    """M, K and the boundary of a case with one material in plane strain, from its Gmsh file. Dof 2 i + k: component k of node i."""

    def __init__(self, case, mass):
        path = pathlib.Path(case)
        self.case = tomllib.loads(path.read_text())
        self.mesh_file = path.parent / self.case["mesh"]["file"]
        mesh = meshio.read(self.mesh_file)
        self.points = mesh.points[:, :2]
        self.triangles = np.vstack([block.data for block in mesh.cells if block.type == "triangle"])
        self.groups = {}
        for name, (tag, dimension) in mesh.field_data.items():
            if dimension == 1:
                edges = [block.data[tags == tag] for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"])
                         if block.type == "line"]
                self.groups[name] = np.vstack(edges)
        self.dofs = 2 * len(self.points)
        self._assemble(self.case["material"][0])
        if mass == "lumped":
            self.mass = scipy.sparse.diags(np.asarray(self.mass.sum(axis=1)).ravel()).tocsr()

    def _assemble(self, material):
        if "young" in material:
            young, poisson = material["young"], material["poisson"]
            mu = young / (2 * (1 + poisson))
            lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
        else:
            lame, mu = material["lambda"], material["mu"]
        law = np.array([[lame + 2 * mu, lame, 0.0], [lame, lame + 2 * mu, 0.0], [0.0, 0.0, mu]])
        x = self.points[self.triangles]
        edges = np.stack([x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]], axis=2)
        area = 0.5 * np.abs(np.linalg.det(edges))
        inverse = np.linalg.inv(edges)  # rows: gradients of the hat functions of vertices 1 and 2
        gradients = np.stack([-inverse.sum(axis=1), inverse[:, 0], inverse[:, 1]], axis=1)
        strain = np.zeros((len(area), 3, 6))
        strain[:, 0, 0::2] = strain[:, 2, 1::2] = gradients[:, :, 0]
        strain[:, 1, 1::2] = strain[:, 2, 0::2] = gradients[:, :, 1]
        stiffness = np.einsum("e,eki,kl,elj->eij", area, strain, law, strain)
        scalar = (np.ones((3, 3)) + np.eye(3)) / 12
        mass = material["density"] * area[:, None, None] * np.kron(scalar, np.eye(2))
        numbers = (2 * self.triangles[:, :, None] + np.arange(2)).reshape(len(area), 6)
        rows, columns = np.repeat(numbers, 6, axis=1).ravel(), np.tile(numbers, 6).ravel()

        def matrix(cells):
            return scipy.sparse.coo_matrix((cells.ravel(), (rows, columns)), shape=(self.dofs, self.dofs)).tocsr()

        self.stiffness, self.mass = matrix(stiffness), matrix(mass)

    def field(self, vector):
        """Returns the same vector at each node, as dofs."""
        return np.tile(np.asarray(vector, dtype=float), len(self.points))

    def nodes(self, group):
        return np.unique(self.groups[group])

    def lengths(self, group):
        """Returns, for each node of the group, the integral of its hat function over the group."""
        edges = self.groups[group]
        length = np.linalg.norm(self.points[edges[:, 1]] - self.points[edges[:, 0]], axis=1)
        result = np.zeros(len(self.points))
        np.add.at(result, edges.ravel(), np.repeat(0.5 * length, 2))
        return result[self.nodes(group)]

    def free_dofs(self):
        supported = [2 * self.nodes(support["group"]) + "xy".index(component)
                     for support in self.case.get("support", []) for component in support["components"]]
        return np.setdiff1d(np.arange(self.dofs), np.concatenate(supported) if supported else [])

    def lowest_node(self, group):
        nodes = self.nodes(group)
        return nodes[np.argmin(self.points[nodes, 1])]
