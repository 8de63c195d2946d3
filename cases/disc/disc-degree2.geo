// The disc of disc.geo for a displacement of degree 2: curved six-node triangles, twice as wide.
// gmsh disc-degree2.geo -2 -format msh41 -o disc-degree2.msh        (457 nodes)
SetFactory("OpenCASCADE");
radius = 0.02;
gap = 0.001;
size = 0.0040;
Mesh.MeshSizeMin = size;
Mesh.MeshSizeMax = size;
Mesh.ElementOrder = 2;
centre = newp; Point(centre) = {0, radius + gap, 0};
lowest = newp; Point(lowest) = {0, gap, 0};
right = newp;  Point(right) = {radius, radius + gap, 0};
top = newp;    Point(top) = {0, 2 * radius + gap, 0};
left = newp;   Point(left) = {-radius, radius + gap, 0};
Circle(1) = {left, centre, lowest};
Circle(2) = {lowest, centre, right};
Circle(3) = {right, centre, top};
Circle(4) = {top, centre, left};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Surface("body") = {1};
Physical Curve("lower") = {1, 2};
Physical Curve("upper") = {3, 4};
