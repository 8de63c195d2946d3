// A ball of radius 5 cm whose lowest point is 5 mm above the plane z = 0; tetrahedra, fine where it will touch.
// gmsh ball.geo -3 -format msh41 -o ball.msh        (1262 nodes)
SetFactory("OpenCASCADE");
radius = 0.05;
gap = 0.005;
cap = 15 * Pi / 180; // the contact boundary: what lies within this angle of the lowest point
DefineConstant[ fine = 0.0018 ];
DefineConstant[ coarse = 0.013 ];

// Two parts of one sphere that share a plane disc, so that its surface is divided into "lower" and "upper".
Sphere(1) = {0, 0, radius + gap, radius, -Pi / 2, -Pi / 2 + cap};
Sphere(2) = {0, 0, radius + gap, radius, -Pi / 2 + cap, Pi / 2};
Coherence;
centre = newp; Point(centre) = {0, 0, radius + gap};
Point{centre} In Volume{2}; // a node there, for a probe

Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Field[1] = Distance;
Field[1].PointsList = {2};
Field[2] = Threshold;
Field[2].InField = 1;
Field[2].SizeMin = fine;
Field[2].SizeMax = coarse;
Field[2].DistMin = 0.009;
Field[2].DistMax = 0.05;
Background Field = 2;

Physical Volume("ball") = {1, 2};
Physical Surface("lower") = {1};
Physical Surface("upper") = {3};
