"""Surfaces for random obstacles: polygons in the plane, triangles in space."""

import itertools
import math


def write_stl(path, vertices, triangles):
    lines = ["solid obstacle"]
    for triangle in triangles:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += ["vertex {:.17g} {:.17g} {:.17g}".format(*vertices[corner]) for corner in triangle]
        lines += ["endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid", ""]))


def write_polygon(random, path, middle):
    """Writes a closed polygon with corners at random distances; its top is some 0.35 below zero."""
    corners, radius, phase = random.choice([3, 4, 5, 8]), random.uniform(0.4, 1.2), random.uniform(0, 2 * math.pi)
    points = []
    for k in range(corners):
        angle = phase + 2 * math.pi * k / corners
        points.append((middle + radius * (1 - 0.3 * random.random()) * math.cos(angle),
                       -radius - 0.35 + radius * (1 - 0.3 * random.random()) * math.sin(angle)))
    path.write_text("".join("{:.17g} {:.17g}\n".format(*point) for point in [*points, points[0]]))


def write_rough_ground(random, path, cells=10):
    """Writes an open surface of triangles at random heights below -0.6."""
    roughness = random.uniform(0.02, 0.3)
    vertices = [(-3 + 7 * i / cells, -3 + 7 * j / cells, -0.6 - roughness * random.random())
                for j in range(cells + 1) for i in range(cells + 1)]
    triangles = []
    for j in range(cells):
        for i in range(cells):
            a = j * (cells + 1) + i
            triangles += [(a, a + 1, a + cells + 2), (a, a + cells + 2, a + cells + 1)]
    write_stl(path, vertices, triangles)


def icosahedron():
    golden = (1 + math.sqrt(5)) / 2
    vertices = [(0, s, t * golden) for s in (-1, 1) for t in (-1, 1)]
    vertices = [tuple(v[(k - shift) % 3] for k in range(3)) for shift in range(3) for v in vertices]
    vertices = [tuple(c / math.sqrt(1 + golden**2) for c in v) for v in vertices]
    triangles = []
    for triangle in itertools.combinations(range(12), 3):
        if max(math.dist(vertices[a], vertices[b]) for a, b in itertools.combinations(triangle, 2)) < 1.1:
            triangles.append(outwards(vertices, triangle))
    return vertices, triangles


def outwards(vertices, triangle):
    a, b, c = (vertices[corner] for corner in triangle)
    u, w = [[q[k] - a[k] for k in range(3)] for q in (b, c)]
    normal = (u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0])
    return triangle if sum(n * x for n, x in zip(normal, a)) > 0 else (triangle[0], triangle[2], triangle[1])


def refine(vertices, triangles):
    vertices, middles, result = list(vertices), {}, []

    def middle(a, b):
        key = (min(a, b), max(a, b))
        if key not in middles:
            point = [(vertices[a][k] + vertices[b][k]) / 2 for k in range(3)]
            length = math.hypot(*point)
            vertices.append(tuple(c / length for c in point))
            middles[key] = len(vertices) - 1
        return middles[key]

    for a, b, c in triangles:
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        result += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return vertices, result


def write_rock(random, path):
    """Writes a closed surface around a point: an icosahedron, or 80 triangles, with corners at random distances."""
    vertices, triangles = icosahedron()
    if random.random() < 0.5:
        vertices, triangles = refine(vertices, triangles)
    radius, rough = random.uniform(0.4, 1.2), random.uniform(0, 0.25)
    centre = (random.uniform(-0.2, 1.2), random.uniform(-0.2, 1.0), -1.05 * radius - 0.25)
    write_stl(path, [tuple(centre[k] + radius * scale * v[k] for k in range(3))
                     for v in vertices for scale in [1 - rough * random.random()]], triangles)
