// Quarter (x > 0, y > 0) of a cube of side 4 below the plane z = 0, finest where a ball of radius 1 will press it.
// gmsh block.geo -3 -format msh41 -o block.msh      (ten-node tetrahedra)
SetFactory("OpenCASCADE");
side = 4;
reach = 0.075; // the contact boundary: distance from the middle of the upper side; contact reaches 0.054
flat = 0.055;  // cells are finest up to here
DefineConstant[ fine = 0.008 ];
growth = 0.4;
coarse = 0.8;

Box(1) = {0, 0, -side, side / 2, side / 2, side};
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
e = 1e-6;
Physical Volume("block") = Volume{:};
Physical Surface("struck") = Surface In BoundingBox{-e, -e, -e, reach + e, reach + e, e};
Physical Surface("plane-x") = Surface In BoundingBox{-e, -e, -side - e, e, side, e};
Physical Surface("plane-y") = Surface In BoundingBox{-e, -e, -side - e, side, e, e};
