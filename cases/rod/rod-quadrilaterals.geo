// The rod of rod.geo with square cells.
// gmsh rod-quadrilaterals.geo -2 -format msh41 -o rod-quadrilaterals.msh        (306 nodes)
length = 1;
height = 0.1;
DefineConstant[ cells_along = 50 ];
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
Transfinite Curve {1, 3} = cells_along + 1;
Transfinite Curve {2, 4} = cells_along / 10 + 1;
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("rod") = {1};
Physical Curve("contact-end") = {4};
Physical Curve("clamped-end") = {2};
Physical Curve("sides") = {1, 3};
