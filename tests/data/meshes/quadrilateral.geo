// A parallelogram in quadrilaterals.
Point(1) = {0.1, 0.2, 0}; Point(2) = {1.3, 0.1, 0}; Point(3) = {1.5, 1.2, 0}; Point(4) = {0.3, 1.3, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 4; Transfinite Curve {2, 4} = 3; Transfinite Surface {1}; Recombine Surface {1};
Physical Surface("body") = {1};
Physical Curve("bottom") = {1};
Physical Curve("sides") = {2, -4};
