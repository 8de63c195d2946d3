// The layer as a block, 20 wide and 1 high: cells 0.1 wide and 0.05 high.
// gmsh wide.geo -2 -format msh41 -o wide.msh        (4221 nodes)
height = 1;
width = 20;
DefineConstant[ cells = 20 ];
Point(1) = {0, 0, 0};
Point(2) = {width, 0, 0};
Point(3) = {width, height, 0};
Point(4) = {0, height, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 3} = cells * width / 2 + 1;
Transfinite Curve {2, 4} = cells + 1;
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("layer") = {1};
Physical Curve("base") = {1};
Physical Curve("top") = {3};
