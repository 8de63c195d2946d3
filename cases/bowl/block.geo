// A block of 8 mm by 4 mm whose lower corners are on a circle of radius 1 about (0, 1).
SetFactory("OpenCASCADE");
b = 0.004;
Rectangle(1) = {-b, 1 - Sqrt(1 - b*b), 0, 2*b, b};
Physical Surface("block") = {1};
Physical Curve("base") = {1};
Mesh.MeshSizeMin = 0.002;
Mesh.MeshSizeMax = 0.002;
