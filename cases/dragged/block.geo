// A block of 0.3 m x 0.1 m in squares of 25 mm: gmsh -2 -format msh41 block.geo
Point(1) = {-0.15, 0.0, 0.0};
Point(2) = {0.15, 0.0, 0.0};
Point(3) = {0.15, 0.1, 0.0};
Point(4) = {-0.15, 0.1, 0.0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 13;
Transfinite Curve {2, 4} = 5;
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("block") = {1};
Physical Curve("base") = {1};
