// A quadrilateral of no symmetry, in triangles.
lc = 0.7;
Point(1) = {0.1, 0.2, 0, lc}; Point(2) = {1.3, 0.1, 0, lc}; Point(3) = {1.5, 1.2, 0, lc}; Point(4) = {-0.1, 0.9, 0, lc};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Physical Surface("body") = {1};
Physical Curve("bottom") = {1};
Physical Curve("sides") = {2, -4};
Physical Curve(7) = {3};
Physical Point("corner") = {2};
