// A rod from x = 0 to x = 1, 0.05 high, of square cells along it.
// gmsh rod.geo -2 -format msh41 -o rod.msh        (123 nodes)
DefineConstant[ along = 40 ];  // cells
DefineConstant[ across = 2 ];
length = 1;
height = 0.05;
Point(1) = {0, 0, 0};
Point(2) = {length, 0, 0};
Point(3) = {length, height, 0};
Point(4) = {0, height, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 3} = along + 1;
Transfinite Curve {2, 4} = across + 1;
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("rod") = {1};
Physical Curve("left") = {4};
Physical Curve("right") = {2};
Physical Curve("sides") = {1, 3};
