// Right half of a block, 200 wide and high, below the line y = 0. Units: mm.
// gmsh block.geo -2 -format msh41 -o block.msh        (six-node triangles)
side = 200;
reach = 9;            // the contact boundary: up to this x; contact reaches 6.2
flat = 7;             // cells are finest up to here
DefineConstant[ facets = 25 ];  // of the contact boundary, of equal length: 0.36, not those of the roller
fine = reach / facets;
growth = 0.25;
coarse = 20;

Point(1) = {0, 0, 0};
Point(2) = {reach, 0, 0};
Point(3) = {side / 2, 0, 0};
Point(4) = {side / 2, -side, 0};
Point(5) = {0, -side, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 1};
Curve Loop(1) = {-5, -4, -3, -2, -1};
Plane Surface(1) = {1};
Transfinite Curve {1} = facets + 1;

Mesh.ElementOrder = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Field[1] = MathEval;
Field[1].F = Sprintf("Min(%g, %g + %g * Sqrt(y * y + Max(0, x - %g)^2))", coarse, fine, growth, flat);
Background Field = 1;

Physical Surface("block") = {1};
Physical Curve("upper") = {1};
Physical Curve("bottom") = {4};
Physical Curve("axis") = {5};
