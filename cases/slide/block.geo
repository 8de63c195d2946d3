// A block, 0.4 wide and 0.15 high. gmsh -2 block.geo
SetFactory("OpenCASCADE");
Rectangle(1) = {-0.2, 0, 0, 0.4, 0.15};
Mesh.MeshSizeMax = 0.08;
Physical Surface("block") = {1};
Physical Curve("base") = {1};
