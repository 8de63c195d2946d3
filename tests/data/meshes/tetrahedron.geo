// A prism of no symmetry with triangular base, in tetrahedra.
lc = 0.9;
Point(1) = {0.1, 0.2, 0.05, lc}; Point(2) = {1.3, 0.1, 0.0, lc}; Point(3) = {0.2, 1.2, 0.1, lc};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
out[] = Extrude {0.1, 0.2, 1.1} { Surface{1}; };
Physical Volume("body") = {out[1]};
Physical Surface("bottom") = {1};
Physical Surface("top") = {-out[0]};
Physical Curve("edge") = {1};
