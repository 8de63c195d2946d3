// A disc of radius 0.1 m whose centre is at the origin. The whole rim is its contact boundary.
// gmsh disc.geo -2 -format msh41 -o disc.msh
SetFactory("OpenCASCADE");
radius = 0.1;
Disk(1) = {0, 0, 0, radius};
DefineConstant[ size = 0.006 ];
Mesh.MeshSizeMax = size;
Mesh.MeshSizeMin = size;
Physical Surface("disc") = {1};
Physical Curve("rim") = {1};
