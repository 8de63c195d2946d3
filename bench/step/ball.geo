// A ball of radius 1 whose lowest point is 0.1 above z = 0; "lower": the half of its surface that may touch.
// gmsh ball.geo -3 -setnumber size 0.1 -o ball.msh
SetFactory("OpenCASCADE");
DefineConstant[ size = 0.2 ];
radius = 1;
gap = 0.1;
Mesh.MeshSizeMin = size;
Mesh.MeshSizeMax = size;
Sphere(1) = {0, 0, radius + gap, radius, -Pi / 2, 0};
Sphere(2) = {0, 0, radius + gap, radius, 0, Pi / 2};
Coherence;
Physical Volume("body") = {1, 2};
Physical Surface("lower") = {1};
