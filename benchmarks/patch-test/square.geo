// A block, 1 wide and 1 high, of irregular quadrilaterals.
// gmsh square.geo -2 -format msh41 -setnumber cells 5 -o lower.msh
// gmsh square.geo -2 -format msh41 -setnumber cells 7 -o upper.msh
DefineConstant[ cells = 5 ];
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
Transfinite Curve {1, 3} = cells + 1;
Transfinite Curve {2, 4} = 6 Using Progression 1.2;
Mesh.Algorithm = 6;
Recombine Surface {1};
Physical Surface("block") = {1};
Physical Curve("bottom") = {1};
Physical Curve("top") = {3};
Physical Curve("left") = {4};
