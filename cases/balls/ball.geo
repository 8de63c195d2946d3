// Quarter (x > 0, y > 0) of a ball of radius 1 that touches the plane z = 0 at the origin, finest where it will be pressed flat.
// gmsh ball.geo -3 -format msh41 -o ball.msh        (curved ten-node tetrahedra)
SetFactory("OpenCASCADE");
radius = 1;
reach = 0.045; // the contact boundary: distance from the lowest point; contact reaches 0.032
flat = 0.033;  // cells are finest up to here
DefineConstant[ fine = 0.0036 ];
DefineConstant[ growth = 0.4 ];
DefineConstant[ coarse = 0.4 ];

// A small ball about the lowest point divides the surface into "lower" and "upper" without thin slices.
Sphere(1) = {0, 0, radius, radius, -Pi / 2, Pi / 2, Pi / 2};
Sphere(2) = {0, 0, 0, reach};
inner() = BooleanIntersection{ Volume{1}; }{ Volume{2}; };
BooleanFragments{ Volume{1}; Delete; }{ Volume{inner()}; Delete; }
Recursive Delete { Volume{2}; }

Mesh.ElementOrder = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Field[1] = MathEval;
Field[1].F = Sprintf("Min(%g, %g + %g * Sqrt(z * z + Max(0, Sqrt(x * x + y * y) - %g)^2))", coarse, fine, growth, flat);
Background Field = 1;

Physical Volume("ball") = {3, 4};
Physical Surface("lower") = {5};
Physical Surface("upper") = {9};
Physical Surface("plane-x") = {6, 10};
Physical Surface("plane-y") = {7, 11};
