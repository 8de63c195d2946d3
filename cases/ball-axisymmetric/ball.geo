// One half of the section of a ball that touches the line y = 0 from above, or is `gap` above it; the axis is x = 0.
// gmsh ball.geo -2 -format msh41 -o ball.msh
// gmsh ball.geo -2 -format msh41 -setnumber order 2 -setnumber radius 1 -setnumber gap 0 -setnumber reach 0.026
//     -setnumber flat 0.0205 -setnumber fine 0.0015 -setnumber growth 0.25 -setnumber coarse 0.15 -o ball-hertz.msh
SetFactory("OpenCASCADE");
DefineConstant[ order = 1 ];
DefineConstant[ radius = 0.05 ];
DefineConstant[ gap = 0.005 ];
DefineConstant[ reach = 0.013 ];   // the contact boundary: arc length from the lowest point
DefineConstant[ flat = 0.008 ];    // cells are finest up to here
DefineConstant[ fine = 0.0006 ];
DefineConstant[ growth = 0.25 ];
DefineConstant[ coarse = 0.004 ];

angle = reach / radius;
centre = newp; Point(centre) = {0, radius + gap, 0};
lowest = newp; Point(lowest) = {0, gap, 0};
edge = newp;   Point(edge) = {radius * Sin(angle), gap + radius * (1 - Cos(angle)), 0};
top = newp;    Point(top) = {0, gap + 2 * radius, 0};
Circle(1) = {lowest, centre, edge};
Circle(2) = {edge, centre, top};
Line(3) = {top, centre};
Line(4) = {centre, lowest}; // a node at the centre, for a probe
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};

Mesh.ElementOrder = order;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Field[1] = MathEval;
Field[1].F = Sprintf("Min(%g, %g + %g * Sqrt((y - %g)^2 + Max(0, x - %g)^2))", coarse, fine, growth, gap, flat);
Background Field = 1;

Physical Surface("ball") = {1};
Physical Curve("lower") = {1};
Physical Curve("upper") = {2};
