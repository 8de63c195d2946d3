// A die with a round foot of radius 0.3. gmsh -2 die.geo
r = 0.3;
Point(1) = {-r, 0, 0, 0.05};
Point(2) = {0, 0, 0, 0.05};
Point(3) = {r, 0, 0, 0.05};
Point(4) = {0, -r, 0, 0.03};
Point(5) = {-r, 0.1, 0, 0.06};
Point(6) = {r, 0.1, 0, 0.06};
Circle(1) = {1, 2, 4};
Circle(2) = {4, 2, 3};
Line(3) = {3, 6};
Line(4) = {6, 5};
Line(5) = {5, 1};
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {1};
Physical Surface("die") = {1};
Physical Curve("round") = {1, 2};
Physical Curve("head") = {4};
