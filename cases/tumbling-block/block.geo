// A square block with sides of 0.1 m whose lower left corner is the origin; squares of 1 cm.
// gmsh block.geo -2 -format msh41 -o block.msh        (121 nodes)
side = 0.1;
DefineConstant[ cells = 10 ];
Point(1) = {0, 0, 0};
Point(2) = {side, 0, 0};
Point(3) = {side, side, 0};
Point(4) = {0, side, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 2, 3, 4} = cells + 1;
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("block") = {1};
Physical Curve("skin") = {1, 2, 3, 4};
