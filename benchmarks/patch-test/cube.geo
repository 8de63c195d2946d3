// A block, 1 wide, 1 deep and 1 high: of tetrahedra, or of hexahedra.
// gmsh cube.geo -3 -format msh41 -setnumber cells 4 -o tetrahedra.msh
// gmsh cube.geo -3 -format msh41 -setnumber cells 3 -setnumber bricks 1 -o bricks.msh
DefineConstant[ cells = 4 ];
DefineConstant[ bricks = 0 ];
Point(1) = {0, 0, 0};
Point(2) = {1, 0, 0};
Point(3) = {1, 1, 0};
Point(4) = {0, 1, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Mesh.MeshSizeMin = 1 / cells;
Mesh.MeshSizeMax = 1 / cells;
If (bricks)
Mesh.Algorithm = 6;
  Recombine Surface {1};
  out() = Extrude {0, 0, 1} { Surface{1}; Layers{cells}; Recombine; };
Else
  out() = Extrude {0, 0, 1} { Surface{1}; };
EndIf
Physical Volume("block") = {out(1)};
Physical Surface("bottom") = {1};
Physical Surface("top") = {out(0)};
Physical Surface("left") = {out(5)};
Physical Surface("front") = {out(2)};
