// Half of the section of a steel ram with a rubber buffer bonded to its face, in mm. x is the distance from the axis; the tip of
// the buffer is the origin.
h = 2;           // size of the cells of the rubber
radius = 25;     // of the rubber, a paraboloid with a rim
height = 40;
rim = 4;
Point(1) = {0, 0, 0, h};
points[] = {1};
For i In {1:12}
  r = radius * i / 12;
  Point(1 + i) = {r, (height - rim) * (r / radius)^2, 0, h};
  points[] += {1 + i};
EndFor
Point(20) = {radius, height, 0, h};
Point(21) = {0, height, 0, h};
Point(22) = {28, height, 0, h};
Point(23) = {28, height + 8, 0, 2*h};
Point(24) = {20, height + 8, 0, 3*h};
Point(25) = {20, 108, 0, 4*h};
Point(26) = {18, 110, 0, 4*h};
Point(27) = {0, 110, 0, 4*h};
Spline(1) = {points[]};
Line(2) = {13, 20};
Line(3) = {20, 21};
Line(4) = {21, 1};
Line(5) = {20, 22};
Line(6) = {22, 23};
Line(7) = {23, 24};
Line(8) = {24, 25};
Line(9) = {25, 26};
Line(10) = {26, 27};
Line(11) = {27, 21};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Curve Loop(2) = {5, 6, 7, 8, 9, 10, 11, -3};
Plane Surface(2) = {2};
Physical Surface("rubber") = {1};
Physical Surface("steel") = {2};
Physical Curve("head") = {1};
