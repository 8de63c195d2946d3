// A bar, 0.2 m long and 2 cm square, 2 mm above the plane z = 0: twenty bricks, as published.
// gmsh sdnv100.geo -3 -format msh41 -o sdnv100.msh        (84 nodes)
DefineConstant[ cells = 20 ];
length = 0.2;
side = 0.02;
gap = 0.002;
Point(1) = {0, 0, gap};
Point(2) = {side, 0, gap};
Point(3) = {side, side, gap};
Point(4) = {0, side, gap};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 2, 3, 4} = 2;
Transfinite Surface {1};
Recombine Surface {1};
out() = Extrude {0, 0, length} { Surface{1}; Layers{cells}; Recombine; };
Physical Volume("bar") = {out(1)};
Physical Surface("struck") = {1};
Physical Surface("free") = {out(0)};
Physical Surface("sides") = {out(2), out(3), out(4), out(5)};
