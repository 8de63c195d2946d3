// One half of the bar; "left" or "right" by the value of `half`. gmsh -2 -format msh2 -setnumber half 0 -o left.msh tied.geo
SetFactory("Built-in");
DefineConstant[ half = 0 ];
h = half == 0 ? 0.02 : 0.014;
x = half == 0 ? 0.0 : 1.0;                      // the end of the half
sign = half == 0 ? 1 : -1;
Point(1) = {x, 0, 0, h};
Point(2) = {0.45, 0, 0, h};                     // the seam is inclined by 45 degrees
Point(3) = {0.55, 0.1, 0, h};
Point(4) = {x, 0.1, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Surface("body") = {1};
Physical Curve("seam") = {2};
Physical Curve("end") = {4};
Physical Curve("sides") = {1, 3};
