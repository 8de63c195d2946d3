// The disc of ../disc, radius 2 cm, with cells of 0.4 mm where it will touch the line y = 0, which is 0.5 mm below it.
// gmsh disc.geo -2 -format msh41 -o disc.msh        (522 nodes)
SetFactory("OpenCASCADE");
radius = 0.02;
gap = 0.0005;
reach = 20 * Pi / 180; // the contact boundary: what lies within this angle of the lowest point
DefineConstant[ fine = 0.0004 ];
DefineConstant[ coarse = 0.003 ];
middle = radius + gap; // height of the centre
centre = newp; Point(centre) = {0, middle, 0};
left = newp;   Point(left) = {-radius * Sin(reach), middle - radius * Cos(reach), 0};
lowest = newp; Point(lowest) = {0, gap, 0};
right = newp;  Point(right) = {radius * Sin(reach), middle - radius * Cos(reach), 0};
top = newp;    Point(top) = {0, middle + radius, 0};
Circle(1) = {left, centre, lowest};
Circle(2) = {lowest, centre, right};
Circle(3) = {right, centre, top};
Circle(4) = {top, centre, left};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Point{centre} In Surface{1}; // a node there, for a probe

Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Field[1] = Distance;
Field[1].CurvesList = {1, 2};
Field[2] = Threshold;
Field[2].InField = 1;
Field[2].SizeMin = fine;
Field[2].SizeMax = coarse;
Field[2].DistMin = 0.001;
Field[2].DistMax = 0.012;
Background Field = 2;

Physical Surface("body") = {1};
Physical Curve("lower") = {1, 2};
Physical Curve("upper") = {3, 4};
