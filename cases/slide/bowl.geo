// An elastic bowl, y = 0.25 x² above, 2.4 wide. gmsh -2 bowl.geo
N = 40;
For i In {0:N}
  x = -1.2 + 2.4*i/N;
  Point(i+1) = {x, 0.25*x^2, 0, 0.06};
EndFor
Point(101) = {-1.2, -0.4, 0, 0.2};
Point(102) = {1.2, -0.4, 0, 0.2};
Spline(1) = {1:N+1};
Line(2) = {N+1, 102};
Line(3) = {102, 101};
Line(4) = {101, 1};
Curve Loop(1) = {-4, -3, -2, -1};
Plane Surface(1) = {1};
Physical Surface("bowl") = {1};
Physical Curve("top") = {1};
Physical Curve("foot") = {3};
