// Quarter (x > 0, y > 0) of a ball of radius 1 that touches the plane z = 0 at the origin, finest where it will be
// pressed flat.
// gmsh sphere.geo -3 -format msh41 -o sphere.msh                                   (degree 1)
// gmsh sphere.geo -3 -format msh41 -setnumber order 2 -o sphere-degree2.msh        (curved ten-node tetrahedra)
SetFactory("OpenCASCADE");
DefineConstant[ order = 1 ];
radius = 1;
reach = 0.026; // the contact boundary: distance from the lowest point; contact reaches 0.02
flat = 0.0205; // cells are finest up to here
fine = order == 1 ? 0.0012 : 0.0022;
growth = order == 1 ? 0.13 : 0.4;
coarse = 0.4;

// A small ball about the lowest point divides the surface into "lower" and "upper" without thin slices.
Sphere(1) = {0, 0, radius, radius, -Pi / 2, Pi / 2, Pi / 2};
Sphere(2) = {0, 0, 0, reach};
inner() = BooleanIntersection{ Volume{1}; }{ Volume{2}; };
BooleanFragments{ Volume{1}; Delete; }{ Volume{inner()}; Delete; }
Recursive Delete { Volume{2}; }

Mesh.ElementOrder = order;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Field[1] = MathEval;
Field[1].F = Sprintf("Min(%g, %g + %g * Sqrt(z * z + Max(0, Sqrt(x * x + y * y) - %g)^2))", coarse, fine, growth, flat);
Background Field = 1;

Physical Volume("body") = {3, 4};
Physical Surface("lower") = {5};
Physical Surface("upper") = {9};
Physical Surface("plane-x") = {6, 10};
Physical Surface("plane-y") = {7, 11};
