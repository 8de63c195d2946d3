// A disc of radius 0.5 about the origin: triangles.
Point(1) = {0, 0, 0};
Point(2) = {0.5, 0, 0};
Point(3) = {0, 0.5, 0};
Point(4) = {-0.5, 0, 0};
Point(5) = {0, -0.5, 0};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Circle(3) = {4, 1, 5};
Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Surface("disc") = {1};
Physical Curve("rim") = {1, 2, 3, 4};
