// A puck of radius 2 cm whose lowest point is 0.2 mm above the line y = 0; triangles, fine where it will touch.
// gmsh puck.geo -2 -format msh41 -o puck.msh
SetFactory("OpenCASCADE");
radius = 0.02;
gap = 0.0002;
DefineConstant[ fine = 0.00025 ];
DefineConstant[ coarse = 0.0015 ];
middle = radius + gap; // height of the centre
centre = newp; Point(centre) = {0, middle, 0};
lowest = newp; Point(lowest) = {0, gap, 0};
right = newp;  Point(right) = {radius, middle, 0};
top = newp;    Point(top) = {0, middle + radius, 0};
left = newp;   Point(left) = {-radius, middle, 0};
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
Field[1].PointsList = {lowest};
Field[2] = Threshold;
Field[2].InField = 1;
Field[2].SizeMin = fine;
Field[2].SizeMax = coarse;
Field[2].DistMin = 0.002;
Field[2].DistMax = 0.012;
Background Field = 2;

Physical Surface("puck") = {1};
Physical Curve("skin") = {1, 2, 3, 4};
