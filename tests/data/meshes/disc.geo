// A disc of radius 1: on a second-order mesh the middle nodes of the boundary lie on the circle.
lc = 0.8;
Point(1) = {0, 0, 0, lc}; Point(2) = {1, 0, 0, lc}; Point(3) = {-1, 0, 0, lc};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 2};
Curve Loop(1) = {1, 2}; Plane Surface(1) = {1};
Physical Surface("body") = {1};
Physical Curve("boundary") = {1, 2};
