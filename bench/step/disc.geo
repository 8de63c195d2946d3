// A disc of radius 1 whose lowest point is 0.1 above y = 0; "lower": the half of its boundary that may touch.
// gmsh disc.geo -2 -setnumber size 0.02 -o disc.msh
SetFactory("OpenCASCADE");
DefineConstant[ size = 0.1 ];
radius = 1;
gap = 0.1;
Mesh.MeshSizeMin = size;
Mesh.MeshSizeMax = size;
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
