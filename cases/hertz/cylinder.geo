// Right half of a disc of radius 1 that touches the line y = 0 at the origin, finest where it will be pressed flat.
// gmsh cylinder.geo -2 -format msh41 -o cylinder.msh                                   (degree 1)
// gmsh cylinder.geo -2 -format msh41 -setnumber order 2 -o cylinder-degree2.msh        (curved six-node triangles)
SetFactory("OpenCASCADE");
DefineConstant[ order = 1 ];
radius = 1;
reach = 0.08;  // the contact boundary: arc length from the lowest point; contact reaches half as far
flat = 0.045;  // cells are finest up to here
fine = order == 1 ? 0.002 : 0.0036;
growth = order == 1 ? 0.15 : 0.25;
coarse = order == 1 ? 0.1 : 0.15;

angle = reach / radius;
centre = newp; Point(centre) = {0, radius, 0};
lowest = newp; Point(lowest) = {0, 0, 0};
edge = newp;   Point(edge) = {radius * Sin(angle), radius * (1 - Cos(angle)), 0};
top = newp;    Point(top) = {0, 2 * radius, 0};
Circle(1) = {lowest, centre, edge};
Circle(2) = {edge, centre, top};
Line(3) = {top, lowest};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};

Mesh.ElementOrder = order;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Field[1] = MathEval;
Field[1].F = Sprintf("Min(%g, %g + %g * Sqrt(y * y + Max(0, x - %g)^2))", coarse, fine, growth, flat);
Background Field = 1;

Physical Surface("body") = {1};
Physical Curve("lower") = {1};
Physical Curve("upper") = {2};
Physical Curve("axis") = {3};
