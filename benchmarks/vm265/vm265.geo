// A rod as a strip, 10 in long and 1 in wide (1 in thick), 0.01 in from the wall x = 0: twenty cells, as published.
// gmsh vm265.geo -2 -format msh41 -o vm265.msh        (42 nodes)
DefineConstant[ cells = 20 ];
length = 10;
width = 1;
gap = 0.01;
Point(1) = {gap, 0, 0};
Point(2) = {gap + length, 0, 0};
Point(3) = {gap + length, width, 0};
Point(4) = {gap, width, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 3} = cells + 1;
Transfinite Curve {2, 4} = 2;
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("rod") = {1};
Physical Curve("struck") = {4};
Physical Curve("free") = {2};
Physical Curve("sides") = {1, 3};
