// The left half of a plate, 40 mm square, on the plane y = 0; the plane of symmetry is its right side.
// gmsh greco-plate.geo -2 -format msh41 -o greco-plate.msh        (363 nodes: 32 x 10 cells, as published)
DefineConstant[ across = 32, up = 10 ];
side = 0.04;
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
Transfinite Curve {1, 3} = across + 1;
Transfinite Curve {2, 4} = up + 1;
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("plate") = {1};
Physical Curve("base") = {1};
Physical Curve("symmetry") = {2};
Physical Curve("top") = {3};
Physical Curve("left") = {4};
