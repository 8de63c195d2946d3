// A quarter of the section of a spherical shell with the radii 20 and 30 mm: x is the distance from the axis, y goes along it.
// gmsh shell.geo -2 -order 2 -format msh41 -o shell.msh        (3 x 10 cells)
inner = 0.02;
outer = 0.03;
DefineConstant[ across = 3 ];
DefineConstant[ along = 10 ];
Point(1) = {0, 0, 0};
Point(2) = {inner, 0, 0};
Point(3) = {outer, 0, 0};
Point(4) = {0, outer, 0};
Point(5) = {0, inner, 0};
Line(1) = {2, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 5};
Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 3} = across + 1;
Transfinite Curve {2, 4} = along + 1;
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("rubber") = {1};
Physical Curve("equator") = {1};
Physical Curve("inside") = {4};
