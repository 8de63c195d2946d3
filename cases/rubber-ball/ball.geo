// Half of a ball of radius 25 mm, cut at y = 0, whose lowest point is 0.1 mm above the plane z = 0.
// gmsh ball.geo -3 -format msh41 -o ball.msh
SetFactory("OpenCASCADE");
radius = 0.025;
gap = 0.0001;
Sphere(1) = {0, 0, radius + gap, radius};
Box(2) = {-0.05, 0, -0.05, 0.1, 0.05, 0.15};
BooleanIntersection(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
lowest = newp; Point(lowest) = {0, 0, gap};

DefineConstant[ fine = 0.006 ];
DefineConstant[ coarse = 0.012 ];
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Field[1] = Distance;
Field[1].PointsList = {lowest};
Field[2] = Threshold;
Field[2].InField = 1;
Field[2].SizeMin = fine;
Field[2].SizeMax = coarse;
Field[2].DistMin = 0.016;
Field[2].DistMax = 0.035;
Background Field = 2;

Physical Volume("ball") = {3};
skin() = Surface In BoundingBox {-1, -1e-6, -1, 1, 1, 1};
cut() = Surface In BoundingBox {-1, -1e-6, -1, 1, 1e-6, 1};
skin() -= cut();
Physical Surface("skin") = {skin()};
Physical Surface("cut") = {cut()};
