// A block of width 2 and height 1 that rests on y = 0, in space a cube of edge 1 on z = 0. "lower": what may touch; "top".
// gmsh block.geo -2 -setnumber dimension 2 -setnumber size 0.05 -o block.msh
SetFactory("OpenCASCADE");
DefineConstant[ dimension = 2, size = 0.1 ];
Mesh.MeshSizeMin = size;
Mesh.MeshSizeMax = size;
If (dimension == 2)
  Rectangle(1) = {-1, 0, 0, 2, 1};
  Physical Surface("body") = {1};
  Physical Curve("lower") = {1};
  Physical Curve("top") = {3};
Else
  Box(1) = {-0.5, -0.5, 0, 1, 1, 1};
  Physical Volume("body") = {1};
  Physical Surface("lower") = {5};
  Physical Surface("top") = {6};
EndIf
