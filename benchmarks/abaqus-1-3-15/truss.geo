// A truss as a strip, 2 m long and 0.2 m wide (1 m thick), 1 mm from the wall x = 0: five cells, ten (both as published) or eighty.
// gmsh truss.geo -2 -format msh41 -setnumber cells 5 -o five.msh          (12 nodes)
// gmsh truss.geo -2 -format msh41 -setnumber cells 10 -o ten.msh          (22 nodes)
// gmsh truss.geo -2 -format msh41 -setnumber cells 80 -o eighty.msh       (162 nodes)
DefineConstant[ cells = 5 ];
length = 2;
width = 0.2;
gap = 0.001;
Point(1) = {gap, 0, 0};
Point(2) = {gap + length, 0, 0};
Point(3) = {gap + length, width, 0};
Point(4) = {gap, width, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 3} = cells + 1;
Transfinite Curve {2, 4} = 2;
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("truss") = {1};
Physical Curve("struck") = {4};
Physical Curve("free") = {2};
Physical Curve("sides") = {1, 3};
