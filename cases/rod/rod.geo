// A rod as a strip: 1 long, 0.1 high, unstructured triangles.
// gmsh rod.geo -2 -format msh41 -o rod.msh        (360 nodes)
length = 1;
height = 0.1;
DefineConstant[ size = 0.02 ];
Mesh.MeshSizeMin = size;
Mesh.MeshSizeMax = size;
Point(1) = {0, 0, 0};
Point(2) = {length, 0, 0};
Point(3) = {length, height, 0};
Point(4) = {0, height, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Surface("rod") = {1};
Physical Curve("contact-end") = {4};
Physical Curve("clamped-end") = {2};
Physical Curve("sides") = {1, 3};
