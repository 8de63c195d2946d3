// The lower half of a disc or of a ball of radius 1 that touches y = 0, in space z = 0, at the origin. "lower": what may touch; "top".
// gmsh half.geo -2 -setnumber dimension 2 -setnumber size 0.05 -o half.msh
SetFactory("OpenCASCADE");
DefineConstant[ dimension = 2, size = 0.1 ];
Mesh.MeshSizeMin = size;
Mesh.MeshSizeMax = size;
If (dimension == 2)
  Point(1) = {0, 1, 0};
  Point(2) = {-1, 1, 0};
  Point(3) = {0, 0, 0};
  Point(4) = {1, 1, 0};
  Circle(1) = {2, 1, 3};
  Circle(2) = {3, 1, 4};
  Line(3) = {4, 2};
  Curve Loop(1) = {1, 2, 3};
  Plane Surface(1) = {1};
  Physical Surface("body") = {1};
  Physical Curve("lower") = {1, 2};
  Physical Curve("top") = {3};
Else
  Sphere(1) = {0, 0, 1, 1, -Pi / 2, 0};
  Physical Volume("body") = {1};
  Physical Surface("lower") = {1};
  Physical Surface("top") = {2};
EndIf
