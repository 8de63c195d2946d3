// Right half of a cylinder of radius 50 that touches the line y = 0 at the origin. Units: mm.
// gmsh roller.geo -2 -format msh41 -o roller.msh        (curved six-node triangles)
SetFactory("OpenCASCADE");
radius = 50;
load = 5 * Pi / 180;  // half of the angle over which the load is spread at the top
reach = 9;            // the contact boundary: up to this x; contact reaches 6.2
flat = 7;             // cells are finest up to here
DefineConstant[ facets = 30 ];  // of the contact boundary, of equal length: 0.3016
growth = 0.25;
coarse = 12;

angle = Asin(reach / radius);
fine = radius * angle / facets;
Point(1) = {0, 0, 0};
Point(2) = {radius * Sin(angle), radius * (1 - Cos(angle)), 0};
Point(3) = {radius * Sin(load), radius * (1 + Cos(load)), 0};
Point(4) = {0, 2 * radius, 0};
Point(5) = {0, radius, 0};
Circle(1) = {1, 5, 2};
Circle(2) = {2, 5, 3};
Circle(3) = {3, 5, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1} = facets + 1;

Mesh.ElementOrder = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Field[1] = MathEval;
Field[1].F = Sprintf("Min(%g, %g + %g * Sqrt(y * y + Max(0, x - %g)^2))", coarse, fine, growth, flat);
Background Field = 1;

Physical Surface("roller") = {1};
Physical Curve("lower") = {1};
Physical Curve("loaded") = {3};
Physical Curve("axis") = {4};
