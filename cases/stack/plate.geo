// A column of a plate, 1 high and 0.5 wide, of square cells, so that nothing varies along x.
// gmsh plate.geo -2 -format msh41 -o plate.msh        (102 nodes)
height = 1;
width = 0.5;
DefineConstant[ cells = 50 ];
DefineConstant[ across = 1 ];
h = height / cells;
Point(1) = {0, 0, 0};
Point(2) = {width, 0, 0};
Point(3) = {width, h, 0};
Point(4) = {0, h, 0};
Point(5) = {width, height, 0};
Point(6) = {0, height, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Line(5) = {3, 5};
Line(6) = {5, 6};
Line(7) = {6, 4};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Curve Loop(2) = {-3, 5, 6, 7};
Plane Surface(2) = {2};
Transfinite Curve {1, 3, 6} = across + 1;
Transfinite Curve {2, 4} = 2;
Transfinite Curve {5, 7} = cells;
Transfinite Surface {1, 2};
Recombine Surface {1, 2};
Physical Surface("plate") = {1, 2};
Physical Curve("face") = {1};
Physical Curve("sides") = {5, 7}; // above the lowest cell: the nodes of the face stay free along y
Physical Curve("back") = {6};
