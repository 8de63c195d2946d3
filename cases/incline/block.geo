// A block, 0.2 m wide and 0.1 m high, on the line y = 0; squares of 1 cm.
// gmsh block.geo -2 -format msh41 -o block.msh        (231 nodes)
width = 0.2;
height = 0.1;
DefineConstant[ size = 0.01 ];
Point(1) = {-width / 2, 0, 0};
Point(2) = {width / 2, 0, 0};
Point(3) = {width / 2, height, 0};
Point(4) = {-width / 2, height, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 3} = width / size + 1;
Transfinite Curve {2, 4} = height / size + 1;
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("block") = {1};
Physical Curve("base") = {1};
Physical Curve("top") = {3};
